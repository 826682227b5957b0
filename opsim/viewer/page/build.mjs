// Builds ../assets from the sources beside this file; the same sources give the same bytes.
import { copyFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url)),
  assets = join(here, "..", "assets");
await build({
  absWorkingDir: here,
  entryPoints: ["main.js"],
  outfile: join(assets, "replay.min.js"),
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2021",
  charset: "ascii",
  legalComments: "none",
  banner: {
    js: "/* three.js: MIT, see three.LICENSE.txt. Built from opsim/viewer/page by `npm ci && npm run build`. */",
  },
});
copyFileSync(join(here, "node_modules", "three", "LICENSE"), join(assets, "three.LICENSE.txt"));
