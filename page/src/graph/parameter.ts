// SPDX-License-Identifier: Apache-2.0
// A control for a module's parameter.
import { mayOperate, type Server } from "../server";
import { h } from "../shell";
import type { ParameterDescription } from "./describe";

type Control = HTMLInputElement | HTMLSelectElement;

/** Larger ranges get no slider. */
const widestSlider = 1000;

export class ParameterView {
  readonly element: HTMLElement;
  private readonly control: Control;
  private readonly slider?: HTMLInputElement;
  private readonly problem = h("p.problem", { role: "alert" });
  /** As last reported by the module. */
  private value = "";

  /** @param is  its description, or only its name. */
  constructor(
    private readonly server: Server,
    private readonly module: string,
    private readonly is: ParameterDescription,
  ) {
    const id = `parameter-${module}-${is.name}`;
    const note = `${id}-note`;
    const isLocked = is.fixed === true || !mayOperate(server.session);
    const common = { id, "aria-describedby": note, disabled: isLocked };
    this.control = this.makeControl(common);
    this.control.addEventListener("change", () => void this.send(this.text()));
    const { min = -Infinity, max = Infinity } = is;
    const number = is.type === "number" || is.type === "integer";
    if (number && !isLocked && max - min <= widestSlider) {
      const slider = this.numberInput("range", { "aria-label": `${is.name}, slider` });
      slider.addEventListener("change", () => void this.send(slider.value));
      slider.addEventListener("input", () => (this.control.value = shortest(slider.value)));
      this.slider = slider;
    }
    const unit = is.unit ? h("span.unit.muted.small", is.unit) : null;
    this.element = h("div.parameter", { "data-parameter": is.name }, [
      h("label", { for: id }, is.name),
      h("div.control.row", [this.control, unit, this.slider]),
      h("p.note.muted.small", { id: note }, noteText(is)),
      this.problem,
    ]);
  }

  /** Shows the module's value, unless a person is changing it. */
  update(value: string): void {
    if (value === this.value) return;
    this.value = value;
    if (document.activeElement === this.control || document.activeElement === this.slider) return;
    this.show(value);
  }

  private makeControl(common: Record<string, unknown>): Control {
    const { is } = this;
    if (is.choices && is.choices.length > 0) {
      return h(
        "select",
        common,
        is.choices.map((choice) => h("option", { value: choice }, choice)),
      );
    }
    if (is.type === "bool") return h("input", { ...common, type: "checkbox" });
    if (is.type === "string") return h("input", { ...common, type: "text", spellcheck: "false" });
    return this.numberInput("number", common);
  }

  private numberInput(type: "number" | "range", others: Record<string, unknown>): HTMLInputElement {
    const { min, max, step = this.is.type === "integer" ? 1 : "any" } = this.is;
    return h("input", { ...others, type, min, max, step });
  }

  private text(): string {
    if (this.is.type === "bool") return String((this.control as HTMLInputElement).checked);
    return this.control.value;
  }

  private show(value: string): void {
    if (this.is.type === "bool") (this.control as HTMLInputElement).checked = value === "true";
    else this.control.value = this.is.type === "string" ? value : shortest(value);
    if (this.is.type === "string") this.control.title = value; // it may be longer than the field
    if (this.slider) this.slider.value = value;
  }

  private async send(value: string): Promise<void> {
    try {
      await this.server.command(`set ${this.module}.${this.is.name}=${value}`);
      this.value = value;
      this.show(value);
      this.problem.textContent = "";
    } catch (error) {
      this.problem.textContent = error instanceof Error ? error.message : String(error);
      this.show(this.value);
    }
  }
}

/** A number without artefacts of binary fractions: 0.05 for 0.050000000000000003. */
function shortest(text: string): string {
  const number = Number(text);
  return text !== "" && Number.isFinite(number) ? String(number) : text;
}

function noteText({ doc, min, max, default: usual, fixed }: ParameterDescription): string {
  const range =
    min !== undefined && max !== undefined
      ? `${min} … ${max}`
      : min !== undefined
        ? `at least ${min}`
        : max !== undefined
          ? `at most ${max}`
          : "";
  const notes = [
    doc ?? "",
    range,
    usual !== undefined && usual !== "" ? `default ${String(usual)}` : "",
    fixed ? "fixed: hc graph set restarts the module with another" : "",
  ];
  return notes.filter((note) => note !== "").join("; ");
}
