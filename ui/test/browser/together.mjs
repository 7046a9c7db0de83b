/**
 * Two people at one bench, and a coordinator that goes and comes back, in Chromium:
 *   node together.mjs ADDRESS CODE      the code is of the second person, an operator
 * Says `gone?` and `back?` when it waits for the coordinator to be killed, and to be served again.
 */
import assert from "node:assert/strict";
import { chromium } from "playwright-core";

const FLAGS = [
  "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
  "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
];
const [address, code] = process.argv.slice(2);
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: FLAGS });
const wrong = [];

async function opened(at) {
  const page = await (await browser.newContext({ viewport: { width: 1440, height: 900 } })).newPage();
  page.setDefaultTimeout(60_000);
  page.on("pageerror", (error) => wrong.push(String(error)));
  await page.goto(at.replace("/#", "/?lowgpu=1#"));
  await line(page, "connected");
  return page;
}
const line = (page, words) => page.getByRole("status").filter({ hasText: words }).first().waitFor();
const chip = (page, words) => page.getByTitle("Who has the bench").filter({ hasText: words }).waitFor();
const press = (page, name) => page.getByRole("dialog").getByRole("button", { name }).click();

const mine = await opened(address);
const theirs = await opened(`${new URL(address).origin}/#code=${code}`);

for (const page of [mine, theirs]) await page.getByTitle("Who has the bench").click();
await press(mine, "Take it");
await chip(mine, "yours");
await theirs.getByRole("dialog").getByText(/ has shel\/bench1/).waitFor();
const takeOver = theirs.getByRole("dialog").getByRole("button", { name: /^Take over/ });
assert.equal(await takeOver.getAttribute("title"), "taking over needs the role lease:steal");
await press(theirs, "Ask for it");
await mine.getByRole("dialog").getByText("Waiting: ann").waitFor();
await press(mine, "Give it back");
await chip(mine, "ann");
await chip(theirs, "yours");
await mine.getByRole("dialog").getByLabel(/Why\?$/).fill("the laser is warm");
await press(mine, "Take over");
await chip(mine, "yours");
await theirs.getByRole("dialog").getByText(/ has shel\/bench1/).waitFor();
await press(mine, "Give it back");
await chip(theirs, "free");
console.log("One had the bench at a time.");

console.log("gone?");
for (const page of [mine, theirs]) await line(page, "line lost");
await mine.getByRole("button", { name: "STOP" }).first().click();
await mine.getByRole("alert").filter({ hasText: /Not known to have stopped: .*use the emergency stop/ }).waitFor();
console.log("back?");
for (const page of [mine, theirs]) await line(page, "connected");
await chip(mine, "free");
await press(mine, "Take it");
await chip(theirs, /^Bench: (?!free)/);
console.log("The line is back.");

assert.deepEqual(wrong, []);
await browser.close();
