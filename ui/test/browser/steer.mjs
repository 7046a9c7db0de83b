/**
 * Steers p2.angle by a held key in Chromium, and ends each hold another way:
 *   node steer.mjs ADDRESS [FOLDER FOR PICTURES]
 * Says `HOW SECONDS SINCE 1970` when it did so, and goes on at the line `on`; at `again` it does that once more, for
 * nothing moved just before: the machine was too slow. The last way kills the page's process.
 */
import assert from "node:assert/strict";
import { createInterface } from "node:readline";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { chromium } from "playwright-core";

const FLAGS = [
  "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
  "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
];
const [address, pictures] = process.argv.slice(2);
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: FLAGS });
const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
const wrong = [];
let crashed = false;
let page, panel, keys, stands;
const answers = createInterface({ input: process.stdin })[Symbol.asyncIterator]();
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
async function accessible(where) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  const serious = violations.filter(({ impact }) => ["serious", "critical"].includes(impact));
  assert.deepEqual(serious.map(({ id, nodes }) => `${where}: ${id} ${nodes.map(({ target }) => target)}`), []);
}
async function picture(name) { if (pictures) await page.screenshot({ path: `${pictures}/${name}.png` }); }

/** Open the page where one steers. */
async function opened() {
  page = await context.newPage();
  page.setDefaultTimeout(30_000);
  page.on("pageerror", (error) => wrong.push(String(error)));
  await page.goto(address.replace("/#", "/?lowgpu=1#"));
  panel = page.getByRole("tabpanel");
  keys = panel.getByRole("application");
  stands = keys.getByLabel("angle stands at");
  await page.getByRole("tab", { name: "Do" }).click();
  await panel.getByLabel("Component").selectOption("p2");
  await panel.getByLabel("What of it").selectOption({ label: "angle [deg]" });
}
async function begin() {
  await panel.getByRole("button", { name: "Begin" }).click();
  await keys.getByText("still", { exact: true }).waitFor();
  await keys.getByLabel("Step of angle").selectOption({ label: "step 0.5 deg" });
}

process.on("uncaughtException", async (error) => {
  console.error(error, await page.locator("body").innerText().catch(() => ""));
  process.exit(1);
});
await opened();
await picture("steer-before");
await accessible("steer");
await begin();
await accessible("steering");

/** Hold the key until it moved for a while: where the machine was too slow for once, it is pressed anew. */
async function moving() {
  await keys.focus();
  const first = parseFloat(await stands.textContent());
  for (let tries = 0; ; tries++) {
    assert.ok(tries < 10, "a held key does not move");
    await page.keyboard.down("ArrowRight");
    const moved = await page.waitForFunction(([at]) => parseFloat(document.querySelector('output[aria-label="angle stands at"]')?.textContent) > at + 2, [first], { timeout: 4000, polling: 50 }).catch(() => null);
    if (moved && await keys.getByText("moving", { exact: true }).isVisible()) return;
    await page.keyboard.up("ArrowRight");
  }
}
async function ended(how, work, before = async () => undefined) {
  for (let tries = 0; tries < 5; tries++) {
    await before();
    await moving();
    const at = Date.now();
    await work();
    console.log(`${how} ${at / 1000}`);
    if ((await answers.next()).value === "on") return;
    await page.keyboard.up("ArrowRight").catch(() => undefined);
  }
  assert.fail(`${how}: it never moved just before`);
}

await ended("key", () => page.keyboard.up("ArrowRight"));
await keys.getByText("stopped: it was let go; the key was let go").waitFor();
await picture("steer-key");
await ended("blur", () => page.evaluate(() => window.dispatchEvent(new Event("blur"))));
await keys.getByText(/the window lost the focus/).waitFor();
await page.keyboard.up("ArrowRight");
await ended("hidden", async () => {
  await page.evaluate(() => {
    Object.defineProperty(document, "hidden", { configurable: true, get: () => true });
    document.dispatchEvent(new Event("visibilitychange"));
  });
});
await keys.getByText(/the tab was hidden/).waitFor();
await page.evaluate(() => { delete document.hidden; });
await page.keyboard.up("ArrowRight");

await keys.getByRole("button", { name: "angle more" }).hover();
await page.mouse.down();
await keys.getByText("moving", { exact: true }).waitFor();
await page.mouse.up();
await keys.getByText(/the button was let go/).waitFor();
await picture("steer-button");

await keys.getByRole("button", { name: "Done" }).click();
await panel.getByLabel("What it came to").getByText("angle").waitFor();
await picture("steer-after");
await accessible("steered");
assert.deepEqual(wrong, []);

await ended("killed", async () => { (await context.newCDPSession(page)).send("Page.crash").catch(() => undefined); }, async () => {
  if (crashed) await opened();
  crashed = true;
  await begin();
});
console.log("Nothing is steered any more.");
await browser.close();
process.exit(0); // nobody has to close its input
