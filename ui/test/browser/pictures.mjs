/**
 * A picture of every page and state, at three widths, light and dark, in Chromium:
 *   node pictures.mjs ADDRESS FOLDER [PART OF A NAME | --documented]
 * ADDRESS is what `pico gui` told, of a lab that stands at E1-3 (shel). `--documented`: the pictures of
 * the documentation alone. Says what is wider than its page.
 */
import { mkdirSync } from "node:fs";
import { FLAGS, opened } from "./driving.mjs";
import { chromium } from "playwright-core";

const [address, folder, only = ""] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: FLAGS });
const page = await opened(browser, address, { width: 1440, height: 900 });
const bench = await page.evaluate(() => location.hash.split("/").slice(1, 3).join("/"));
const panel = page.getByRole("tabpanel");
const press = (name, within = page) => within.getByRole("button", { name }).first().click();
const command = async (words) => {
  await page.keyboard.press("Control+k");
  await page.getByRole("dialog").getByRole("textbox").fill(words);
  await page.keyboard.press("Enter");
};
const closed = async () => { if (await page.locator("dialog").count()) await page.keyboard.press("Escape"); };

/** What is looked at: where, and what is done there first. */
const STATES = {
  inspect: ["inspect?part=p2"],
  edit: ["inspect?part=p2", () => press("Edit pose", panel)],
  "edit-value": ["inspect?part=cam", () => press("Edit exposure", panel)],
  "by-hand": ["inspect?part=p2", async () => {
    if (!(await page.locator(".hand").count())) await press("Edit by hand");
    for (let i = 0; i < 3; i++) await page.keyboard.press("ArrowUp");
    await page.locator(".hand").waitFor();
  }],
  plan: ["plan?rev=e2", async () => { await page.locator("#revision").fill("e2"); await page.keyboard.press("Enter"); await page.getByText(/\d+ operations?/).first().waitFor(); }],
  apply: ["plan?rev=e2", async () => { await page.locator("#revision").fill("e2"); await page.keyboard.press("Enter"); await press("Apply …"); }],
  history: ["history"],
  compare: ["history?from=E1-3&to=E2-3"],
  commit: ["history?to=E2-3"],
  scrub: ["plan?rev=e2", async () => {
    await page.locator("#revision").fill("e2");
    await page.keyboard.press("Enter");
    await page.getByText(/move over a step/).waitFor();
    await page.getByLabel("Scrub through the plan").fill("5");
  }],
  runs: ["runs", async () => { await panel.locator("[data-row]").first().click(); await panel.getByRole("heading", { name: "Steps" }).waitFor(); }],
  replay: ["runs", async () => {
    await panel.locator("[data-row]").first().click();
    await press("Replay in the twin", panel);
    await page.getByLabel("Time of the run").fill("4.6");
    await page.waitForTimeout(300);
  }],
  steer: ["do?act=steer&part=p2"],
  measure: ["do?act=measure", () => panel.locator(".picture").waitFor()],
  optimize: ["do?act=optimize", () => press("Look ahead", panel)],
  recipes: ["do?act=recipes"],
  palette: ["inspect", () => page.keyboard.press("Control+k")],
  lease: ["inspect", () => page.getByTitle("Who has the bench").click()],
  attention: ["inspect", () => page.getByTitle(/^What needs attention/).click()],
  parts: ["inspect", () => page.getByRole("button", { name: "Components" }).click(), 1099],
};

/** What the documentation shows, under which name, how wide and high. */
const DOCUMENTED = { plan: ["page-plan", 1280, 760], compare: ["page-history", 1280, 760], "by-hand": ["page-by-hand", 1280, 760], attention: ["page-phone", 420, 760] };

if (only === "--documented") {
  for (const [name, [file, width, height]] of Object.entries(DOCUMENTED)) {
    const [where, work] = STATES[name];
    await page.setViewportSize({ width, height });
    await page.evaluate((hash) => { location.hash = hash; }, `#/${bench}/${where}`);
    await page.waitForTimeout(500);
    await work?.();
    await page.waitForTimeout(4000);
    await page.screenshot({ path: `${folder}/${file}.png` });
    await closed();
    if (await page.locator(".hand").count()) await press("End editing by hand");
  }
  await browser.close();
  process.exit();
}

for (const theme of ["light", "dark"]) {
  for (const width of [1440, 1000, 420]) {
    await page.setViewportSize({ width, height: width === 420 ? 860 : 900 });
    await page.evaluate((wanted) => { if (document.documentElement.dataset.theme !== wanted) document.documentElement.dataset.theme = wanted; }, theme);
    for (const [name, [where, work, below = 9999]] of Object.entries(STATES)) {
      if (!name.includes(only) || width > below) continue;
      await page.evaluate((hash) => { location.hash = hash; }, `#/${bench}/${where}`);
      await page.waitForTimeout(400);
      try {
        await work?.();
      } catch (failure) {
        console.log(`${name} at ${width}: ${String(failure).split("\n")[0]}`);
      }
      await page.waitForTimeout(700);
      const wide = await page.evaluate(() => document.documentElement.scrollWidth);
      if (wide > width) console.log(`${name} is ${wide} px wide at ${width}`);
      await page.screenshot({ path: `${folder}/${name}-${width}-${theme}.png` });
      await closed();
      if (await page.locator(".hand").count()) await press("End editing by hand");
      await page.evaluate(() => document.querySelector(".parts.open") && document.querySelector("[aria-label=Components].bare")?.click());
    }
  }
}
await browser.close();
