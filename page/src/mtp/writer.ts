// SPDX-License-Identifier: Apache-2.0
// Writes messages as bytes (spec/mtp-1.md, section 5).
import { bytesOf } from "./elements";
import { headerLine } from "./header";
import type { Message } from "./message";
import { numberText } from "./number";

/** The bytes of a message in canonical form (R38); compressed elements stay compressed. */
export function writeMessage(message: Message): Uint8Array<ArrayBuffer> {
  const { header, elements } = message;
  const encoder = new TextEncoder();
  const isCompressed = header.encoding === "zstd" || header.encoding === "jpeg";
  const start = headerLine(header) + (isCompressed ? `${elements.length}\n` : "");
  if (header.encoding === "text" && header.type !== "string") {
    return encoder.encode(start + (numbersText(message) || "\n"));
  }
  const head = encoder.encode(start);
  const body = bytesOf(elements);
  const bytes = new Uint8Array(head.length + body.length + 1);
  bytes.set(head);
  bytes.set(body, head.length);
  bytes[bytes.length - 1] = 0x0a;
  return bytes;
}

/** The rows, a line each. */
function numbersText({ header, elements }: Message): string {
  const inRow = header.width * header.components;
  if (inRow === 0) return "";
  let text = "";
  for (let row = 0; row < header.height; ++row) {
    const numbers: string[] = [];
    for (let i = row * inRow; i < (row + 1) * inRow; ++i) {
      numbers.push(numberText(elements[i]!, header.scalar));
    }
    text += numbers.join(" ") + "\n";
  }
  return text;
}
