// SPDX-License-Identifier: Apache-2.0
// Runs the unit tests, src/**/*.test.ts: node test.mjs [PATTERN]. A pattern chooses files by path.
import { spawnSync } from "node:child_process";
import { mkdtempSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const pattern = new RegExp(process.argv[2] ?? "");
const tests = readdirSync(join(here, "src"), { withFileTypes: true })
  .filter((folder) => folder.isDirectory())
  .flatMap(({ name }) => readdirSync(join(here, "src", name)).map((file) => `src/${name}/${file}`))
  .filter((path) => path.endsWith(".test.ts") && pattern.test(path));
if (tests.length === 0) {
  console.error(`no test matches ${pattern}`);
  process.exit(1);
}

const out = mkdtempSync(join(tmpdir(), "page-test-"));
try {
  await build({
    absWorkingDir: here,
    entryPoints: tests,
    outdir: out,
    outExtension: { ".js": ".mjs" },
    bundle: true,
    platform: "node",
    format: "esm",
    logLevel: "warning",
  });
  const files = readdirSync(out, { recursive: true }).filter((name) => name.endsWith(".mjs"));
  const folders = {
    HC_VECTORS: join(here, "../spec/vectors"),
    HC_GRAPHS: join(here, "../graphs"),
  };
  const run = spawnSync(
    process.execPath,
    ["--test", "--test-reporter=spec", ...files.map((f) => join(out, f))],
    { stdio: "inherit", env: { ...folders, ...process.env } },
  );
  process.exitCode = run.status ?? 1;
} finally {
  rmSync(out, { recursive: true });
}
