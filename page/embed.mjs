// SPDX-License-Identifier: Apache-2.0
// Makes C++ of a bundled page: node embed.mjs FOLDER writes FOLDER/assets.cpp, behind
// modules/web/assets.h, which takes in the compressed files beside it.
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { gzipSync } from "node:zlib";

const folder = resolve(process.argv[2]);
const types = {
  html: "text/html; charset=utf-8",
  js: "text/javascript; charset=utf-8",
  css: "text/css; charset=utf-8",
  txt: "text/plain; charset=utf-8",
};
const names = readdirSync(folder)
  .filter((name) => name.split(".").pop() in types)
  .sort();
const data = [];
const entries = [];
names.forEach((name, i) => {
  const file = join(folder, name + ".gz");
  writeFileSync(file, gzipSync(readFileSync(join(folder, name)), { level: 9 }));
  data.push(
    `asm(".section .rodata\\n"\n` +
      `    ".global hc_page_${i}, hc_page_${i}_end\\n"\n` +
      `    "hc_page_${i}: .incbin \\"${file}\\"\\n"\n` +
      `    "hc_page_${i}_end: .byte 0\\n"\n` +
      `    ".text\\n");\n` +
      `extern "C" const char hc_page_${i}[], hc_page_${i}_end[];`,
  );
  entries.push(
    `      {"${name}", "${types[name.split(".").pop()]}", {hc_page_${i}, hc_page_${i}_end}},`,
  );
});
writeFileSync(
  join(folder, "assets.cpp"),
  `// Written by page/embed.mjs.\n#include "assets.h"\n\n${data.join("\n")}\n\n` +
    `const std::vector<Asset>& page_assets() {\n  static const std::vector<Asset> kAll = {\n` +
    `${entries.join("\n")}\n  };\n  return kAll;\n}\n`,
);
