// SPDX-License-Identifier: Apache-2.0
import type { GraphModule, GraphState } from "../server";
import { exitText, moduleCondition, type Condition } from "./words";

/** How long a failure is shown after the restart of its module [s]. */
const shown = 3;

/** Remembers failures for a while; otherwise quickly restarted modules never seem to fail. */
export class Failures {
  private readonly restarts = new Map<string, number>();
  private readonly failed = new Map<string, number>();
  private uptime = 0;

  take(state: GraphState): void {
    this.uptime = state.uptime;
    for (const { name, restarts, exit } of state.modules) {
      const before = this.restarts.get(name) ?? restarts;
      if (restarts > before && exit !== 0) this.failed.set(name, state.uptime);
      this.restarts.set(name, restarts);
    }
  }

  /** As moduleCondition(), but broken for a while after a failure. */
  conditionOf(module: GraphModule): { is: Condition; why: string } {
    const now = moduleCondition(module);
    const failed = this.failed.get(module.name);
    if (now.is === "broken" || failed === undefined || this.uptime - failed > shown) return now;
    return { is: "broken", why: `${exitText(module)}; was restarted` };
  }
}
