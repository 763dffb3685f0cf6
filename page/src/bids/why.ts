// SPDX-License-Identifier: Apache-2.0
import { modeName, type GraphState, type Server } from "../server";
import { fill, h, meanings, type Shell } from "../shell";
import { whyText } from "./bids";

/** Shows in the bar which task has the focus, and why. */
export function addWhy({ server, words }: Shell): void {
  const element = h("p.bar-why", { title: meanings.focus });
  words.append(element);
  let shown = "";
  const show = (): void => {
    const { state, connection } = server;
    const text = state && connection.status === "open" ? whySentences(state, server) : "";
    if (text === shown) return;
    shown = text;
    const task = Object.keys(state?.modes ?? {}).find((mode) => text.startsWith(`${mode} `)) ?? "";
    fill(element, h("span", [h("b.focus", task), text.slice(task.length)]));
  };
  server.standings.on(show);
  server.onConnection(show);
}

/** A sentence for each workspace. */
function whySentences(state: GraphState, { session, standings }: Server): string {
  const sentences = Object.keys(state.focus).map((name) => {
    const parameters = state.modules.find((module) => module.name === name)?.parameters;
    const rules = {
      margin: Number(parameters?.margin ?? 0),
      dwell: Number(parameters?.dwell ?? 0),
      stopped: session?.stopped === true,
    };
    return whyText(standings.of(name), rules, (mode) => modeName(state, mode));
  });
  return sentences.join(" ");
}
