// SPDX-License-Identifier: Apache-2.0
// A message as JSON, just as `hc cat --json` prints it (spec/mtp-1.md, section 8).
import type { Message } from "./message";
import { numberText } from "./number";

export function messageJson(message: Message): string {
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

/** Text, each byte that is not part of well-formed UTF-8 being U+FFFD. */
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
