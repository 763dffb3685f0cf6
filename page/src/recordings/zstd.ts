// SPDX-License-Identifier: Apache-2.0
// Zstandard, loaded when a recording needs it.

/** Expands bytes. Errors: damaged, or not of this size. */
export async function expandZstd(
  bytes: Uint8Array<ArrayBuffer>,
  size: number,
): Promise<Uint8Array<ArrayBuffer>> {
  const mostExpansion = 32768; // bytes per compressed byte (RFC 8878, 3.1.1.2)
  if (size / mostExpansion > bytes.length) throw new Error("Compressed data is truncated.");
  const { decompress } = await import("fzstd");
  const plain = decompress(bytes, new Uint8Array(size)) as Uint8Array<ArrayBuffer>;
  if (plain.length !== size) throw new Error("Compressed data has the wrong size.");
  return plain;
}
