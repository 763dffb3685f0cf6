// SPDX-License-Identifier: Apache-2.0
import {
  mayOperate,
  moduleOf,
  portOf,
  type GraphLink,
  type GraphModule,
  type GraphState,
  type LogLine,
} from "../server";
import { button, fill, h, setText, type PanelHost, type PanelKind } from "../shell";
import { describe, typeText, type Description, type PortDescription } from "./describe";
import { Failures } from "./failures";
import { ParameterView } from "./parameter";
import { linksOf } from "./structure";
import { bytesText, latencyText, percentText, rateText } from "./words";

/** Maximum lines of the log. */
const logLines = 200;

/** A module's ports, parameters and log: {kind: "module", name}. */
export const modulePanel: PanelKind = (args, host) => {
  host.setTitle(args.name || "module");
  return new ModuleView(host, args.name ?? "");
};

class ModuleView {
  private readonly status = h("p.module-status", { role: "status" });
  private readonly summary = h("p.summary");
  private readonly facts = h("dl.facts.wrap");
  private readonly ports = h("div.ports");
  private readonly parameters = h("div.parameters");
  private readonly log = h("pre.log", {
    tabindex: 0,
    role: "log",
    "aria-label": "Log of the module",
  });
  private readonly restart = button("Restart", () => void this.askRestart());
  readonly element: HTMLElement;
  private description?: Description;
  private parameterViews?: Map<string, ParameterView>;
  /** Whether the description has arrived, or there is none: a control is not replaced in use. */
  private isDescribed = false;
  private readonly failures = new Failures();
  private portsKey = "";
  private readonly ends: (() => void)[] = [];

  constructor(
    private readonly host: PanelHost,
    private readonly name: string,
  ) {
    host.tools.append(this.restart);
    this.element = h("div.module", [
      this.status,
      this.summary,
      this.facts,
      h("h3", "Parameters"),
      this.parameters,
      h("h3", "Ports"),
      this.ports,
      h("h3", "Log"),
      this.log,
    ]);
    const { server } = host;
    this.ends.push(
      // After connecting, the server sends the last lines of the log again.
      server.onConnection(({ status }) => status === "open" && this.log.replaceChildren()),
      server.onLog((line) => this.addLine(line)),
      server.onState((state) => this.update(state)),
      server.onSession((session) => {
        this.restart.disabled = !mayOperate(session);
      }),
      server.onConnection(({ status }) => status === "open" && void this.askDescription()),
    );
    for (const line of server.log) this.addLine(line);
  }

  private async askDescription(): Promise<void> {
    const { server } = this.host;
    const description = await describe(server, this.name);
    if (this.description || (!description && this.isDescribed)) return;
    this.isDescribed = true;
    this.description = description;
    this.summary.textContent = description?.summary ?? "";
    this.parameterViews = undefined;
    this.portsKey = "";
    if (server.state) this.update(server.state);
  }

  close(): void {
    for (const end of this.ends) end();
  }

  private update(state: GraphState): void {
    const module = state.modules.find((each) => each.name === this.name);
    if (!module) {
      this.status.textContent = `The graph has no module ${this.name}.`;
      this.status.className = "module-status broken";
      return;
    }
    this.failures.take(state);
    const { is, why } = this.failures.conditionOf(module);
    setText(this.status, is === "ended" ? why : why ? `${module.status}: ${why}` : module.status);
    this.status.className = `module-status ${is}`;
    this.updateFacts(module);
    this.updateParameters(module);
    this.updatePorts(linksOf(state, module));
  }

  private updateFacts(module: GraphModule): void {
    const facts: [string, string][] = [
      ["program", module.program.split("/").at(-1) ?? ""],
      ["process", module.pid ? String(module.pid) : "none"],
      ["cpu", percentText(module.cpu)],
      ["memory", bytesText(module.memory)],
      ["restarts", String(module.restarts)],
      ["task", module.mode || "none"],
      ["group", module.group || "none"],
    ];
    fill(
      this.facts,
      facts.map(([title, value]) => h("div", [h("dt", title), h("dd", value)])),
    );
  }

  private updateParameters(module: GraphModule): void {
    if (!this.isDescribed) return;
    if (!this.parameterViews) {
      const described = this.description?.parameters ?? [];
      const known = new Map(described.map((each) => [each.name, each]));
      const names = new Set([...known.keys(), ...Object.keys(module.parameters)]);
      this.parameterViews = new Map(
        [...names].map((name) => {
          const is = known.get(name) ?? { name, type: "string" as const };
          return [name, new ParameterView(this.host.server, this.name, is)];
        }),
      );
      const views = [...this.parameterViews.values()].map((view) => view.element);
      fill(this.parameters, views.length > 0 ? views : h("p", "None."));
    }
    for (const [name, view] of this.parameterViews) {
      const usual = this.description?.parameters.find((each) => each.name === name)?.default;
      view.update(module.parameters[name] ?? String(usual ?? ""));
    }
  }

  private updatePorts(links: readonly GraphLink[]): void {
    const inputs = this.portsOf("inputs", links);
    const outputs = this.portsOf("outputs", links);
    const key = JSON.stringify([inputs, outputs, links.map((link) => [link.from, link.to])]);
    if (key !== this.portsKey) {
      this.portsKey = key;
      fill(
        this.ports,
        inputs.map((port) => this.drawPort(port, "in")),
        outputs.map((port) => this.drawPort(port, "out")),
      );
    }
    for (const link of links) {
      const selector = `[data-link="${CSS.escape(`${link.from} ${link.to}`)}"]`;
      const element = this.ports.querySelector(selector);
      const facts = [
        link.status,
        rateText(link.per_second) || "no messages",
        latencyText(link.age),
      ];
      const text = facts.filter((fact) => fact !== "").join("; ");
      if (element) setText(element, text);
    }
  }

  /** Ports of the description; without one, the linked ports. */
  private portsOf(side: "inputs" | "outputs", links: readonly GraphLink[]): PortDescription[] {
    const described = this.description?.[side] ?? [];
    const ends = links.map((link) => (side === "inputs" ? link.to : link.from));
    const linked = ends.filter((end) => moduleOf(end) === this.name).map(portOf);
    const names = new Set([...described.map((port) => port.name), ...linked]);
    return [...names].map(
      (name) => described.find((port) => port.name === name) ?? { name, types: [] },
    );
  }

  private drawPort(port: PortDescription, way: "in" | "out"): HTMLElement {
    const full = `${this.name}.${port.name}`;
    const all = this.host.server.state?.links ?? [];
    const links = all.filter((link) => (way === "in" ? link.to : link.from) === full);
    const types = port.types.map(typeText).join(", or ");
    const show = () => this.host.openPanel({ kind: "stream", port: full });
    const disabled = way === "in" && links.length === 0;
    const open = button(port.name, show, { title: `Show ${full}`, disabled });
    return h("div.port", [
      h("span.way", way === "in" ? "in" : "out"),
      open,
      h("span.port-doc.muted.small", [types, port.doc].filter(Boolean).join("; ")),
      links.map((link) =>
        h("p.port-link", [
          way === "in" ? `from ${link.from}: ` : `to ${link.to}: `,
          h("span", { "data-link": `${link.from} ${link.to}` }),
        ]),
      ),
    ]);
  }

  /** Adds a line of this module's log. */
  private addLine(line: LogLine): void {
    if (line.module !== this.name) return;
    const atEnd = this.log.scrollTop + this.log.clientHeight >= this.log.scrollHeight - 4;
    this.log.append(`${line.level === "error" ? "error: " : ""}${line.text}\n`);
    while (this.log.childNodes.length > logLines) this.log.firstChild?.remove();
    if (atEnd) this.log.scrollTop = this.log.scrollHeight;
  }

  private async askRestart(): Promise<void> {
    try {
      await this.host.server.command(`restart ${this.name}`);
      this.host.say(`${this.name} is being restarted.`);
    } catch (error) {
      this.host.say(error instanceof Error ? error.message : String(error));
    }
  }
}
