/**
 * Runs a recipe that asks from the page in Chromium, and answers it by keyboard, after a reload and in a second page:
 *   node asking.mjs ADDRESS CODE [FOLDER FOR PICTURES]
 * CODE is of somebody who may only look; ADDRESS is what `pico gui` told, of a lab with a recipe `asking`: whether the cover is on, a number `read` in mW from
 * 0 to 5, and one of glass and gold.
 */
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { chromium } from "playwright-core";
import { FLAGS, opened } from "./driving.mjs";

const [address, code, pictures] = process.argv.slice(2);
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: FLAGS });
const page = await opened(browser, address, { width: 1440, height: 900 });
page.setDefaultTimeout(60_000);
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const wrong = [];
page.on("pageerror", (error) => wrong.push(String(error)));
async function step(name, work, of = page) {
  await work();
  console.log(name);
  if (pictures) await of.screenshot({ path: `${pictures}/${name}.png` });
  await of.evaluate(axe);
  const { violations } = await of.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  const serious = violations.filter(({ impact }) => ["serious", "critical"].includes(impact));
  assert.deepEqual(serious.map(({ id, nodes }) => `${name}: ${id} ${nodes.map(({ target }) => target)}`), []);
}
const form = (of) => of.getByRole("form", { name: "The recipe asks" });
const recipes = async (of) => {
  await of.getByRole("tab", { name: "Do" }).click();
  await of.getByRole("group", { name: "What to do" }).getByRole("button", { name: "Recipes" }).click();
};

await recipes(page);
await page.getByRole("button", { name: /^asking/ }).click();
await page.getByText(/^On the way it asks/).waitFor();
await page.getByRole("button", { name: "Check" }).click();
await page.getByLabel("Steps").getByText("prompt Read the meter.").waitFor();
const other = await page.context().newPage(); // which hears of what begins elsewhere
other.setDefaultTimeout(60_000);
await other.goto(page.url().replace(/#.*/, "#/shel/bench1/inspect"));
await other.getByRole("status").filter({ hasText: "connected" }).first().waitFor();
await step("asked", async () => {
  await page.getByRole("button", { name: "Run", exact: true }).click();
  await form(page).getByText("Is the cover on?").waitFor();
  await page.getByLabel("Steps").getByText("Where nobody is there it is left out.").waitFor();
  await page.waitForFunction(() => document.activeElement?.textContent?.trim() === "Yes");
  assert.match(await page.title(), /^Asks/);
});
await step("a wrong value", async () => {
  await page.keyboard.press("Enter");
  await form(page).getByText("Read the meter.").waitFor();
  await page.waitForFunction(() => document.activeElement?.tagName === "INPUT");
  await page.keyboard.type("6");
  await page.keyboard.press("Enter");
  await form(page).getByText("read is out of range: 6 mW, and it may be 0 to 5 mW").waitFor();
  await form(page).getByText("a number in mW from 0 to 5").waitFor();
});
await step("after a reload", async () => {
  await page.reload();
  await form(page).getByText("Read the meter.").waitFor();
  assert.match(await page.getByRole("group", { name: "What to do" }).innerText(), /Recipes/);
});
await step("in a second page", async () => {
  await other.getByTitle("What needs attention, and what lets lasers emit").filter({ hasText: "to look at" }).click();
  await other.getByText("A recipe waits for an answer: Read the meter.").waitFor();
  await other.getByRole("button", { name: "Answer it" }).click();
  await form(other).getByText("Read the meter.").waitFor();
}, other);
const watching = await (await browser.newContext({ viewport: { width: 1440, height: 900 } })).newPage();
watching.setDefaultTimeout(60_000);
await step("by who may only look", async () => {
  await watching.goto(`${new URL(address).origin}/?lowgpu=1#code=${code}`);
  await recipes(watching);
  await form(watching).getByText("Not for you to answer: needs the role operator.").waitFor();
  assert.ok(await form(watching).getByLabel(/^read/).isDisabled());
}, watching);
await step("answered once", async () => {
  await form(other).getByLabel(/^read \[mW\]/).fill("400 uW");
  await form(other).getByRole("button", { name: "Answer", exact: true }).click();
  for (const one of [page, other, watching]) {
    await one.getByLabel("Steps").getByText(/^0.4 mW, by ./).waitFor();
    await form(one).getByText("Which sample?").waitFor();
  }
});
await step("asked at 420", async () => {
  await page.setViewportSize({ width: 420, height: 860 });
  await form(page).getByRole("button", { name: "gold" }).scrollIntoViewIfNeeded();
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= 420, `${wide} px are wider than 420`);
});
await step("done", async () => {
  await form(page).getByRole("button", { name: "gold" }).click();
  await page.getByText(/steps, done$/).waitFor();
  await page.getByLabel("Steps").getByText(/^gold, by ./).waitFor();
  assert.equal(await form(page).count(), 0);
});
assert.deepEqual(wrong, []);
console.log("All was done.");
await browser.close();
