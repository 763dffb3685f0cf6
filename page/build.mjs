// SPDX-License-Identifier: Apache-2.0
// Bundles the page: node build.mjs OUT. OUT gets index.html, page.js, page.css and the chunks that
// page.js loads later, and no other such files; and assets.cpp, the source for modules/web/assets.h,
// with their compressed contents. Fails if the first load exceeds the limit.
import {
  appendFileSync,
  copyFileSync,
  mkdirSync,
  readFileSync,
  readdirSync,
  rmSync,
  writeFileSync,
} from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";

const firstLoadLimit = 300_000; // bytes, compressed
const types = { html: "text/html", js: "text/javascript", css: "text/css" };
const isAsset = (name) => name.split(".").pop() in types;
const here = dirname(fileURLToPath(import.meta.url));
if (!process.argv[2]) {
  console.error("usage: node build.mjs OUT");
  process.exit(2);
}
const out = resolve(process.argv[2]);
mkdirSync(out, { recursive: true });
for (const name of readdirSync(out)) {
  if (isAsset(name)) rmSync(join(out, name));
}

const result = await build({
  absWorkingDir: here,
  entryPoints: ["src/page.ts", "src/page.css"],
  outdir: out,
  bundle: true,
  splitting: true,
  format: "esm",
  target: "es2022",
  minify: true,
  legalComments: "none",
  chunkNames: "[name]-[hash]",
  logLevel: "warning",
  metafile: true,
});
appendFileSync(join(out, "page.js"), licences());
copyFileSync(join(here, "index.html"), join(out, "index.html"));

/** The licences of the bundled packages, as a comment. */
function licences() {
  const packages = new Set(
    Object.keys(result.metafile.inputs)
      .map((path) => /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(path)?.[1])
      .filter(Boolean),
  );
  const texts = [...packages].sort().map((name) => {
    const text = readFileSync(join(here, "node_modules", name, "LICENSE"), "utf8");
    return `${name}\n\n${text.trim()}`;
  });
  return `/*\nThis page contains the following packages.\n\n${texts.join("\n\n")}\n*/\n`;
}

/** The files loaded initially: the page, and the static imports of page.js. */
function firstLoad() {
  const names = new Set(["index.html", "page.css"]);
  const outputs = Object.entries(result.metafile.outputs).map(([path, output]) => ({
    name: path.split("/").pop(),
    imports: output.imports
      .filter((each) => each.kind === "import-statement")
      .map((each) => each.path.split("/").pop()),
  }));
  const add = (name) => {
    if (names.has(name)) return;
    names.add(name);
    outputs.find((output) => output.name === name)?.imports.forEach(add);
  };
  add("page.js");
  return names;
}

const first = firstLoad();
let total = 0;
let data = "";
let entries = "";
const names = readdirSync(out).filter(isAsset).sort();
names.forEach((name, i) => {
  const bytes = gzipSync(readFileSync(join(out, name)), { level: 9 });
  if (first.has(name)) total += bytes.length;
  const size = String(bytes.length).padStart(8);
  console.log(`${size} B ${name}${first.has(name) ? "" : " (later)"}`);
  const file = join(out, name + ".gz");
  writeFileSync(file, bytes);
  data += `asm(".section .rodata\\n"
    ".global hc_page_${i}, hc_page_${i}_end\\n"
    "hc_page_${i}: .incbin \\"${file}\\"\\n"
    "hc_page_${i}_end: .byte 0\\n"
    ".text\\n");
extern "C" const char hc_page_${i}[], hc_page_${i}_end[];
`;
  const type = types[name.split(".").pop()] + "; charset=utf-8";
  entries += `      {"${name}", "${type}", {hc_page_${i}, hc_page_${i}_end}},\n`;
});
writeFileSync(
  join(out, "assets.cpp"),
  `// Written by page/build.mjs.
#include "assets.h"

${data}
const std::vector<Asset>& page_assets() {
  static const std::vector<Asset> kAll = {
${entries}  };
  return kAll;
}
`,
);
console.log(`${String(total).padStart(8)} B first load, compressed`);
if (total > firstLoadLimit) {
  console.error(`the first load is above ${firstLoadLimit} B`);
  process.exit(1);
}
