// SPDX-License-Identifier: Apache-2.0
import { describe, typeText, type Description } from "./graph/describe";
import type { Server } from "./server";

export interface Output {
  /** MODULE.PORT */
  readonly port: string;
  /** Type of its messages, such as "rgb_image of 3 × u8"; empty: unknown. */
  readonly type: string;
  readonly doc: string;
}

const asked = new Map<string, Promise<Description | undefined>>();

/** The outputs of all modules, by name: described and linked ones. */
export async function outputsOf(server: Server): Promise<Output[]> {
  const { state } = server;
  const outputs = new Map<string, Output>();
  for (const { from } of state?.links ?? []) {
    if (/^[\w-]+\.[\w-]+$/.test(from)) outputs.set(from, { port: from, type: "", doc: "" });
  }
  const descriptions = (state?.modules ?? []).map(async ({ name, program }) => {
    const key = `${name} ${program}`;
    const answer = asked.get(key) ?? describe(server, name);
    asked.set(key, answer);
    const description = await answer;
    if (!description) asked.delete(key);
    for (const { name: output, types, doc } of description?.outputs ?? []) {
      const port = `${name}.${output}`;
      outputs.set(port, { port, type: types.map(typeText).join(" or "), doc: doc ?? "" });
    }
  });
  await Promise.all(descriptions);
  return [...outputs.values()].sort((a, b) => (a.port < b.port ? -1 : 1));
}
