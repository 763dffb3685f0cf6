// SPDX-License-Identifier: Apache-2.0
// Recordings, read by libraries that are not ours: whole and by their index, with every CRC checked
// and every message decoded.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { open } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { FileHandleReadable } from "@mcap/nodejs";
import { loadDecompressHandlers } from "@mcap/support";

const build = process.env.HC_BUILD;
const data = process.env.HC_DATA ?? "/usr/share/doc/opencv-doc/examples/data";
const folder = mkdtempSync(join(tmpdir(), "hc-mcap-"));
const file = process.env.HC_RECORDING ?? join(folder, "x.mcap");
const raw = join(folder, "x.mtp");

function shell(command) {
  const { status, stdout, stderr } = spawnSync("bash", ["-c", command], {
    cwd: folder,
    env: { ...process.env, PATH: `${build}/bin:${process.env.PATH}`, HC_DATA: data },
    maxBuffer: 1 << 28,
  });
  assert.equal(status, 0, `${command}\n${stderr}`);
  return stdout;
}

before(() => {
  if (process.env.HC_RECORDING) return;
  shell(`(hc camera $HC_DATA/aloeL.jpg --width 320 --height 240 --loop --count 40 --rate 0
          hc send --type position 1 2 3; hc send 1 2; hc send words
          hc send --image $HC_DATA/aloeL.jpg --encoding jpeg) >x.mtp; hc record x.mtp x.mcap`);
});
after(() => rmSync(folder, { recursive: true, force: true }));

/** Decodes messages as the schemas of their channels say. */
function decoder() {
  const readers = new Map();
  return (channel, schema, message) => {
    assert.equal(channel.messageEncoding, "cdr");
    assert.equal(schema.encoding, "ros2msg");
    if (!readers.has(schema.id)) {
      const text = new TextDecoder().decode(schema.data);
      readers.set(schema.id, new MessageReader(parse(text, { ros2: true })));
    }
    return readers.get(schema.id).readMessage(message.data);
  };
}

async function indexed(use) {
  const handle = await open(file);
  try {
    const decompressHandlers = await loadDecompressHandlers();
    const readable = new FileHandleReadable(handle);
    return await use(await McapIndexedReader.Initialize({ readable, decompressHandlers }));
  } finally {
    await handle.close();
  }
}

test("the index leads to every message, and each decodes", async () => {
  await indexed(async (reader) => {
    const decode = decoder();
    let messages = 0n;
    const counts = new Map();
    for await (const message of reader.readMessages({ validateCrcs: true })) {
      const channel = reader.channelsById.get(message.channelId);
      decode(channel, reader.schemasById.get(channel.schemaId), message);
      counts.set(channel.id, (counts.get(channel.id) ?? 0n) + 1n);
      ++messages;
    }
    assert.equal(reader.statistics.messageCount, messages);
    assert.deepEqual(new Map([...reader.statistics.channelMessageCounts].sort()), new Map([...counts].sort()));
    assert.equal(reader.statistics.chunkCount, reader.chunkIndexes.length);
    assert.match(reader.header.library, /^hypercolumn /);
    for (const channel of reader.channelsById.values())
      assert.match(channel.metadata.get("offered_qos_profiles"), /reliability: 1/);
  });
});

test("read from its begin, it is the same, and no record breaks a rule", async () => {
  const decompressHandlers = await loadDecompressHandlers();
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  const bytes = readFileSync(file);
  const channels = new Map();
  const schemas = new Map();
  const decode = decoder();
  let messages = 0;
  let expected;
  for (let at = 0; at < bytes.length; at += 100_000) {
    reader.append(bytes.subarray(at, at + 100_000));
    for (let record; (record = reader.nextRecord()); ) {
      if (record.type === "Schema") schemas.set(record.id, record);
      if (record.type === "Channel") channels.set(record.id, record);
      if (record.type === "Statistics") expected = Number(record.messageCount);
      if (record.type !== "Message") continue;
      const channel = channels.get(record.channelId);
      decode(channel, schemas.get(channel.schemaId), record);
      ++messages;
    }
  }
  assert.ok(reader.done());
  assert.equal(messages, expected);
});

test("the header's line and the elements make the message again", async (t) => {
  if (process.env.HC_RECORDING) return t.skip("of another recording");
  const wanted = readFileSync(raw);
  await indexed(async (reader) => {
    const decode = decoder();
    const companions = new Map();
    const parts = [];
    // In the order of the file: log times are those of sensing.
    for await (const message of reader.readMessages()) {
      const channel = reader.channelsById.get(message.channelId);
      const schema = reader.schemasById.get(channel.schemaId);
      const decoded = decode(channel, schema, message);
      if (schema.name !== "hypercolumn_msgs/msg/Matrix") {
        companions.set(channel.metadata.get("hypercolumn.mtp"), message.data);
        continue;
      }
      const { header, offset, size, elements } = decoded;
      if (header.split(" ")[6] !== "30301") continue; // the rest is text, or compressed
      assert.ok(offset > 0, "no image is stored twice");
      assert.equal(elements.length, 0);
      const data = companions.get(channel.topic).subarray(offset, offset + size);
      parts.push(Buffer.from(header + "\n"), data, Buffer.from("\n"));
    }
    const images = Buffer.concat(parts);
    assert.ok(images.length > 40 * 320 * 240 * 3);
    assert.ok(wanted.subarray(0, images.length).equals(images));
  });
});
