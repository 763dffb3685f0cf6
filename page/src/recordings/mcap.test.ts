// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { openMcap } from "./mcap";

const folder = join(process.env.HC_VECTORS!, "../../tests/fuzz/corpus/mcap");
const small = readFileSync(join(folder, "small.mcap"));
const zstd = readFileSync(join(folder, "zstd.mcap"));

test("each message of a recording is found, its elements here or beside", async () => {
  const [track, ...others] = await openMcap(new Blob([small]));
  assert.equal(others.length, 0);
  assert.equal(track!.port, "s");
  const messages = await Promise.all([0, 1, 2].map((index) => track!.message(index)));
  assert.deepEqual(
    messages.map(({ header, elements }) => [header.type, ...elements]),
    [
      ["intensity_image", 65, 66],
      ["position", 0.1, 0.2, 0.3],
      ["string", ...new TextEncoder().encode("hello")],
    ],
  );
});

test("chunks in zstd are expanded", async () => {
  const tracks = await openMcap(new Blob([zstd]));
  assert.deepEqual(
    tracks.map(({ port, length }) => [port, length]),
    [
      ["camera.left", 20],
      ["brightness.mean", 20],
    ],
  );
  const { header, elements } = await tracks[0]!.message(19);
  assert.deepEqual([header.seq, elements.length], [19n, 3 * 8 * 6]);
});

test("a file without its end is refused with what mends it, at any length", async () => {
  for (let size = 8; size < small.length; size += 7)
    await assert.rejects(openMcap(new Blob([small.subarray(0, size)])), /hc record cut.mcap/);
});

test("a damaged file ends with a sentence", async () => {
  await assert.rejects(openMcap(new Blob(["1 7 0 0 8 0 10390 1 3 1 1\n1 2 3\n"])), /no MCAP file/);
  let seed = 1;
  const random = () => (seed = (seed * 48271) % 2147483647);
  for (let round = 0; round < 300; ++round) {
    const bytes = Uint8Array.from(small);
    for (let i = 0; i < 3; ++i) bytes[random() % bytes.length] = random();
    try {
      for (const track of await openMcap(new Blob([bytes])))
        for (let i = 0; i < track.length; ++i) await track.message(i);
    } catch (error) {
      assert.ok(error instanceof Error);
    }
  }
});
