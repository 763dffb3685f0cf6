// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { openMcap } from "./mcap";

const folder = join(process.env.HC_VECTORS!, "../../tests/fuzz/corpus/mcap");
const small = readFileSync(join(folder, "small.mcap"));
const zstd = readFileSync(join(folder, "zstd.mcap"));

test("each message of a recording is found, its elements here or in its companion", async () => {
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
  await assert.rejects(
    openMcap(new Blob(["1 7 0 0 8 0 10390 1 3 1 1\n1 2 3\n"])),
    /not an MCAP file/,
  );
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

/**
 * A file of MCAP, whose chunks have these messages of a stream `s.numbers`, and their companions.
 *
 * @param timeOf  log time of a message by its sequence [s].
 * @param description  of the module `s`.
 */
function fileOf(
  chunks: ("message" | "companion")[][],
  timeOf = (sequence: number) => 1 + sequence,
  description = "",
): Blob {
  const number = (size: number, value: number) => {
    const bytes = Buffer.alloc(size);
    bytes.writeUIntLE(value, 0, Math.min(size, 6));
    return bytes;
  };
  const text = (words: string) => Buffer.concat([number(4, words.length), Buffer.from(words)]);
  const list = (...parts: Buffer[]) => {
    const bytes = Buffer.concat(parts);
    return Buffer.concat([number(4, bytes.length), bytes]);
  };
  const record = (opcode: number, ...parts: Buffer[]) => {
    const content = Buffer.concat(parts);
    return Buffer.concat([number(1, opcode), number(8, content.length), content]);
  };
  const channel = (id: number, topic: string, key: string, value: string) =>
    record(4, number(2, id), number(2, 0), text(topic), text("cdr"), list(text(key), text(value)));
  const header = "1 0 0 0 8 0 120190 0 0 2 1";
  const matrix = Buffer.concat([Buffer.alloc(4), text(header), Buffer.alloc(-header.length & 3)]);
  const counts = { message: 0, companion: 0 };
  const magic = Buffer.from(small.subarray(0, 8));
  const file = [magic];
  const size = () => file.reduce((sum, part) => sum + part.length, 0);
  const summary = [channel(1, "/s", "hypercolumn.mtp", "/s/mtp")];
  summary.push(channel(2, "/s/mtp", "hypercolumn.stream", "s.numbers"));
  for (const kinds of chunks) {
    const records: Buffer[] = [];
    const indexes: Buffer[] = [];
    for (const kind of kinds) {
      const sequence = counts[kind]++;
      const elements = Buffer.from(new Float64Array([sequence, 0.5]).buffer);
      const data =
        kind === "companion"
          ? Buffer.concat([Buffer.alloc(8), elements])
          : Buffer.concat([matrix, number(4, 8), number(4, 16), number(4, 0)]);
      const id = number(2, kind === "companion" ? 1 : 2);
      const time = number(8, 1e9 * timeOf(sequence));
      const offset = Buffer.concat(records).length;
      records.push(record(5, id, number(4, sequence), time, time, data));
      indexes.push(record(7, id, list(time, number(8, offset))));
    }
    const plain = Buffer.concat(records);
    const index = Buffer.concat(indexes);
    const stored = number(8, plain.length);
    const at = size();
    file.push(record(6, number(28, 0), text(""), stored, plain));
    const length = number(8, size() - at);
    file.push(index);
    const place = [number(16, 0), number(8, at), length, list(), number(8, index.length)];
    summary.push(record(8, ...place, text(""), stored, stored));
  }
  const name = text("hypercolumn.description.s");
  const metadata = record(12, name, list(text("json"), text(description)));
  summary.push(record(13, number(8, size()), number(8, metadata.length), name));
  file.push(metadata);
  const begin = number(8, size());
  return new Blob([...file, ...summary, record(2, begin, number(12, 0)), magic] as BlobPart[]);
}

test("a chunk may end between a message and its companion", async () => {
  for (const chunks of [
    [["companion", "message", "companion", "message"]],
    [["companion"], ["message", "companion"], ["message"]],
    [["message"], ["companion", "message"], ["companion"]],
    [
      ["message", "message"],
      ["companion", "companion"],
    ],
  ] as ("message" | "companion")[][][]) {
    const [track] = await openMcap(fileOf(chunks));
    const messages = await Promise.all([0, 1].map((index) => track!.message(index)));
    assert.deepEqual(
      messages.map(({ elements }) => [...elements]),
      [
        [0, 0.5],
        [1, 0.5],
      ],
    );
  }
});

test("messages of one log time have their own companions", async () => {
  for (const chunks of [
    [["message", "message", "companion", "companion"]],
    [["companion", "companion"], ["message"], ["message"]],
    [
      ["companion", "message"],
      ["message", "message"],
      ["companion", "companion"],
    ],
  ] as ("message" | "companion")[][][]) {
    const [track] = await openMcap(fileOf(chunks, () => 1));
    const messages = Array.from({ length: track!.length }, (_, index) => track!.message(index));
    assert.deepEqual(
      (await Promise.all(messages)).map(({ elements }) => [...elements]),
      messages.map((_, index) => [index, 0.5]),
    );
  }
});

test("a message is as large as it and its companion, whichever comes first", async () => {
  const [[track], [other]] = await Promise.all([
    openMcap(fileOf([["companion", "message"]])),
    openMcap(fileOf([["message", "companion"]])),
  ]);
  assert.equal(track!.usualBytes, other!.usualBytes);
});

test("a stream has what its module declares of its outputs, where that was recorded", async () => {
  const described = async (text: string) => {
    const [track] = await openMcap(fileOf([["companion", "message"]], () => 1, text));
    return track!.outputs;
  };
  const columns = ["mode", "age [s]"];
  const output = { name: "numbers", types: [], columns };
  const [declared] = await described(
    JSON.stringify({ inputs: [], outputs: [output], parameters: [] }),
  );
  assert.deepEqual([declared!.port, declared!.columns], ["s.numbers", columns]);
  for (const text of ["", "{", "null", "[]", '{"outputs":3}'])
    assert.deepEqual(await described(text), []);
});

test("a message whose elements are missing says so, and the others are found", async () => {
  const [track] = await openMcap(fileOf([["message"], ["message", "companion"]]));
  await assert.rejects(track!.message(1), /lacks its elements/);
  assert.deepEqual([...(await track!.message(0)).elements], [0, 0.5]);
});
