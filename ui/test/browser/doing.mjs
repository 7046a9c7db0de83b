/**
 * Measures, seeks a goal and runs a recipe from the page in Chromium, at a bench whose light is on the camera:
 *   node doing.mjs ADDRESS [FOLDER FOR PICTURES]
 * ADDRESS is what `pico gui` told, of a lab (shel) with a recipe `turning` of p2.
 */
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { chromium } from "playwright-core";
import { FLAGS, opened } from "./driving.mjs";

const [address, pictures] = process.argv.slice(2);
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: FLAGS });
const page = await opened(browser, address, { width: 1440, height: 900 });
page.setDefaultTimeout(40_000);
const panel = page.getByRole("tabpanel");
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const wrong = [];
page.on("pageerror", (error) => wrong.push(String(error)));
async function accessible(where) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  const serious = violations.filter(({ impact }) => ["serious", "critical"].includes(impact));
  assert.deepEqual(serious.map(({ id, nodes }) => `${where}: ${id} ${nodes.map(({ target }) => target)}`), []);
}
async function step(name, work) {
  await work();
  console.log(name);
  if (pictures) await page.screenshot({ path: `${pictures}/${name}.png` });
  await accessible(name);
}
const act = (name) => panel.getByRole("group", { name: "What to do" }).getByRole("button", { name }).click();

await page.getByRole("tab", { name: "Do" }).click();
await step("live picture", async () => {
  await act("Measure");
  await panel.locator(".picture svg .cross").waitFor({ state: "attached" });
  await panel.locator("dl dd").first().filter({ hasText: /± .*um/ }).waitFor();
  await panel.locator(".picture svg .ellipse").first().waitFor({ state: "attached" });
});
await step("measured", async () => {
  await panel.getByRole("button", { name: "Measure centroid" }).click();
  await panel.getByLabel("Measured").getByText(/x -?[\d.]+ ± [\d.]+ um/).waitFor();
});
await step("exposure", async () => {
  await panel.getByLabel(/^Exposure/).fill("5");
  await panel.getByRole("button", { name: "Set", exact: true }).click();
  await page.getByRole("status").getByText(/^done: 1 done/).waitFor();
  await panel.getByText("5 ms", { exact: true }).waitFor();
});
await step("pinned camera", async () => {
  await page.getByRole("button", { name: "Cameras", exact: true }).click();
  await page.getByLabel("Cameras").getByRole("button", { name: "cam", exact: true }).click();
  await page.getByLabel("Cameras").locator(".picture .cross").waitFor({ state: "attached" });
});
await step("look ahead", async () => {
  await act("Optimize");
  await panel.getByRole("button", { name: /^ly_150_centred/ }).click();
  await panel.getByRole("button", { name: /^Look ahead/ }).click();
  await panel.getByLabel("What would be done").getByText("ly_150.stage_y").waitFor();
});
await step("goal sought", async () => {
  await panel.getByRole("button", { name: "Seek it" }).click();
  await panel.getByLabel("What it came to").getByText("met", { exact: true }).waitFor();
  await panel.getByRole("button", { name: /^ly_150_centred/ }).getByText("aligned").waitFor();
  await panel.locator("figure canvas").waitFor();
});
await step("recipe checked", async () => {
  await act("Recipes");
  await panel.getByRole("button", { name: /^turning/ }).click();
  await panel.getByLabel(/^often/).fill(`[${Array.from({ length: 16 }, (_, i) => i % 5).join(", ")}]`);
  await panel.getByRole("button", { name: "Check" }).click();
  await panel.getByLabel("Steps").getByText("set p1.angle").first().waitFor();
});
await step("recipe runs", async () => {
  await panel.getByRole("button", { name: "Run", exact: true }).click();
  await panel.getByLabel("Steps").locator(".done, .going").first().waitFor();
  await panel.getByRole("button", { name: "Stop it" }).waitFor();
  await page.reload();
  await panel.getByLabel("Steps").locator(".done").first().waitFor(); // what went on is followed
});
await step("recipe done", async () => { await panel.getByRole("status").filter({ hasText: /steps, done$/ }).waitFor(); });
for (const width of [1000, 420]) {
  await page.setViewportSize({ width, height: 860 });
  for (const name of ["Steer", "Measure", "Optimize", "Recipes"]) {
    await step(`${name} at ${width}`, async () => {
      await act(name);
      await page.waitForTimeout(800);
      const wide = await page.evaluate(() => document.documentElement.scrollWidth);
      assert.ok(wide <= width, `${wide} px are wider than ${width}`);
    });
  }
}
assert.deepEqual(wrong, []);
console.log("All was done.");
await browser.close();
