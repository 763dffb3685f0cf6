// SPDX-License-Identifier: Apache-2.0
import { arrays, type Scalar } from "./info";
import type { Elements } from "./message";

/** So many scalars, all 0. */
export function zeros(scalar: Scalar, count: number): Elements {
  return new arrays[scalar](count);
}

/**
 * Bytes as scalars, little-endian as this machine is (all that run browsers are). A view where the
 * bytes are aligned, else a copy.
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
