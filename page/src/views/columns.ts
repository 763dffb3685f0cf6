// SPDX-License-Identifier: Apache-2.0
// Names and units of the numbers of a message. Pure.
import { Coord, type Header } from "../mtp";

/** The name of a number, and its unit, which may be empty. */
export interface Column {
  readonly name: string;
  readonly unit: string;
}

/** A declared column (spec/module.md, section 2): "age [s]". */
export function columnOf(text: string): Column {
  const [, name = text, unit = ""] = /^(.*) \[(.+)\]$/.exec(text) ?? [];
  return { name, unit };
}

/** A value and its unit: "1.234 m", "12.5°". */
export function quantityText(value: number, unit: string, digits = 4): string {
  const text = String(Number(value.toPrecision(digits))).replace("-", "−");
  return unit === "°" ? `${text}°` : `${text} ${unit}`.trim();
}

/** Radians are shown in degrees. */
export function shown({ name, unit }: Column): Column & { readonly factor: number } {
  const perDegree = 180 / Math.PI;
  return unit.startsWith("rad")
    ? { name, unit: unit.replace(/^rad/, "°"), factor: perDegree }
    : { name, unit, factor: 1 };
}

const derivatives = [
  ["", ""],
  [" velocity", "/s"],
  [" acceleration", "/s²"],
] as const;

/** Columns of an element of positions or rotations, by its coordinate system (R44). */
function axesOf({ type, coord }: Header): Column[] | undefined {
  const isInPixels = coord >= Coord.left_image && coord <= Coord.right_rectified;
  const named = (names: readonly string[], base: string) =>
    derivatives.flatMap(([word, per]) =>
      names.map((name) => ({ name: name + word, unit: base + per })),
    );
  if (type === "position")
    return named(isInPixels ? ["x", "y", "size"] : ["x", "y", "z"], isInPixels ? "px" : "m");
  if (type !== "rotation") return undefined;
  return named(coord === Coord.gaze ? ["roll", "tilt", "pan"] : ["roll", "pitch", "yaw"], "rad");
}

/**
 * The columns of the numbers in a row.
 *
 * @param declared  by the output; the next numbers of a row repeat them.
 */
export function columnsOf(header: Header, declared: readonly string[]): Column[] {
  const { width, components } = header;
  const names = declared.length > 0 ? declared.map(columnOf) : axesOf(header)?.slice(0, components);
  const count = width * components;
  return Array.from({ length: count }, (_, i): Column => {
    const column = names?.[i % names.length];
    if (column) {
      const { name, unit } = column;
      return count > names.length
        ? { name: `${name} ${Math.floor(i / names.length)}`, unit }
        : { name, unit };
    }
    if (count === 1) return { name: "value", unit: "" };
    const element = String(Math.floor(i / components));
    return { name: components > 1 ? `${element}.${i % components}` : element, unit: "" };
  });
}
