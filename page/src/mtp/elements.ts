// SPDX-License-Identifier: Apache-2.0
import { arrays, type Scalar } from "./info";
import type { Elements } from "./message";

/** An array of zeros. */
export function zeros(scalar: Scalar, count: number): Elements {
  return new arrays[scalar](count);
}

/**
 * Bytes as scalars, little-endian like all machines with browsers. A view if aligned, else a
 * copy.
 */
export function elementsOf(scalar: Scalar, bytes: Uint8Array<ArrayBuffer>): Elements {
  const Type = arrays[scalar];
  const size = Type.BYTES_PER_ELEMENT;
  const aligned = bytes.byteOffset % size === 0 ? bytes : bytes.slice();
  return new Type(aligned.buffer, aligned.byteOffset, bytes.length / size);
}

export function bytesOf(elements: Elements): Uint8Array<ArrayBuffer> {
  return new Uint8Array(elements.buffer, elements.byteOffset, elements.byteLength);
}
