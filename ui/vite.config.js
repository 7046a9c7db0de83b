import { readdirSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { svelte } from "@sveltejs/vite-plugin-svelte";
import { defineConfig } from "vitest/config";
import { sources } from "./sources.js";

const HERE = dirname(fileURLToPath(import.meta.url));

/** Writes beside the page whose code is in it, under which licence, and of which sources it was built. */
function told() {
  return {
    name: "pico-told",
    generateBundle(_, bundle) {
      const found = new Map();
      for (const piece of Object.values(bundle)) {
        if (piece.type !== "chunk") continue;
        for (const id of Object.keys(piece.modules)) {
          const name = /.*node_modules\/((?:@[^/]+\/)?[^/]+)/.exec(id)?.[1];
          if (name && piece.modules[id].renderedLength > 0) found.set(name, licence(name));
        }
      }
      found.set("uplot", licence("uplot")); // its style sheet, too
      const texts = [...found].sort().map(([name, text]) => `${name}\n${"-".repeat(name.length)}\n\n${text.trim()}\n`);
      const head = "The page holds code of these libraries, each under its own licence.\n";
      this.emitFile({ type: "asset", fileName: "licences.txt", source: [head, ...texts].join("\n") });
      this.emitFile({ type: "asset", fileName: "sources.txt", source: `${sources(HERE)}\n` });
    },
  };
}

function licence(name) {
  const folder = join(HERE, "node_modules", name);
  const file = readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
  if (!file) throw new Error(`${name} has no licence beside it`);
  return readFileSync(join(folder, file), "utf8");
}

export default defineConfig({
  plugins: [svelte(), told()],
  build: {
    outDir: "../pico/server/static",
    emptyOutDir: true,
    target: "es2022",
    modulePreload: false,
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1500,
    rolldownOptions: {
      output: {
        entryFileNames: "assets/page-[hash].js",
        chunkFileNames: "assets/[name]-[hash].js",
        assetFileNames: "assets/[name]-[hash][extname]",
      },
    },
  },
  test: { include: ["test/**/*.test.ts"] },
});
