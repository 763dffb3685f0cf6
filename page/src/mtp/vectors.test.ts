// SPDX-License-Identifier: Apache-2.0
// The vectors of spec/vectors: each file whole, byte by byte, and in random pieces.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { MtpError, numberText, Reader, writeMessage, type Message } from ".";

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

/** Ways to cut a number of bytes into pieces, as lengths. */
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

/** A message as JSON in the format of `hc cat --json` (spec/mtp-1.md, section 8). */
function messageJson(message: Message): string {
  const { header } = message;
  const start =
    `{"version":1,"src":${header.src},"dst":${header.dst},"seq":${header.seq},` +
    `"ttl":${header.ttl},"time":${header.time},"info":${header.info},"mode":${header.mode},` +
    `"coord":${header.coord},"width":${header.width},"height":${header.height},` +
    `"type":"${header.type}","components":${header.components},"scalar":"${header.scalar}",` +
    `"encoding":"${header.encoding}","elements":`;
  return start + elementsJson(message) + "}";
}

function elementsJson({ header, elements }: Message): string {
  const { width, height, components, encoding, scalar } = header;
  if (encoding === "zstd" || encoding === "jpeg") return "null";
  if (width === 0 || height === 0) return "[]";
  const number = (index: number) => {
    const text = numberText(elements[index]!, scalar);
    return /^-?(nan|inf)$/.test(text) ? `"${text}"` : text;
  };
  const rows = Array.from({ length: height }, (_, row) => {
    if (header.type === "string") {
      return stringJson((elements as Uint8Array).subarray(row * width, (row + 1) * width));
    }
    const inRow = Array.from({ length: width }, (_, column) => {
      const first = (row * width + column) * components;
      if (components === 1) return number(first);
      return `[${Array.from({ length: components }, (_, i) => number(first + i)).join(",")}]`;
    });
    return `[${inRow.join(",")}]`;
  });
  return `[${rows.join(",")}]`;
}

const escapes: Record<string, string> = {
  '"': '\\"',
  "\\": "\\\\",
  "\n": "\\n",
  "\r": "\\r",
  "\t": "\\t",
};

function stringJson(bytes: Uint8Array): string {
  const escaped = utf8(bytes).replace(
    /["\\\u0000-\u001f]/g,
    (c) => escapes[c] ?? "\\u" + c.charCodeAt(0).toString(16).padStart(4, "0"),
  );
  return `"${escaped}"`;
}

/** Text with U+FFFD for each byte that is not part of well-formed UTF-8. */
function utf8(bytes: Uint8Array): string {
  const decoder = new TextDecoder("utf-8", { fatal: true, ignoreBOM: true });
  let text = "";
  for (let i = 0; i < bytes.length;) {
    const lead = bytes[i]!;
    const length = lead < 0x80 ? 1 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
    try {
      text += decoder.decode(bytes.subarray(i, i + length));
      i += length;
    } catch {
      text += "\ufffd";
      i += 1;
    }
  }
  return text;
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
  // A basic reader does not look into JPEG or zstd data.
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
