/**
 * The tour of the README by mouse and keyboard, in Chromium, at the address that `pico gui` told:
 *   node tour.mjs ADDRESS [FOLDER FOR PICTURES]
 * Ends with an error at the first thing that is not so. Nothing may leave this machine, and nothing may go wrong aloud.
 */
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { chromium } from "playwright-core";

const FLAGS = [
  "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
  "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
];
const [address, pictures] = process.argv.slice(2);
const host = new URL(address).host;
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: FLAGS });
const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, permissions: ["clipboard-read", "clipboard-write"] });
const page = await context.newPage();
page.setDefaultTimeout(20_000);
const wrong = [];
let expected = null;
page.on("console", (said) => { if (["error", "warning"].includes(said.type()) && !expected?.test(said.text())) wrong.push(said.text()); });
page.on("pageerror", (error) => wrong.push(String(error)));
page.on("request", (request) => { const { protocol, host: to } = new URL(request.url()); if (protocol.startsWith("http") && to !== host) wrong.push(`asked ${to}`); });

const begun = Date.now();
async function step(name, work) {
  await work();
  console.log(`${((Date.now() - begun) / 1000).toFixed(1).padStart(6)} s  ${name}`);
  if (pictures) await page.screenshot({ path: `${pictures}/${name.replaceAll(/\W+/g, "-")}.png` });
}
const tab = (name) => page.getByRole("tab", { name });
const panel = page.getByRole("tabpanel");
const text = (what) => page.getByText(what).first().waitFor();
const part = (name) => page.getByRole("button", { name: new RegExp(`^${name} `) });
const rows = panel.locator("[data-row]");
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
async function accessible(where) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  const serious = violations.filter(({ impact }) => ["serious", "critical"].includes(impact));
  assert.deepEqual(serious.map(({ id, nodes }) => `${where}: ${id} ${nodes.map(({ target }) => target)}`), []);
}

await step("open", async () => {
  await page.goto(address.replace("/#", "/?lowgpu=1#"));
  await page.getByRole("button", { name: /^p2/ }).waitFor();
  await page.waitForFunction(() => window.picoAt?.("p2"));
  assert.ok(!page.url().includes("code="), "the code is not kept in the address");
  await accessible("inspect");
});

await step("pick in the twin", async () => {
  await page.getByRole("button", { name: "Top", exact: true }).click();
  const [x, y] = await page.evaluate(() => window.picoAt("cam"));
  await page.mouse.click(x, y);
  await panel.getByRole("heading", { name: "cam" }).waitFor();
});

await step("plan e1", async () => {
  await page.keyboard.press("2");
  await page.locator("#revision").fill("e1");
  await page.keyboard.press("Enter");
  await text("11 operations");
  await accessible("plan");
});

await step("look at a step", async () => {
  await rows.first().focus();
  await page.keyboard.press("ArrowDown");
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("Enter");
  assert.equal(await rows.first().getAttribute("aria-pressed"), "true");
  assert.match(page.url(), /rev=e1.*op=op1|op=op1.*rev=e1/);
  await panel.getByRole("button", { name: /^Copy as command/ }).first().click();
  assert.equal(await page.evaluate(() => navigator.clipboard.readText()), "pico plan e1");
});

await step("scrub the plan", async () => {
  const slider = panel.getByLabel("Scrub through the plan");
  await page.waitForFunction(() => !document.querySelector("[aria-label='Scrub through the plan']").disabled);
  await rows.first().focus();
  await panel.getByText(/^at .*: .*p2.*, transit$/).waitFor();
  await slider.fill("10.5");
  await slider.focus();
  await panel.getByText(/^at .*lx_125/).waitFor();
  await accessible("scrub");
  if (pictures) await page.screenshot({ path: `${pictures}/scrubbed.png` });
  await panel.getByRole("button", { name: "All steps" }).click();
});

await step("apply", async () => {
  await panel.getByRole("button", { name: "Apply …" }).click();
  await page.getByRole("dialog").getByText("A laser is asked to emit.").waitFor();
  await accessible("apply");
  await page.getByRole("dialog").getByRole("button", { name: "Apply", exact: true }).click();
  await page.getByRole("status").getByText(/^done: 11 done/).waitFor();
  await text("Nothing would move");
});

await step("runs", async () => {
  await tab("Runs").click();
  await rows.first().click();
  await text("Run 1: apply e1");
  await panel.getByRole("list", { name: "Steps of the run" }).locator("[data-row]").nth(10).waitFor();
  await accessible("runs");
});

await step("replay the run", async () => {
  const where = () => page.evaluate(() => window.picoAt("p2"));
  const after = await where();
  await panel.getByRole("button", { name: "Replay in the twin" }).click();
  await page.getByRole("status").getByText("REPLAY").waitFor();
  const before = await where();
  assert.ok(Math.hypot(before[0] - after[0], before[1] - after[1]) > 20, "p2 is where it was before the run");
  await page.keyboard.press("ArrowRight");
  await page.waitForURL(/run=.*t=7\.98|t=7\.98.*run=/);
  const placed = await where();
  assert.ok(Math.hypot(placed[0] - after[0], placed[1] - after[1]) < 2, "p2 is where the first move took it");
  await accessible("replay");
  if (pictures) {
    await page.getByLabel("Time of the run").fill("4.6");
    await page.screenshot({ path: `${pictures}/replayed.png` });
  }
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await page.getByRole("button", { name: "Pause", exact: true }).click();
  const shared = page.url();
  await page.getByRole("button", { name: "Back to live" }).first().click();
  await page.getByRole("status").getByText("REPLAY").waitFor({ state: "detached" });
  assert.doesNotMatch(page.url(), /[?&]t=/);
  const now = await where();
  assert.ok(Math.hypot(now[0] - after[0], now[1] - after[1]) < 2, "the live bench is where it is");
  await page.goto(shared);
  await page.getByRole("status").getByText("REPLAY").waitFor();
  await page.keyboard.press("Escape");
  await page.getByRole("status").getByText("REPLAY").waitFor({ state: "detached" });
});

await step("nudge, see the drift, heal", async () => {
  await page.keyboard.press("Control+k");
  await page.getByRole("dialog").getByPlaceholder(/^Find a command/).fill("push p2");
  await page.keyboard.press("Enter");
  await part("p2").click();
  await panel.getByText("(525, 420, 30°)").waitFor();
  await tab("Plan").click();
  await page.locator("#revision").fill("e1");
  await page.keyboard.press("Enter");
  await rows.first().waitFor();
  await panel.getByRole("button", { name: "Apply …" }).click();
  await page.getByRole("dialog").getByRole("button", { name: "Apply", exact: true }).click();
  await page.getByRole("status").getByText(/^done: [1-9] done/).waitFor();
  await text("Nothing would move");
});

await step("compare two runs", async () => {
  await tab("Runs").click();
  await panel.getByRole("heading", { name: "Run 1: apply e1" }).waitFor(); // it was chosen before
  await panel.getByLabel("Find a run").fill("kinematic-never");
  await panel.getByText("No run is so.").waitFor();
  await panel.getByLabel("Find a run").fill("");
  await rows.filter({ hasText: "apply e1" }).first().click({ modifiers: ["Control"] });
  await panel.getByRole("heading", { name: /^Run \d and run \d$/ }).waitFor();
  await accessible("compare runs");
});

await step("what needs attention", async () => {
  const chip = page.getByTitle(/^What needs attention/);
  await chip.getByText("light", { exact: false }).waitFor();
  await chip.click();
  await page.getByRole("dialog").getByText("the lab waives arming").waitFor();
  await accessible("attention");
  await page.keyboard.press("Escape");
});

await step("compare two commits", async () => {
  await tab("History").click();
  await rows.filter({ hasText: "E1-3" }).click();
  await rows.filter({ hasText: "E2-3" }).click({ modifiers: ["Control"] });
  await panel.getByRole("heading", { name: "E1-3 → E2-3" }).waitFor();
  await panel.getByText("stowed in storage/a3").waitFor();
  await accessible("history");
});

await step("edit a value", async () => {
  await page.keyboard.press("/");
  await page.keyboard.type("p1");
  await page.getByRole("button", { name: /^p1/ }).click();
  await panel.getByRole("button", { name: "Edit angle" }).click();
  await panel.getByLabel(/^angle/).fill("3");
  await panel.getByRole("button", { name: "Write into the manifest" }).click();
  await panel.getByText("1 edited, in no commit").waitFor();
  await panel.getByText("+ p1.angle 3 deg").waitFor();
  await accessible("edit");
});

await step("commit", async () => {
  await panel.getByPlaceholder("Why; what moved without it").fill("p1 three degrees from crossed");
  await panel.getByRole("button", { name: "Commit", exact: true }).click();
  await panel.getByText("1 edited, in no commit").waitFor({ state: "detached" });
  await tab("History").click();
  await rows.filter({ hasText: "p1 three degrees from crossed" }).waitFor();
});

await step("edit by hand", async () => {
  await page.locator("#filter").fill("");
  await part("lx_100").click();
  await page.getByRole("button", { name: "Edit by hand", exact: true }).click();
  const hand = page.getByRole("region", { name: "Edit by hand" });
  await hand.getByText("lx_100").waitFor();
  for (let i = 0; i < 16; i++) await page.keyboard.press("ArrowRight");
  for (let i = 0; i < 10; i++) await page.keyboard.press("ArrowUp");
  await page.keyboard.press("r");
  await hand.getByText("x 512.5 mm, y 562.5 mm, yaw 15.0°").waitFor();
  await hand.getByText("It fits: room, reach and beam.").waitFor();
  await accessible("by hand");
  await page.keyboard.press("Enter");
  await panel.getByText("1 edited, in no commit").waitFor();
  await panel.getByText("+ lx_100.pose (512.5, 562.5, 15°)").waitFor();
  const [x, y] = await page.evaluate(() => window.picoAt("p2"));
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 5, y - 10);
  await page.mouse.move(x + 8, y - 40, { steps: 4 });
  await page.mouse.up();
  await hand.getByText("p2").waitFor();
  await panel.getByRole("heading", { name: "p2" }).waitFor();
  await hand.filter({ hasText: /Undo\s2|cannot|can't|not safe/ }).waitFor();
  await page.keyboard.press("Escape");
  const undo = hand.getByRole("button", { name: /^Undo/ });
  for (let left = Number((await undo.innerText()).replace(/\D/g, "")); left; left--) {
    await undo.click();
    await undo.filter({ hasText: left > 1 ? String(left - 1) : /^Undo(?!.*\d)/ }).waitFor();
  }
  await panel.getByText(/edited, in no commit/).waitFor({ state: "detached" });
  await hand.getByRole("button", { name: "End editing by hand" }).click();
});

await step("who changed it, and a note", async () => {
  await part("p2").click();
  await panel.getByText("Who changed it, and notes").click();
  await panel.getByText(/second polarizer, parallel to the first|p2/).first().waitFor();
  await panel.getByLabel("Note on p2").fill("scratched at the rim");
  await page.keyboard.press("Enter");
  await panel.getByText("scratched at the rim").waitFor();
  await accessible("blame");
});

await step("branch and tag, and a checkout that says what it would move", async () => {
  await tab("History").click();
  await rows.filter({ hasText: "E2-3" }).click();
  await panel.getByRole("button", { name: "Branch …" }).click();
  await panel.getByLabel("Name of the branch").fill("tilted");
  await panel.getByRole("button", { name: "Make it" }).click();
  await rows.getByText("tilted", { exact: true }).waitFor();
  await panel.getByRole("button", { name: "Check out …" }).click();
  await page.getByRole("dialog").getByText(/\d+ operations/).waitFor();
  await accessible("check out");
  await page.getByRole("dialog").getByRole("button", { name: "Leave it" }).click();
});

await step("commands", async () => {
  await page.keyboard.press("Control+k");
  await page.getByRole("dialog").getByPlaceholder(/^Find a command/).fill("dark");
  await accessible("palette");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.documentElement.dataset.theme === "dark");
  await accessible("dark");
});

await step("stop", async () => {
  await page.keyboard.press("Control+.");
  await text("Stopped: arms brake");
});

for (const width of [1000, 420]) {
  await step(`at ${width}`, async () => {
    await page.setViewportSize({ width, height: 860 });
    assert.ok(await page.getByRole("button", { name: "STOP" }).isVisible());
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= width, `${wide} px are wider than ${width}`);
    await accessible(`at ${width}`);
  });
}

assert.deepEqual(wrong, []);
await browser.close();
console.log("The tour is over.");
