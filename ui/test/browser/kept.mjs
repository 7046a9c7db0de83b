/**
 * Looks at past runs in Chromium: a plot with its bars, pictures, a search:
 *   node kept.mjs ADDRESS [FOLDER FOR PICTURES]
 * ADDRESS is what `pico gui` told, of a lab (shel) where from the latest on there are a run that sought `ly_150_centred`, one
 * of `cam.image`, and one that measured `cam.centroid` several times.
 */
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { chromium } from "playwright-core";
import { FLAGS, opened } from "./driving.mjs";

const [address, pictures] = process.argv.slice(2);
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: FLAGS });
const page = await opened(browser, address, { width: 1440, height: 900 });
page.setDefaultTimeout(60_000);
const panel = page.getByRole("tabpanel");
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const wrong = [];
page.on("pageerror", (error) => wrong.push(String(error)));
page.on("console", (message) => message.type() === "error" && wrong.push(message.text()));

async function looked(name) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  const serious = violations.filter(({ impact }) => ["serious", "critical"].includes(impact));
  assert.deepEqual(serious.map(({ id, nodes }) => `${name}: ${id} ${nodes.map(({ target }) => target)}`), []);
  console.log(name);
  if (!pictures) return;
  const dialog = await page.locator("dialog").count();
  for (const width of [1440, 1000, 420]) for (const scheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme: scheme });
    await page.setViewportSize({ width, height: 900 });
    if (!dialog) await panel.getByLabel("Pictures and searches").or(panel.locator("figure")).first().scrollIntoViewIfNeeded();
    await page.waitForTimeout(700);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= width, `${wide} px are wider than ${width}`);
    await page.screenshot({ path: `${pictures}/${name}-${width}-${scheme}.png` });
  }
  await page.setViewportSize({ width: 1440, height: 900 });
  await page.emulateMedia({ colorScheme: "light" });
}

/** How far up and down the colour of the first line of a plot reaches, in pixels, in the columns where there is any. */
const reaches = (figure) => figure.locator("canvas").evaluate((canvas) => {
  const { data, width, height } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  const found = [];
  for (let x = 0; x < width; x++) {
    const rows = [];
    for (let y = 0; y < height; y++) {
      const [red, green, blue, alpha] = data.subarray(4 * (x + y * width), 4 * (x + y * width) + 4);
      if (alpha > 120 && blue > 200 && red < 90 && green > 100 && green < 190) rows.push(y);
    }
    if (rows.length) found.push(rows.at(-1) - rows[0] + 1);
  }
  return found;
});

const chosen = async (name) => {
  await panel.getByLabel("Runs", { exact: true }).getByRole("button", { name }).first().click();
  await panel.getByRole("heading", { name: "Steps" }).waitFor();
};
await page.getByRole("tab", { name: "Runs" }).click();

await chosen(/often/);
const plot = panel.locator("figure").filter({ has: page.locator("canvas") });
await plot.first().waitFor();
const [said] = await plot.first().locator("figcaption").allInnerTexts();
assert.match(said, /cam\.centroid\.x last -?[\d.]+ ± [\d.]+; up: cam\.centroid\.x \[um\]; across: t \[s\]/);
await page.waitForTimeout(500);
const heights = await reaches(plot.first());
assert.ok(Math.max(...heights) > 30, `a bar of a standard deviation is to be seen, not ${Math.max(...heights)} px`);
await panel.getByRole("cell", { name: /^x -?[\d.]+ ± [\d.]+ um, y -?[\d.]+ ± [\d.]+ um$/ }).first().waitFor();
await looked("plot");

await chosen(/measure cam\.image/);
const shots = panel.getByLabel("Pictures and searches");
const small = shots.getByRole("button", { name: /^cam\.image, op\d+: larger$/ });
assert.ok((await small.locator("img").evaluate((one) => one.naturalWidth)) <= 160);
await looked("shots");
await small.focus();
await page.keyboard.press("Enter");
const dialog = page.getByRole("dialog", { name: /^cam\.image/ });
await dialog.locator("svg .cross").waitFor({ state: "attached" });
assert.ok((await dialog.locator("img").evaluate((one) => one.naturalWidth)) > 640);
await dialog.getByText(/x -?[\d.]+ ± [\d.]+ um/).first().waitFor();
await looked("shot");
await page.keyboard.press("Escape");
await dialog.waitFor({ state: "detached" });

await chosen(/optimize ly_150_centred/);
const search = panel.getByLabel("Search for ly_150_centred");
await search.getByText(/^(not )?met$/).waitFor();
await search.getByText("What was read, and how tunables went").click();
await search.locator("figure canvas").nth(3).waitFor();
const figures = await search.locator("figcaption").allInnerTexts();
assert.match(figures[0], /measured last [\d.]+ ± [\d.]+; best so far last [\d.]+; across: measurement/);
assert.match(figures[1], /up: cam\.centroid\.x \[um\]/);
assert.match(figures[3], /ly_150\.stage_y last .*ly_150\.stage_z last .*; up: tunables \[mm\]/);
await looked("search");

assert.deepEqual(wrong, []);
console.log("All was seen.");
await browser.close();
