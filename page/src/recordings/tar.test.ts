// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { filesOfTar } from "./tar";

test("the files of an archive that tar made", async () => {
  const folder = mkdtempSync(join(tmpdir(), "tar-"));
  try {
    mkdirSync(join(folder, "take"));
    writeFileSync(join(folder, "take/a.b.mtp"), "x".repeat(1000));
    writeFileSync(join(folder, "take/c.d.mtp"), "");
    writeFileSync(join(folder, "take/e.f.mtp"), "last");
    execFileSync("tar", ["--format=ustar", "--sort=name", "-cf", "take.tar", "take"], {
      cwd: folder,
    });
    const files = await filesOfTar(new Blob([readFileSync(join(folder, "take.tar"))]));
    assert.deepEqual(
      await Promise.all(files.map(async (file) => [file.name, await file.blob.text()])),
      [
        ["a.b.mtp", "x".repeat(1000)],
        ["c.d.mtp", ""],
        ["e.f.mtp", "last"],
      ],
    );
  } finally {
    rmSync(folder, { recursive: true });
  }
});

test("a name that is too long for a head is read from the head before it", async () => {
  const folder = mkdtempSync(join(tmpdir(), "tar-"));
  try {
    const name = `a.${"b".repeat(200)}.mtp`;
    writeFileSync(join(folder, name), "long");
    writeFileSync(join(folder, "c.d.mtp"), "short");
    execFileSync("tar", ["--format=pax", "-cf", "take.tar", name, "c.d.mtp"], { cwd: folder });
    const files = await filesOfTar(new Blob([readFileSync(join(folder, "take.tar"))]));
    assert.deepEqual(
      await Promise.all(files.map(async (file) => [file.name, await file.blob.text()])),
      [
        [name, "long"],
        ["c.d.mtp", "short"],
      ],
    );
  } finally {
    rmSync(folder, { recursive: true });
  }
});

test("an empty archive, no files", async () => {
  assert.deepEqual(await filesOfTar(new Blob([new Uint8Array(1024)])), []);
});
