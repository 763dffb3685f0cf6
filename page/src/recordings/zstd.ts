// SPDX-License-Identifier: Apache-2.0
// Zstandard, which is loaded once a recording needs it.

/** Expands bytes. Errors: where they are damaged, or hold another number of bytes than `size`. */
export async function expandZstd(
  bytes: Uint8Array<ArrayBuffer>,
  size: number,
): Promise<Uint8Array<ArrayBuffer>> {
  const mostExpansion = 32768; // of a byte (RFC 8878, 3.1.1.2)
  if (size / mostExpansion > bytes.length) throw new Error("Compressed data is cut short.");
  const { decompress } = await import("fzstd");
  const plain = decompress(bytes, new Uint8Array(size)) as Uint8Array<ArrayBuffer>;
  if (plain.length !== size) throw new Error("Compressed data has another size than it says.");
  return plain;
}
