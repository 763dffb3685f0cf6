// SPDX-License-Identifier: Apache-2.0
import { outletsOf, type Outlet } from "../outputs";
import type { Server } from "../server";
import { found, streamTypes, wordFor, type Choice, type Group } from "./choices";
import { button, dialogBox, fill, h } from "./h";
import { help } from "./help";
import type { PanelArgs } from "./panel";

/** Panels for any graph; filled by src/page.ts. */
export const standardPanels: Choice[] = [];

function groupsOf(outlets: readonly Outlet[]): Group[] {
  const panels = { name: "Panels", summary: "", choices: standardPanels };
  const modules = outlets.map(({ name, summary, outputs }): Group => {
    const streams = outputs.map(({ port, type, doc }): Choice => ({
      label: port,
      detail: doc,
      type,
      args: { kind: "stream", port },
    }));
    const module: Choice = {
      label: name,
      detail: "the module itself: state, parameters, log",
      args: { kind: "module", name },
    };
    return { name, summary, choices: [...streams, module] };
  });
  return [panels, ...modules];
}

/** The dialog that opens panels. */
export function opener(server: Server, open: (args: PanelArgs) => void): HTMLDialogElement {
  let groups: readonly Group[] = groupsOf([]);
  let type = "";
  const list = h("div.choices");
  const choose = (args: PanelArgs) => {
    dialog.close();
    open(args);
  };
  const item = ({ label, detail, type = "", args }: Choice) =>
    h(
      "li",
      button(
        [
          h("span.choice-name", label),
          type && h("span.choice-type.muted.small", { title: type }, wordFor(type)),
          h("span.muted.choice-detail", detail),
        ],
        () => choose(args),
      ),
    );
  const section = ({ name, summary, choices }: Group, isOpen: boolean) =>
    h("details.choice-group", { open: isOpen }, [
      h("summary", [
        h("span.choice-name", name),
        h("span.muted.choice-detail", summary),
        h("span.muted.small", String(choices.length)),
      ]),
      h("ul", choices.map(item)),
    ]);
  const show = () => {
    const typed = search.value.trim();
    const shown = found(groups, typed, type);
    if (shown.length === 0 && /^[\w-]+\.[\w-]+$/.test(typed)) {
      const args = { kind: "stream", port: typed };
      shown.push({ name: "Stream", summary: "", choices: [{ label: typed, detail: "", args }] });
    }
    const isAll = typed === "" && type === "";
    fill(
      list,
      shown.map((group) => section(group, !isAll || group.name === "Panels")),
      shown.length === 0 && h("p.muted", "No match."),
    );
    list.scrollTop = 0;
  };
  const targets = () => [...list.querySelectorAll<HTMLElement>("summary, details[open] button")];
  const search = h("input", {
    type: "search",
    autofocus: true,
    "aria-label": "Panel, stream or module",
    placeholder: "Search: a name, or words such as depth, ball, pose",
    oninput: show,
    onkeydown: (event) => {
      if (event.key === "Enter") list.querySelector<HTMLElement>("details[open] button")?.click();
      else if (event.key === "ArrowDown") targets()[0]?.focus();
      else return;
      event.preventDefault();
    },
  });
  const chooseType = (name: string) => {
    type = name;
    for (const each of types.children)
      each.setAttribute("aria-pressed", String(each.textContent === type));
    show();
  };
  const types = h(
    "div.choice-types.wrap",
    { role: "group", "aria-label": "Only streams of a type" },
    Object.keys(streamTypes).map((name) =>
      button(name, () => chooseType(type === name ? "" : name), { "aria-pressed": "false" }),
    ),
  );
  list.addEventListener("keydown", (event) => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    const all = targets();
    (all[all.indexOf(document.activeElement as HTMLElement) + step] ?? search).focus();
  });
  const dialog = dialogBox(
    "opener",
    "Open a panel",
    h("div.opener-body.stack", [
      h("p.opener-hint.small", [
        "Open a panel, or a module of the robot and one of its streams",
        help(
          "a stream",
          "A stream is what a module sends by one of its outputs: images, poses, numbers, text. " +
            "It is named MODULE.OUTPUT.",
        ),
      ]),
      search,
      types,
      list,
    ]),
  );
  dialog.addEventListener("toggle", () => {
    if (!dialog.open) return;
    show();
    void outletsOf(server).then((outlets) => {
      groups = groupsOf(outlets);
      if (dialog.open && !list.contains(document.activeElement)) show();
    });
  });
  return dialog;
}
