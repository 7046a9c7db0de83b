/**
 * Steers p2.angle by a held key in Chromium, and ends each hold another way; takes p2 in the arm's hand, and moves it
 * until lx_125 is in the way, which stands a little further along y:
 *   node steer.mjs ADDRESS [FOLDER FOR PICTURES]
 * Says `HOW SECONDS SINCE 1970` when it did so, and goes on at the line `on`; at `again` it does that once more, for
 * nothing moved just before: the machine was too slow. The last way kills the page's process.
 */
import assert from "node:assert/strict";
import { createInterface } from "node:readline";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { begun, relayed } from "./driving.mjs";

const [given, pictures] = process.argv.slice(2);
const way = await relayed(given), { address } = way;
const { context, end } = await begun();
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
  await page.setViewportSize({ width: 1440, height: 900 });
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
  await end();
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

/** Nobody sees the page, and why it let go stands there. */
async function stopped(why) {
  assert.equal(await page.evaluate(() => document.visibilityState), "hidden");
  assert.match(await keys.innerText(), why);
}

await ended("key", () => page.keyboard.up("ArrowRight"));
await keys.getByText(/^stopped: .*the key was let go$/).waitFor();
await picture("steer-key");
/** The page is seen again, and its key is up. */
async function seen() {
  await page.bringToFront();
  await page.keyboard.up("ArrowRight");
}
const cdp = await context.newCDPSession(page);
const { windowId } = await cdp.send("Browser.getWindowForTarget");
// without a screen no window takes the focus from another one: this alone is only said, not so
await ended("blur", () => page.evaluate(() => window.dispatchEvent(new Event("blur"))), seen);
await keys.getByText(/the window lost the focus/).waitFor();
const tab = await context.newPage();
await ended("hidden", () => tab.bringToFront(), seen);
await stopped(/the (window lost the focus|tab was hidden)/);
await ended("minimized", () => cdp.send("Browser.setWindowBounds", { windowId, bounds: { windowState: "minimized" } }), async () => {
  await cdp.send("Browser.setWindowBounds", { windowId, bounds: { windowState: "normal" } });
  await seen();
});
await stopped(/the (window lost the focus|tab was hidden)/);
await cdp.send("Browser.setWindowBounds", { windowId, bounds: { windowState: "normal" } });
await seen();

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

/**
 * A part in the arm's hand, up to where it would come too near another one, and set down. Where the machine was too slow
 * to be heard on the way, it is recovered and taken anew.
 */
const inHand = () => page.getByRole("button", { name: /^p2 .*in the hand$/ });
const name = (axis) => keys.getByLabel(`${axis} stands at`, { exact: true });
async function taken() {
  for (let tries = 0; tries < 5; tries++) {
    await panel.getByRole("button", { name: "Begin" }).click();
    await page.getByRole("dialog").getByRole("button", { name: "Take it in hand" }).click();
    const recover = panel.getByLabel("What it came to").getByRole("button", { name: "Recover" });
    await keys.getByText("still", { exact: true }).or(recover).waitFor();
    if (await keys.isVisible()) return;
    await recover.click();
    await recover.waitFor({ state: "detached" });
  }
  assert.fail("the part was never in the hand");
}
await panel.getByLabel("What of it").selectOption({ label: "x, y, yaw in the arm's hand" });
await taken();
await inHand().waitFor();
await page.getByTitle("Who has the bench").filter({ hasText: "your run" }).waitFor();
await keys.getByLabel("Step of y", { exact: true }).selectOption({ label: "step 1 mm" });
const began = parseFloat(await name("y").textContent());
const limit = panel.locator(".note.warn");
for (let tries = 0; tries < 60 && !(await limit.count()); tries++) {
  await keys.focus();
  await page.keyboard.down("ArrowUp");
  await limit.waitFor({ timeout: 2000 }).catch(() => undefined);
  await page.keyboard.up("ArrowUp");
}
assert.match(await limit.innerText(), /^y: p2 is .* before lx_125/);
assert.ok(parseFloat(await name("y").textContent()) > began, "it went on until then");
await accessible("in hand");
await picture("steer-in-hand");
await keys.getByRole("button", { name: "Set it down" }).click();
await panel.getByLabel("What it came to").getByText("p2.y", { exact: true }).waitFor();
await inHand().waitFor({ state: "detached" });
await picture("steer-set-down");
await panel.getByLabel("What of it").selectOption({ label: "angle [deg]" });
assert.deepEqual(wrong, []);

/** Begin anew, once the edge has given up who steered before. */
async function anew() {
  way.mend();
  await page.keyboard.up("ArrowRight");
  await page.getByRole("status").filter({ hasText: "connected" }).waitFor();
  if (await keys.isVisible()) return;
  await begin();
}
await ended("cut", () => way.cut(), anew);
await page.getByText("The line to the bench is lost: nothing moves any more.").first().waitFor();
await ended("silent", () => way.hold(), anew);
await anew();
await ended("killed", async () => { (await context.newCDPSession(page)).send("Page.crash").catch(() => undefined); }, async () => {
  if (crashed) { await opened(); await begin(); }
  crashed = true;
});
console.log("Nothing is steered any more.");
way.close();
await end();
process.exit(0); // nobody has to close its input
