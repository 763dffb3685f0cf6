// SPDX-License-Identifier: Apache-2.0
// The header line (spec/mtp-1.md, section 2).
import { MtpError } from "./error";
import { kindOf, scalarBytes, type Kind } from "./info";
import type { Header } from "./message";
import { isInteger } from "./number";

export const maxHeaderBytes = 256;

const i31 = 2n ** 31n - 1n;
const i63 = 2n ** 63n - 1n;
/** The fields in order, and the range of each. */
const ranges = {
  version: [1n, 1n],
  src: [0n, i31],
  dst: [-(2n ** 31n), i31],
  seq: [0n, i63],
  ttl: [0n, 255n],
  time: [0n, i63],
  info: [0n, i31],
  mode: [0n, i31],
  coord: [0n, i31],
  width: [0n, i31],
  height: [0n, i31],
} as const;
export type HeaderField = keyof typeof ranges;
export const headerFields = Object.keys(ranges) as HeaderField[];

interface Word {
  readonly text: string;
  /** Offset from the start of the line. */
  readonly at: number;
}

/**
 * Parses a header line.
 *
 * @param line  without its line end; one character per byte.
 * @param start  the line's offset in the stream, for errors.
 * @param limit  maximum bytes of the elements (R24).
 * Errors: MtpError R4 … R24.
 */
export function parseHeader(line: string, start: number, limit: number): Header {
  const words: Word[] = [...line.matchAll(/[^ ]+/g)].map(({ 0: text, index }) => ({
    text,
    at: index,
  }));
  const refuse = (rule: string, field: string, at: number, why = ""): never => {
    throw new MtpError(rule, field, start + at, why);
  };
  const values = {} as Record<HeaderField, bigint>;
  let kind: Kind | undefined;
  headerFields.forEach((field, index) => {
    const word = words[index];
    if (!word) return refuse("R4", field, line.length, "the field is missing");
    if (!isInteger(word.text))
      return refuse("R5", field, word.at, `${word.text} is not an integer`);
    const value = BigInt(word.text);
    const [least, most] = ranges[field];
    if (value < least || value > most) return refuse(`R${index + 6}`, field, word.at);
    values[field] = value;
    if (field === "info") {
      const found = kindOf(Number(value));
      if (typeof found === "string") return refuse(found, field, word.at);
      kind = found;
    }
    const rule = kind && sideRule(kind, field, values);
    if (rule) refuse(rule, field, word.at);
  });
  const extra = words[headerFields.length];
  if (extra) refuse("R4", "header", extra.at, "extra field");
  const width = Number(values.width);
  const height = Number(values.height);
  if (width * height * kind!.components * scalarBytes[kind!.scalar] > limit) {
    const at = words[headerFields.indexOf("width")]!.at;
    refuse("R24", "width", at, `the elements take more than ${limit} bytes`);
  }
  return {
    ...kind!,
    src: Number(values.src),
    dst: Number(values.dst),
    seq: values.seq,
    ttl: Number(values.ttl),
    time: values.time,
    info: Number(values.info),
    mode: Number(values.mode),
    coord: Number(values.coord),
    width,
    height,
  };
}

/** Parses the original header of a stream, of any size; undefined if invalid. */
export function sentHeader(line: string): Header | undefined {
  try {
    return parseHeader(line.trim(), 0, Infinity);
  } catch {
    return undefined;
  }
}

/** The rule violated by the width or height, R21 … R23. */
function sideRule(
  kind: Kind,
  field: HeaderField,
  values: Record<HeaderField, bigint>,
): string | undefined {
  if (field !== "width" && field !== "height") return undefined;
  const value = values[field];
  if (kind.encoding === "jpeg" && (value < 1n || value > 65500n)) return "R21";
  if (field === "width" && kind.type === "sparse_graph" && value !== 1n) return "R22";
  if (field === "height" && kind.type === "dense_graph" && value !== values.width) return "R23";
  return undefined;
}

/** The header line in canonical form, with its line feed. */
export function headerLine(header: Header): string {
  const fields = headerFields.map((field) => (field === "version" ? 1 : header[field]));
  return fields.join(" ") + "\n";
}
