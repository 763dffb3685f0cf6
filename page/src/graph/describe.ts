// SPDX-License-Identifier: Apache-2.0
// A module's description: its ports and parameters (spec/module.md, section 2).
import type { Server } from "../server";

export interface PortType {
  readonly type: string;
  readonly components: number;
  readonly scalar: string;
  /** 0: any */
  readonly width: number;
  readonly height: number;
  readonly coord: number;
}

export interface PortDescription {
  readonly name: string;
  readonly types: readonly PortType[];
  readonly doc?: string;
  /** Of an output: names of the numbers in a row, "age [s]". */
  readonly columns?: readonly string[];
  readonly actor?: boolean;
}

export interface ParameterDescription {
  readonly name: string;
  readonly type: "bool" | "integer" | "number" | "string";
  readonly unit?: string;
  readonly doc?: string;
  readonly default?: unknown;
  readonly min?: number;
  readonly max?: number;
  readonly step?: number;
  readonly choices?: readonly string[];
  /** Changing it restarts the module. */
  readonly fixed?: boolean;
}

export interface Description {
  readonly summary?: string;
  readonly inputs: readonly PortDescription[];
  readonly outputs: readonly PortDescription[];
  readonly parameters: readonly ParameterDescription[];
}

/** Reads a module's description; undefined if it is none. */
export function parseDescription(json: string): Description | undefined {
  try {
    const read = JSON.parse(json) as Partial<Description> | null;
    const lists = [read?.inputs, read?.outputs, read?.parameters];
    return lists.every(Array.isArray) ? (read as Description) : undefined;
  } catch {
    return undefined;
  }
}

/** A module's description; undefined if it is unavailable. */
export async function describe(server: Server, module: string): Promise<Description | undefined> {
  const [json = ""] = await server.command(`describe ${module}`).catch(() => []);
  return parseDescription(json);
}

/** A type as text: "rgb_image of 3 × u8". */
export function typeText({ type, components, scalar, width, height }: PortType): string {
  const size = width || height ? `, ${width || "any"} × ${height || "any"}` : "";
  return type === "string" ? "string" : `${type} of ${components} × ${scalar}${size}`;
}
