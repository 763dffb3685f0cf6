// SPDX-License-Identifier: Apache-2.0
import { whyText } from "./graph/bids";
import { Standings } from "./graph/standings";
import { modeName } from "./graph/workspace";
import type { GraphState, Session } from "./server";
import { fill, h, meanings, type Shell } from "./shell";

const rate = 5; // [Hz]

/** Shows in the bar which task has the focus, and why. */
export function addWhy({ server, words }: Shell): void {
  const element = h("p.bar-why", { title: meanings.focus });
  words.append(element);
  let shown = "";
  const show = (): void => {
    const { state, session, connection } = server;
    const isKnown = state && connection.status === "open";
    const text = isKnown ? whySentences(state, session, standings) : "";
    if (text === shown) return;
    shown = text;
    const task = Object.keys(state?.modes ?? {}).find((mode) => text.startsWith(`${mode} `)) ?? "";
    fill(element, h("span", [h("b.focus", task), text.slice(task.length)]));
  };
  const standings = new Standings(server, rate, show);
  server.onState((state) => standings.follow(state));
  server.onConnection(show);
}

/** A sentence for each workspace. */
function whySentences(
  state: GraphState,
  session: Session | undefined,
  standings: Standings,
): string {
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
