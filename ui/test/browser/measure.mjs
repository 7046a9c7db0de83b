/**
 * How fast the page is, in Chromium: JSON lines to standard output.
 *   node measure.mjs drawn ADDRESS OPENS PICKS    {"drawn": ms} for each time that it is opened, {"pick": ms, "name": …}
 *   node measure.mjs watch ADDRESS...             {"watching": n} once each address is watched; at the end of standard
 *                                                 input {"frames": [n, …], "seconds": s}
 */
import { chromium } from "playwright-core";
import { FLAGS } from "./driving.mjs";

const [mode, ...rest] = process.argv.slice(2);
const say = (what) => console.log(JSON.stringify(what));
const wrong = [];
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: FLAGS });

async function fresh() {
  const page = await (await browser.newContext({ viewport: { width: 1440, height: 900 } })).newPage();
  page.setDefaultTimeout(60_000);
  page.on("pageerror", (error) => wrong.push(String(error)));
  return page;
}
const slow = (address) => address.replace("/#", "/?lowgpu=1#");

/** Open the page and return how long it took until the twin had been drawn [ms]. */
async function drawn(page, address) {
  await page.goto(address, { waitUntil: "commit" });
  return page.evaluate(() => new Promise((resolve) => {
    const look = () => (window.picoAt?.("p2") ? requestAnimationFrame(() => requestAnimationFrame(() => resolve(performance.now()))) : requestAnimationFrame(look));
    look();
  }));
}

/** Click a component in the twin and return how long it took until the page said which one it is [ms]. */
async function picked(page, name) {
  const at = await page.evaluate((wanted) => {
    window.answered = new Promise((resolve) => {
      let began = 0;
      addEventListener("pointerup", () => { began = performance.now(); }, { once: true, capture: true });
      const seen = new MutationObserver(() => {
        const said = document.querySelector("[role=tabpanel] h2")?.textContent;
        if (!began || said !== wanted) return;
        seen.disconnect();
        resolve(performance.now() - began);
      });
      seen.observe(document.body, { subtree: true, childList: true, characterData: true });
    });
    return window.picoAt(wanted);
  }, name);
  await page.mouse.click(...at);
  return page.evaluate(() => Promise.race([window.answered, new Promise((resolve) => setTimeout(() => resolve(null), 20_000))]));
}

if (mode === "drawn") {
  const [address, opens, picks] = rest;
  const page = await fresh();
  await drawn(page, slow(address)); // logs in
  const bare = slow(address).replace(/#.*/, "");
  for (let i = 0; i < Number(opens); i++) say({ drawn: await drawn(page, bare) });
  await page.getByRole("button", { name: "Top", exact: true }).click();
  await page.waitForTimeout(500);
  for (let i = 0; i < Number(picks); i++) {
    const name = ["cam", "p2", "laser", "p1"][i % 4];
    say({ name, pick: await picked(page, name) });
  }
} else {
  const frames = rest.map(() => 0);
  const pages = await Promise.all(rest.map(async (address, i) => {
    const page = await fresh();
    page.on("websocket", (socket) => socket.on("framereceived", ({ payload }) => { if (typeof payload !== "string") frames[i]++; }));
    await drawn(page, slow(address));
    return page;
  }));
  await new Promise((resolve) => { process.stdin.once("data", resolve); say({ watching: pages.length }); });
  frames.fill(0);
  const began = performance.now();
  say({ begun: true });
  await new Promise((resolve) => process.stdin.once("end", resolve).resume());
  say({ frames, seconds: (performance.now() - began) / 1000 });
}
await browser.close();
if (wrong.length) say({ wrong });
