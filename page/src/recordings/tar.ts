// SPDX-License-Identifier: Apache-2.0

const block = 512; // [byte]

export interface NamedFile {
  readonly name: string;
  readonly blob: Blob;
}

/** The files in a tar archive (POSIX, ustar or pax), as parts of it. */
export async function filesOfTar(archive: Blob): Promise<NamedFile[]> {
  const files: NamedFile[] = [];
  let further: ReadonlyMap<string, string> = new Map(); // what the next head has no room for
  for (let at = 0; at + block <= archive.size;) {
    const head = new Uint8Array(await archive.slice(at, at + block).arrayBuffer());
    const text = (from: number, length: number) =>
      new TextDecoder().decode(head.subarray(from, from + length)).replace(/\0.*$/s, "");
    const name = text(0, 100);
    if (name === "") break;
    const size = Number(further.get("size") ?? sizeOf(head.subarray(124, 136), text(124, 12)));
    const type = text(156, 1);
    at += block;
    const blob = archive.slice(at, at + size);
    if (type === "" || type === "0")
      files.push({ name: baseName(further.get("path") ?? name), blob });
    further = type === "x" ? recordsOf(await blob.text()) : new Map();
    at += Math.ceil(size / block) * block;
  }
  return files;
}

/** The records of pax, "LENGTH KEY=VALUE" and a line end each. */
function recordsOf(text: string): Map<string, string> {
  const records = text.matchAll(/\d+ ([^=\n]+)=([^\n]*)\n/g);
  return new Map([...records].map(([, key, value]) => [key!, value!]));
}

/** A size in octal digits, or where its first bit is set as a binary number (GNU). */
function sizeOf(bytes: Uint8Array, text: string): number {
  if ((bytes[0]! & 0x80) === 0) return parseInt(text.trim(), 8) || 0;
  return bytes.subarray(4).reduce((sum, byte) => sum * 256 + byte, 0);
}

function baseName(path: string): string {
  return path.split("/").at(-1)!;
}
