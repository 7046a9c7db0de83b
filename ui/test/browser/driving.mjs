/** What the scripts that drive a browser have in common. */

export const FLAGS = [
  "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
  "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
];

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
