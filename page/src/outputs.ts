// SPDX-License-Identifier: Apache-2.0
import { describe, typeText, type Description, type PortType } from "./graph/describe";
import type { Server } from "./server";

export interface Output {
  /** MODULE.PORT */
  readonly port: string;
  /** Type of its messages, such as "rgb_image of 3 × u8"; empty: unknown. */
  readonly type: string;
  /** The same; undefined: any, or unknown. */
  readonly kind?: PortType;
  readonly doc: string;
  /** Names of the numbers in a row. */
  readonly columns: readonly string[];
}

/** A module and its outputs, by name: described and linked ones. */
export interface Outlet {
  readonly name: string;
  readonly program: string;
  readonly summary: string;
  /** Whether it takes images or sound. */
  readonly perceives: boolean;
  readonly outputs: readonly Output[];
}

const asked = new Map<string, Promise<Description | undefined>>();

async function described(
  server: Server,
  { name, program }: { readonly name: string; readonly program: string },
): Promise<Description | undefined> {
  const key = `${name} ${program}`;
  const answer = asked.get(key) ?? describe(server, name);
  asked.set(key, answer);
  const description = await answer;
  if (!description) asked.delete(key);
  return description;
}

/** The outputs of a module; empty without a description. */
export function outputsIn(module: string, description: Description | undefined): Output[] {
  return (description?.outputs ?? []).map(({ name, types, doc = "", columns = [] }) => ({
    port: `${module}.${name}`,
    type: types.map(typeText).join(" or "),
    kind: types[0],
    doc,
    columns,
  }));
}

/** The modules of the graph that have outputs, by name. */
export async function outletsOf(server: Server): Promise<Outlet[]> {
  const { state } = server;
  const outlets = (state?.modules ?? []).map(async ({ name, program }): Promise<Outlet> => {
    const description = await described(server, { name, program });
    const outputs = new Map(outputsIn(name, description).map((each) => [each.port, each]));
    for (const { from: port } of state?.links ?? [])
      if (port.startsWith(`${name}.`) && !outputs.has(port))
        outputs.set(port, { port, type: "", doc: "", columns: [] });
    const taken = (description?.inputs ?? []).flatMap(({ types }) => types);
    return {
      name,
      program,
      summary: description?.summary ?? "",
      perceives: taken.some(({ type }) => /image|sound/.test(type)),
      outputs: [...outputs.values()].sort((a, b) => (a.port < b.port ? -1 : 1)),
    };
  });
  return (await Promise.all(outlets)).sort((a, b) => (a.name < b.name ? -1 : 1));
}

/** The outputs of all modules, by name. */
export async function outputsOf(server: Server): Promise<Output[]> {
  return (await outletsOf(server)).flatMap(({ outputs }) => outputs);
}

/** All outputs of the module of an output, as it describes them. */
export async function outputsBeside(server: Server, port: string): Promise<Output[]> {
  await server.ready();
  const module = server.state?.modules.find(({ name }) => port.startsWith(`${name}.`));
  return module ? outputsIn(module.name, await described(server, module)) : [];
}
