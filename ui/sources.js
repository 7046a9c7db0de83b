import { createHash } from "node:crypto";
import { readdirSync, readFileSync, statSync } from "node:fs";
import { join, relative } from "node:path";

/** What the page is built of; `tests/ui/test_built_page.py` reads the same. */
export const BUILT_OF = ["index.html", "package-lock.json", "public", "sources.js", "src", "svelte.config.js", "vite.config.js"];

/**
 * The SHA-256 over path and text of everything that the page is built of.
 * @param {string} folder
 */
export function sources(folder) {
  const hash = createHash("sha256");
  const files = BUILT_OF.flatMap((name) => below(join(folder, name))).map((path) => relative(folder, path));
  for (const name of files.sort()) hash.update(`${name}\0${readFileSync(join(folder, name), "utf8")}\0`);
  return hash.digest("hex");
}

/** @param {string} path @returns {string[]} */
function below(path) {
  return statSync(path).isDirectory() ? readdirSync(path).flatMap((name) => below(join(path, name))) : [path];
}
