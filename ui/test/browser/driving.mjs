/** What the scripts that drive a browser have in common. */

import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { connect, createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const CHROMIUM = process.env.CHROMIUM ?? "/usr/bin/chromium";

export const FLAGS = [
  "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
  "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
];

/**
 * Begin a Chromium whose tabs are hidden and lose the focus as anybody's do: what Playwright begins pretends that all
 * are seen. Its one context, and what ends it.
 */
export async function begun() {
  const folder = mkdtempSync(join(tmpdir(), "page-"));
  const words = [...FLAGS, "--headless=new", "--remote-debugging-port=0", `--user-data-dir=${folder}`, "about:blank"];
  const running = spawn(CHROMIUM, words, { stdio: ["ignore", "ignore", "pipe"] });
  const over = new Promise((done) => running.once("exit", done));
  const at = await new Promise((done, failed) => {
    let said = "";
    running.stderr.on("data", (data) => {
      const found = /ws:\/\/\S+/.exec((said += data));
      if (found) done(found[0]);
    });
    over.then(() => failed(new Error(`Chromium did not begin: ${said}`)));
  });
  const browser = await chromium.connectOverCDP(at, { noDefaults: true });
  const end = async () => {
    running.kill();
    await over;
    rmSync(folder, { recursive: true, force: true, maxRetries: 5 });
  };
  return { context: browser.contexts()[0], end };
}

/** Open the page at the address that `pico gui` told, until the twin is drawn. */
export async function opened(browser, address, viewport) {
  const page = await (await browser.newContext({ viewport, permissions: ["clipboard-read", "clipboard-write"] })).newPage();
  page.setDefaultTimeout(20_000);
  page.on("pageerror", (error) => console.log(String(error)));
  await page.goto(address.replace("/#", "/?lowgpu=1#"));
  await page.getByRole("button", { name: /^p2/ }).waitFor();
  await page.waitForFunction(() => window.picoAt?.("p2"));
  return page;
}

/**
 * A way of our own to the coordinator at an address, which can be broken: `address` leads through it, `cut()` ends all
 * that goes through it and lets nobody in, `hold()` passes nothing on but leaves the ends open, `mend()` undoes both.
 */
export async function relayed(address) {
  const { hostname, port } = new URL(address);
  const pairs = new Set();
  let open = true, held = false;
  const server = createServer((near) => {
    if (!open) return near.destroy();
    const far = connect(Number(port), hostname), pair = [near, far];
    pairs.add(pair);
    for (const [one, other] of [[near, far], [far, near]]) {
      one.setNoDelay(true);
      one.on("data", (data) => { if (!held) other.write(data); });
      one.on("close", () => { other.destroy(); pairs.delete(pair); });
      one.on("error", () => undefined);
    }
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  return {
    address: address.replace(`:${port}`, `:${server.address().port}`),
    cut() { open = false; for (const pair of pairs) for (const one of pair) one.resetAndDestroy(); },
    hold() { held = true; },
    mend() { open = true; held = false; for (const pair of pairs) for (const one of pair) one.destroy(); },
    close() { this.cut(); server.close(); },
  };
}
