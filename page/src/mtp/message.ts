// SPDX-License-Identifier: Apache-2.0
// A message: eleven integers, and a matrix of elements.
import { infoOf, type Kind } from "./info";

/** The header of a message (R4), with `info` parsed. */
export interface Header extends Kind {
  readonly src: number;
  readonly dst: number;
  readonly seq: bigint;
  readonly ttl: number;
  /** Time of the sensed event [ns since the Unix epoch]; 0: not given. */
  readonly time: bigint;
  readonly info: number;
  readonly mode: number;
  /** Coordinate system of the elements (R44). */
  readonly coord: number;
  /** Elements in a row. */
  readonly width: number;
  /** Rows. */
  readonly height: number;
}

export type Numbers =
  | Uint8Array<ArrayBuffer>
  | Int8Array<ArrayBuffer>
  | Uint16Array<ArrayBuffer>
  | Int16Array<ArrayBuffer>
  | Uint32Array<ArrayBuffer>
  | Int32Array<ArrayBuffer>
  | Float32Array<ArrayBuffer>
  | Float64Array<ArrayBuffer>;
export type BigIntegers = BigUint64Array<ArrayBuffer> | BigInt64Array<ArrayBuffer>;
export type Elements = Numbers | BigIntegers;

export interface Message {
  readonly header: Header;
  /**
   * height × width × components scalars, row by row; the bytes of a string; the compressed bytes of
   * the encodings zstd and jpeg. May be a view of the bytes read.
   */
  readonly elements: Elements;
}

/** A header of this kind and size, with the other fields of a new message (R42, R43). */
export function headerOf(
  kind: Kind,
  width: number,
  height: number,
  other: Partial<Pick<Header, "src" | "dst" | "seq" | "ttl" | "time" | "mode" | "coord">> = {},
): Header {
  return {
    src: 0,
    dst: 0,
    seq: 0n,
    ttl: 8,
    time: 0n,
    mode: 0,
    coord: 0,
    ...other,
    ...kind,
    info: infoOf(kind),
    width,
    height,
  };
}

/** Number of scalars of an uncompressed message; 0 if one side is 0. */
export function scalarCount(header: Header): number {
  return header.width * header.height * header.components;
}

/** The elements as numbers, 64-bit integers rounded above 2^53; none if compressed. */
export function numbersOf(message: Message): Numbers {
  const { encoding } = message.header;
  if (encoding === "zstd" || encoding === "jpeg") return new Uint8Array(0);
  const { elements } = message;
  if (elements instanceof BigInt64Array || elements instanceof BigUint64Array) {
    return Float64Array.from(elements, Number);
  }
  return elements;
}

/** Rows of a string, without the spaces at their ends (R32). */
export function rowsOf(message: Message): string[] {
  const { width, height } = message.header;
  const bytes = numbersOf(message) as Uint8Array<ArrayBuffer>;
  const decoder = new TextDecoder("utf-8", { ignoreBOM: true });
  return Array.from({ length: width === 0 ? 0 : height }, (_, row) =>
    decoder.decode(bytes.subarray(row * width, (row + 1) * width)).replace(/ +$/, ""),
  );
}

type Other = Parameters<typeof headerOf>[3];

/** A string message of one or several rows. */
export function textMessage(text: string | readonly string[], other: Other = {}): Message {
  const rows = (typeof text === "string" ? [text] : text).map((row) =>
    new TextEncoder().encode(row),
  );
  const width = Math.max(0, ...rows.map((row) => row.length));
  const elements = new Uint8Array(width * rows.length).fill(0x20);
  rows.forEach((row, i) => elements.set(row, i * width));
  const kind: Kind = { type: "string", components: 1, scalar: "u8", encoding: "text" };
  return { header: headerOf(kind, width, rows.length, other), elements };
}

/** A binary message with one element of f64 components. */
export function numbersMessage(
  type: "position" | "rotation" | "table",
  numbers: readonly number[],
  other: Other = {},
): Message {
  const kind: Kind = { type, components: numbers.length, scalar: "f64", encoding: "binary" };
  return { header: headerOf(kind, 1, 1, other), elements: Float64Array.from(numbers) };
}
