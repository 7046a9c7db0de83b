/**
 * A picture of every page and state, at three widths, light and dark, in Chromium:
 *   node pictures.mjs ADDRESS FOLDER [PART OF A NAME | =NAME,NAME | --documented]
 * ADDRESS is what `pico gui` told, of a lab that stands at E1-3 (shel), with a branch `impossible` on which two parts
 * stand in each other. `--documented`: the pictures of the documentation alone; WIDTHS=1000,420: at these widths alone.
 * Says which buttons and words are cut.
 */
import { mkdirSync } from "node:fs";
import { FLAGS, opened, relayed } from "./driving.mjs";
import { chromium } from "playwright-core";

const [address, folder, only = ""] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: FLAGS });
const way = await relayed(address);
const page = await opened(browser, way.address, { width: 1440, height: 900 });
const bench = await page.evaluate(() => location.hash.split("/").slice(1, 3).join("/"));
const api = `/api/benches/${bench}`;
const panel = page.getByRole("tabpanel"), dialog = page.getByRole("dialog"), tiles = page.getByLabel("Cameras");
const press = (name, within = page) => within.getByRole("button", { name }).first().click();
const ask = (method, path, body) => page.evaluate(async ([method, path, body]) => {
  const answer = await fetch(path, { method, headers: { "content-type": "application/json" }, body: body && JSON.stringify(body) });
  return answer.status === 204 ? null : await answer.json();
}, [method, path, body]);
const planned = async () => { await page.locator("#revision").fill("e2"); await page.keyboard.press("Enter"); await page.getByText(/\d+ operations?/).first().waitFor(); };
const seen = (words) => page.getByText(words).first().waitFor();
/** Somebody else has the bench. */
const elsewhere = () => ask("POST", `${api}/lease`, { session: "elsewhere" });
async function given() {
  const { holder } = await ask("GET", `${api}/lease`);
  if (holder) await ask("DELETE", `${api}/lease?session=elsewhere&token=${holder.token}`);
}
async function byHand() {
  if (!(await page.locator(".hand").count())) await press("Edit by hand");
  await page.locator(".hand").waitFor();
}

/** What is looked at: where, what is done there first, and what is put back afterwards; up to which width. */
const STATES = {
  inspect: ["inspect?part=p2"],
  "inspect-none": ["inspect?part="],
  edit: ["inspect?part=p2", () => press("Edit pose", panel)],
  "edit-value": ["inspect?part=cam", () => press("Edit exposure", panel)],
  "by-hand": ["inspect?part=p2", async () => {
    await byHand();
    for (let i = 0; i < 3; i++) await page.keyboard.press("ArrowUp");
  }],
  "by-hand-refused": ["inspect?part=p2", async () => {
    await byHand();
    const spot = (name) => page.evaluate((one) => window.picoAt(one), name);
    const [x, y] = await spot("p2"), [u, v] = await spot("ly_150");
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(u, v, { steps: 4 });
    await page.locator(".hand .bad").waitFor();
  }, async () => { await page.keyboard.press("Escape"); await page.mouse.up(); }],
  plan: ["plan?rev=e2", planned],
  apply: ["plan?rev=e2", async () => { await planned(); await press("Apply …"); }],
  scrub: ["plan?rev=e2", async () => {
    await planned();
    await page.getByText(/move over a step/).waitFor();
    await page.getByLabel("Scrub through the plan").fill("5");
  }],
  impossible: ["plan?rev=impossible", async () => { await page.locator("#revision").fill("impossible"); await page.keyboard.press("Enter"); await panel.locator(".note.bad").first().waitFor(); }],
  history: ["history"],
  commit: ["history?to=E2-3"],
  compare: ["history?from=E1-3&to=E2-3", () => seen(/^E1-3 → E2-3/)],
  "check-out": ["history?to=E2-3", async () => { await press("Check out …", panel); await dialog.getByText(/operations/).first().waitFor(); }],
  runs: ["runs", async () => { await panel.locator("[data-row]").first().click(); await panel.getByRole("heading", { name: "Steps" }).waitFor(); }],
  replay: ["runs", async () => {
    await panel.locator("[data-row]").first().click();
    await press("Replay in the twin", panel);
    await page.getByLabel("Time of the run").fill("4.6");
    await page.waitForTimeout(300);
  }, () => press("Back to live")],
  steer: ["do?act=steer&part=p2"],
  steering: ["do?act=steer&part=p2", async () => {
    await press("Begin", panel);
    await panel.getByText("still", { exact: true }).waitFor();
  }, () => press("Done", panel)],
  steered: ["do?act=steer&part=p2", () => panel.getByLabel("What it came to").waitFor()],
  "runs-compared": ["runs", async () => {
    await panel.locator("[data-row]").first().click();
    await panel.getByLabel("Compare with").selectOption({ index: 1 });
    await panel.getByText("Comparing").waitFor({ state: "detached" });
  }],
  measure: ["do?act=measure", () => panel.locator(".picture").waitFor()],
  optimize: ["do?act=optimize", () => press("Look ahead", panel)],
  recipes: ["do?act=recipes"],
  recipe: ["do?act=recipes", async () => { await panel.locator("[data-row], li button").first().click(); await press("Check", panel); await panel.getByLabel("Steps").locator("li").first().waitFor({ timeout: 120_000 }); }],
  palette: ["inspect", () => page.keyboard.press("Control+k")],
  "palette-found": ["inspect", async () => { await page.keyboard.press("Control+k"); await dialog.getByRole("textbox").fill("push"); }],
  lease: ["inspect", () => page.getByTitle("Who has the bench").click()],
  steal: ["inspect", async () => {
    await elsewhere();
    await page.getByTitle("Who has the bench").click();
    await dialog.getByLabel(/Why\?$/).fill("the laser is warm and must not be left alone, it drifts");
  }, given],
  attention: ["inspect", () => page.getByTitle(/^What needs attention/).click()],
  parts: ["inspect", () => press("Components"), () => press("Components"), 1099],
  layers: ["inspect?part=p2", () => page.locator("summary").filter({ hasText: "Layers" }).click(), () => page.locator("summary").filter({ hasText: "Layers" }).click()],
  tiles: ["inspect", async () => {
    await press("Cameras", tiles);
    for (const one of ["cam"]) await press(one, tiles);
    await tiles.locator(".picture").first().waitFor();
  }, async () => { await press(/^Unpin/, tiles); await press("Cameras", tiles); }],
  halted: ["inspect", async () => {
    await page.getByRole("button", { name: "Close" }).first().click({ timeout: 500 }).catch(() => undefined);
    await planApplied();
    await press("Halt");
    await page.getByRole("button", { name: "Resume" }).first().waitFor();
    await press("Log");
  }],
  gone: ["inspect?part=p2", async () => { way.cut(); await page.waitForTimeout(1500); }, async () => { way.mend(); await page.waitForTimeout(2500); }],
  login: ["inspect", async () => {
    const kept = await page.context().storageState();
    await page.context().clearCookies();
    await page.reload();
    await page.getByRole("textbox").first().waitFor();
    cookies = kept.cookies;
  }, async () => {
    await page.context().addCookies(cookies);
    await page.reload();
    await page.waitForFunction(() => window.picoAt?.("p2"));
  }],
};
let cookies = [];
async function planApplied() {
  await page.evaluate((hash) => { location.hash = hash; }, `#/${bench}/plan?rev=e2`);
  await planned();
  await press("Apply …");
  await dialog.getByRole("button", { name: "Apply", exact: true }).click();
  await page.getByRole("button", { name: "Halt" }).waitFor();
}

/** What the documentation shows, under which name, how wide and high. */
const DOCUMENTED = { plan: ["page-plan", 1280, 760], compare: ["page-history", 1280, 760], "by-hand": ["page-by-hand", 1280, 760], attention: ["page-phone", 420, 760] };

/** Buttons, labels and words that end outside of what shows them, and what covers a button. */
const faults = () => page.evaluate(() => {
  const found = [], shown = (one) => one.checkVisibility({ opacityProperty: true, visibilityProperty: true });
  for (const one of document.querySelectorAll("button, select, input, h2, h3, .badge, th, td, dd, summary")) {
    if (!shown(one) || one.closest(".hidden")) continue;
    const box = one.getBoundingClientRect(), name = `${one.tagName.toLowerCase()} ${(one.getAttribute("aria-label") ?? one.innerText ?? one.value).trim().slice(0, 30)}`;
    if (!box.width || !box.height) { found.push(`${name} has no room`); continue; }
    if (one.matches("button, .badge") && one.scrollWidth > one.clientWidth + 1 && getComputedStyle(one).overflowX !== "visible") found.push(`${name} is cut`);
    if (box.right > innerWidth + 1 || box.left < -1) found.push(`${name} ends outside`);
  }
  for (const one of document.querySelectorAll(".inside, .parts ul, section, aside, header, dialog"))
    if (shown(one) && one.scrollWidth > one.clientWidth + 1) found.push(`${one.tagName.toLowerCase()} ${one.className || one.ariaLabel} is ${one.scrollWidth} wide in ${one.clientWidth}`);
  return [...new Set(found)];
});

async function closed() { while (await page.locator("dialog").count()) { await page.keyboard.press("Escape"); await page.waitForTimeout(100); } }
async function shot(name, file, wait, [where, work, after], themes = ["light"]) {
  const size = page.viewportSize();
  await page.evaluate((hash) => { location.hash = hash; }, `#/${bench}/${where}`);
  await page.waitForTimeout(400);
  try {
    await work?.();
  } catch (failure) {
    console.log(`${name} at ${size.width}: ${String(failure).split("\n")[0]}`);
  }
  await page.waitForTimeout(wait);
  for (const theme of themes) {
    await page.evaluate((other) => document.querySelector(`header [aria-label="${other} colours"]`)?.click(), theme === "dark" ? "Dark" : "Light");
    await page.waitForTimeout(300);
    await page.screenshot({ path: `${folder}/${file}${themes.length > 1 ? `-${theme}` : ""}.png` }).catch((failure) => console.log(`${name}: ${failure}`));
  }
  const wrong = await faults();
  await after?.().catch((failure) => console.log(`after ${name}: ${String(failure).split("\n")[0]}`));
  await closed();
  if (await page.locator(".hand").count()) await press("End editing by hand");
  return wrong;
}

if (only === "--documented") {
  for (const [name, [file, width, height]] of Object.entries(DOCUMENTED)) {
    await page.setViewportSize({ width, height });
    await shot(name, file, 4000, STATES[name]);
  }
  await browser.close();
  process.exit();
}

page.setDefaultTimeout(25_000);
const chosen = Object.entries(STATES).filter(([name]) => (only.startsWith("=") ? only.slice(1).split(",").includes(name) : name.includes(only)));
for (const width of (process.env.WIDTHS ?? "1440,1000,420").split(",").map(Number)) {
  await page.setViewportSize({ width, height: width === 420 ? 860 : 900 });
  for (const [name, state] of chosen) {
    if (width > (state[3] ?? 9999)) continue;
    for (const one of await shot(name, `${name}-${width}`, 500, state, ["light", "dark"])) console.log(`${name} at ${width}: ${one}`);
  }
}
await browser.close();
way.close();
