// SPDX-License-Identifier: Apache-2.0
// The field `info`: the type of a message's elements (spec/mtp-1.md, section 3).

export const matrixTypes = [
  "position",
  "rotation",
  "rgb_image",
  "intensity_image",
  "vector_field",
  "string",
  "transformation",
  "dense_graph",
  "sparse_graph",
  "sound",
  "map",
  "table",
] as const;
export type MatrixType = (typeof matrixTypes)[number];

/** Array types of the scalars, in the order of their numbers. */
export const arrays = {
  u8: Uint8Array,
  i8: Int8Array,
  u16: Uint16Array,
  i16: Int16Array,
  u32: Uint32Array,
  i32: Int32Array,
  u64: BigUint64Array,
  i64: BigInt64Array,
  f32: Float32Array,
  f64: Float64Array,
} as const;
export type Scalar = keyof typeof arrays;
export const scalars = Object.keys(arrays) as Scalar[];
/** [byte] */
export const scalarBytes = Object.fromEntries(
  scalars.map((scalar) => [scalar, arrays[scalar].BYTES_PER_ELEMENT]),
) as Record<Scalar, number>;

export const encodings = ["text", "binary", "zstd", "jpeg"] as const;
export type Encoding = (typeof encodings)[number];

/** The meaning of the digits of `info`. */
export interface Kind {
  readonly type: MatrixType;
  readonly components: number;
  readonly scalar: Scalar;
  readonly encoding: Encoding;
}

/** `info` of a kind: its digits are TTCCSE. */
export function infoOf(kind: Kind): number {
  return (
    (matrixTypes.indexOf(kind.type) + 1) * 10000 +
    kind.components * 100 +
    scalars.indexOf(kind.scalar) * 10 +
    encodings.indexOf(kind.encoding)
  );
}

/** Allowed components (first and last, or a list) and scalars of a type, R18 and R19. */
const many = Array.from({ length: 99 }, (_, i) => i + 1);
const floats: readonly Scalar[] = ["f32", "f64"];
const allowed: Record<MatrixType, { components: readonly number[]; scalars: readonly Scalar[] }> = {
  position: { components: [3, 6, 9], scalars: floats },
  rotation: { components: [3, 6, 9], scalars: floats },
  rgb_image: { components: [3, 4], scalars: ["u8", "u16", "f32", "f64"] },
  intensity_image: { components: [1], scalars },
  vector_field: { components: many, scalars },
  string: { components: [1], scalars: ["u8"] },
  transformation: { components: [1], scalars: floats },
  dense_graph: { components: many, scalars },
  sparse_graph: { components: many.slice(1), scalars },
  sound: { components: many, scalars },
  map: { components: many, scalars },
  table: { components: many, scalars },
};

/** The kind of an `info`, or the rule that it violates: "R17" … "R21". */
export function kindOf(info: number): Kind | string {
  const type = matrixTypes[Math.floor(info / 10000) - 1];
  if (!type) return "R17";
  const components = Math.floor(info / 100) % 100;
  if (!allowed[type].components.includes(components)) return "R18";
  const scalar = scalars[Math.floor(info / 10) % 10]!;
  if (!allowed[type].scalars.includes(scalar)) return "R19";
  const encoding = encodings[info % 10];
  if (!encoding) return "R20";
  if (encoding === "jpeg") {
    const colours = type === "rgb_image" ? 3 : type === "intensity_image" ? 1 : 0;
    if (components !== colours || scalar !== "u8") return "R21";
  }
  return { type, components, scalar, encoding };
}
