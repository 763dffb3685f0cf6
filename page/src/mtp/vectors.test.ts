// SPDX-License-Identifier: Apache-2.0
// The vectors of spec/vectors: each file whole, byte by byte, and in random pieces.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { messageJson, MtpError, Reader, writeMessage, type Message } from ".";

const vectors = process.env.HC_VECTORS!;
const jpegOrZstd = /"encoding":"(jpeg|zstd)"/;

function bytesOfFile(path: string): Uint8Array<ArrayBuffer> {
  return new Uint8Array(readFileSync(path));
}

function names(folder: string): string[] {
  const files = readdirSync(join(vectors, folder)).filter((name) => name.endsWith(".mtp"));
  assert.ok(files.length > 0);
  return files.map((name) => name.slice(0, -".mtp".length));
}

/** Ways to cut so many bytes: lengths of the pieces. */
function* cuts(length: number): Generator<() => number> {
  yield () => length;
  yield () => 1;
  let state = 12345;
  yield () => ((state = (state * 1103515245 + 12345) % 2 ** 31) % 37) + 1;
}

interface Outcome {
  readonly messages: Message[];
  readonly error?: MtpError;
}

function readAll(bytes: Uint8Array<ArrayBuffer>, size: () => number): Outcome {
  const reader = new Reader();
  const messages: Message[] = [];
  try {
    for (let at = 0; at < bytes.length;) {
      const piece = bytes.slice(at, at + size());
      at += piece.length;
      reader.push(piece);
      for (let message; (message = reader.next());) messages.push(message);
    }
    reader.end();
  } catch (error) {
    if (!(error instanceof MtpError)) throw error;
    return { messages, error };
  }
  return { messages };
}

for (const name of names("valid")) {
  test(`valid ${name}`, () => {
    const bytes = bytesOfFile(join(vectors, "valid", name + ".mtp"));
    const lines = readFileSync(join(vectors, "valid", name + ".json"), "utf8").split("\n");
    const wanted = lines
      .slice(0, -1)
      .map((line) =>
        jpegOrZstd.test(line) ? line.replace(/"elements":.*/, '"elements":null}') : line,
      );
    for (const size of cuts(bytes.length)) {
      const { messages, error } = readAll(bytes, size);
      assert.equal(error, undefined);
      assert.deepEqual(messages.map(messageJson), wanted);
      if (!name.endsWith("_loose")) {
        assert.deepEqual(Buffer.concat(messages.map(writeMessage)), Buffer.from(bytes));
      }
    }
  });
}

for (const name of names("invalid")) {
  // What a JPEG or zstd frame holds, a basic reader does not look at.
  const isOfBasicReader = !/^R3[67]_/.test(name);
  test(`invalid ${name}`, { skip: !isOfBasicReader }, () => {
    const bytes = bytesOfFile(join(vectors, "invalid", name + ".mtp"));
    const wanted: unknown = JSON.parse(
      readFileSync(join(vectors, "invalid", name + ".json"), "utf8"),
    );
    for (const size of cuts(bytes.length)) {
      const { messages, error } = readAll(bytes, size);
      assert.ok(error);
      const { rule, field, byte } = error;
      assert.deepEqual({ rule, field, byte, messages: messages.length }, wanted);
    }
  });
}
