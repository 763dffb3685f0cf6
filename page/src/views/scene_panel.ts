// SPDX-License-Identifier: Apache-2.0
import { outputsOf, type Output } from "../outputs";
import type { GraphState } from "../server";
import { button, fill, h, type PanelKind } from "../shell";
import { liveSurroundings } from "./panels";

/** Default ports of a new scene: the clouds of depth modules. */
function usualPorts(state: GraphState | undefined): string[] {
  const finders = state?.modules.filter(({ program }) => /(^|\/)depth$/.test(program)) ?? [];
  return finders.map(({ name }) => `${name}.points`);
}

let lists = 0;

/** Whether a scene can show it. */
function isSpatial({ type }: Output): boolean {
  return type === "" || /position|rotation|transformation|vector_field/.test(type);
}

/** Several streams in one scene: {kind: "scene", ports?}, ports separated by spaces. */
export const scenePanel: PanelKind = (args, host) => {
  host.setTitle("Scene");
  const element = h("div.stream-panel.stack");
  let close = () => {};
  let isClosed = false;
  const open = async () => {
    const surroundings = await liveSurroundings(host.server);
    await surroundings.ready();
    const { Scene, addStream, sceneTools } = await import("./scene");
    if (isClosed) return;
    const scene = new Scene(surroundings);
    const shown = new Map<string, () => void>();
    close = () => {
      for (const end of shown.values()) end();
      scene.close();
    };
    const list = h("div.scene-ports.wrap");
    const input = h("input", {
      "aria-label": "Stream to show in the scene",
      placeholder: "add MODULE.PORT",
      size: 18,
    });
    const names = h("datalist", { id: `outputs-${++lists}` });
    input.setAttribute("list", names.id);
    const form = h("form", [input, names]);
    void outputsOf(host.server).then((outputs) =>
      fill(
        names,
        outputs.filter(isSpatial).map(({ port }) => h("option", { value: port })),
      ),
    );
    const update = () => {
      const ports = [...shown.keys()];
      host.setArgs({ ...args, ports: ports.join(" ") });
      const buttons = ports.map((port) =>
        button(`${port} ✕`, () => remove(port), { "aria-label": `Take ${port} out` }),
      );
      fill(list, ...buttons, form);
    };
    const add = (port: string) => {
      if (!/^[\w-]+\.[\w-]+$/.test(port) || shown.has(port)) return;
      shown.set(
        port,
        addStream(scene, surroundings, port, (text) => host.say(text)),
      );
    };
    const remove = (port: string) => {
      shown.get(port)?.();
      shown.delete(port);
      update();
    };
    form.onsubmit = (event) => {
      event.preventDefault();
      add(input.value.trim());
      input.value = "";
      update();
      input.focus();
    };
    const ports = args.ports === undefined ? usualPorts(surroundings.state) : args.ports.split(" ");
    ports.forEach(add);
    update();
    host.tools.append(...sceneTools(scene));
    element.append(list, scene.element);
  };
  open().catch((error: unknown) => {
    element.append(h("p.problem", "This browser has no 3D graphics (WebGL)."));
    console.error(error);
  });
  return {
    element,
    close: () => {
      isClosed = true;
      close();
    },
  };
};
