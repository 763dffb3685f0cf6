// SPDX-License-Identifier: Apache-2.0
// Reads (R27, R28) and writes (R39) numbers as text.
import type { Scalar } from "./info";

const integer = /^(0|-?[1-9][0-9]*)$/;
const decimal = /^-?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?$/;
const special = /^(-?)(nan|inf|infinity)$/i;

/** Ranges of the integer scalars. */
const ranges: Partial<Record<Scalar, readonly [bigint, bigint]>> = {
  u8: [0n, 0xffn],
  i8: [-0x80n, 0x7fn],
  u16: [0n, 0xffffn],
  i16: [-0x8000n, 0x7fffn],
  u32: [0n, 0xffff_ffffn],
  i32: [-0x8000_0000n, 0x7fff_ffffn],
  u64: [0n, 0xffff_ffff_ffff_ffffn],
  i64: [-0x8000_0000_0000_0000n, 0x7fff_ffff_ffff_ffffn],
};

export function isInteger(text: string): boolean {
  return integer.test(text);
}

/** Parses a number; returns the rule that the text violates: "R27" or "R28". */
export function numberOf(text: string, scalar: Scalar): number | bigint | "R27" | "R28" {
  const range = ranges[scalar];
  if (range) {
    if (!integer.test(text)) return "R27";
    const value = BigInt(text);
    if (value < range[0] || value > range[1]) return "R28";
    return scalar === "u64" || scalar === "i64" ? value : Number(value);
  }
  const found = special.exec(text);
  if (found) {
    const size = found[2]!.toLowerCase() === "nan" ? NaN : Infinity;
    return found[1] ? -size : size;
  }
  if (!decimal.test(text)) return "R27";
  const value = scalar === "f32" ? single(text) : Number(text);
  return Number.isFinite(value) ? value : "R28";
}

/** The f32 nearest to a decimal number, ties to even, rounded once. */
function single(text: string): number {
  const double = Number(text);
  const rounded = Math.fround(double);
  if (rounded === double || Number.isNaN(double)) return rounded;
  // Infinity counts as the number that would follow the largest f32.
  const near = Number.isFinite(rounded) ? rounded : Math.sign(double) * 2 ** 128;
  const far = 2 * double - near;
  // If the f64 lies exactly between two f32, the text decides on the side.
  const side = Math.fround(far) === far || Math.abs(far) === 2 ** 128 ? compare(text, double) : 0;
  return side === 0 ? rounded : Math.fround(Math[side > 0 ? "max" : "min"](near, far));
}

/** Sign of (decimal number − double), exactly. */
function compare(text: string, double: number): number {
  const [, sign, digits, exponent] = /^(-?)([0-9.]+)(?:[eE](.*))?$/.exec(text)!;
  const [whole = "", fraction = ""] = digits!.split(".");
  let left = BigInt(sign + (whole + fraction || "0"));
  const tens = Number(exponent ?? 0) - fraction.length;
  // double = right × 2^twos, with a whole `right`.
  let twos = 0;
  let scaled = double;
  while (!Number.isInteger(scaled)) {
    scaled *= 2;
    twos -= 1;
  }
  let right = BigInt(scaled);
  if (tens >= 0) left *= 10n ** BigInt(tens);
  else right *= 10n ** BigInt(-tens);
  left *= 2n ** BigInt(-twos);
  return left < right ? -1 : left > right ? 1 : 0;
}

/** The text of a number in canonical form. */
export function numberText(value: number | bigint, scalar: Scalar): string {
  if (scalar !== "f32" && scalar !== "f64") return String(value);
  const number = Number(value);
  if (Number.isNaN(number)) return "nan";
  if (!Number.isFinite(number)) return number < 0 ? "-inf" : "inf";
  const sign = number < 0 || Object.is(number, -0) ? "-" : "";
  const size = Math.abs(number);
  if (size === 0) return sign + "0";
  const { digits, exponent } = scalar === "f32" ? shortest32(size) : shortest64(size);
  const mantissa = digits[0]! + (digits.length > 1 ? "." + digits.slice(1) : "");
  const power = String(Math.abs(exponent)).padStart(2, "0");
  const scientific = `${mantissa}e${exponent < 0 ? "-" : "+"}${power}`;
  const fixedLength =
    exponent < 0 ? digits.length - exponent + 1 : Math.max(exponent + 1, digits.length + 1);
  const isWhole = exponent >= digits.length - 1;
  if ((isWhole ? exponent + 1 : fixedLength) > scientific.length) return sign + scientific;
  if (isWhole) return sign + BigInt(size);
  if (exponent < 0) return `${sign}0.${"0".repeat(-exponent - 1)}${digits}`;
  return `${sign}${digits.slice(0, exponent + 1)}.${digits.slice(exponent + 1)}`;
}

/** d₁.d₂d₃… × 10^exponent */
interface Decimal {
  readonly digits: string;
  readonly exponent: number;
}

function decimalOf(scientific: string): Decimal {
  const [mantissa = "", exponent] = scientific.split("e");
  return {
    digits: mantissa.replace(".", "").replace(/0+$/, "") || "0",
    exponent: Number(exponent),
  };
}

function shortest64(size: number): Decimal {
  return decimalOf(size.toExponential());
}

/** The fewest digits that round-trip the f32; of several, the nearest. */
function shortest32(size: number): Decimal {
  for (let digits = 0; digits < 9; ++digits) {
    const nearest = size.toExponential(digits);
    if (single(nearest) === size) return decimalOf(nearest);
    // At a power of two the interval is wider above than below, where the nearest may not fit.
    const [mantissa = "", exponent] = nearest.split("e");
    const unit = BigInt(mantissa.replace(".", ""));
    for (const other of [unit + 1n, unit - 1n]) {
      const text = `${other}e${Number(exponent) - digits}`;
      if (single(text) === size) return decimalOf(Number(text).toExponential(digits));
    }
  }
  return decimalOf(size.toExponential(8));
}
