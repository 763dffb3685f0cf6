// SPDX-License-Identifier: Apache-2.0
import { outputsBeside, outputsOf } from "../outputs";
import type { Server } from "../server";
import { h, type PanelKind } from "../shell";
import { bestEncoding } from "./picture";
import { StreamView } from "./stream_view";
import type { Surroundings } from "./view";

const encoding = bestEncoding();

/** The running graph, whose streams are live. */
export async function liveSurroundings(server: Server): Promise<Surroundings> {
  const as = await encoding;
  return {
    get state() {
      return server.state;
    },
    get session() {
      return server.session;
    },
    ready: () => server.ready(),
    open: (port) => server.stream(port, { as }),
    outputsBeside: (port) => outputsBeside(server, port),
    outputs: () => outputsOf(server),
  };
}

/** A stream: {kind: "stream", port, view?}. */
export const streamPanel: PanelKind = (args, host) => {
  const port = args.port ?? "";
  host.setTitle(port);
  const element = h("div.stream-panel.stack");
  let view: StreamView | undefined;
  let isClosed = false;
  void liveSurroundings(host.server).then((surroundings) => {
    if (isClosed) return;
    view = new StreamView(
      surroundings.open(port),
      {
        surroundings,
        say: (sentence) => host.say(sentence),
        tools: host.tools,
        chosen: (name) => host.setArgs({ ...args, view: name }),
      },
      args.view,
    );
    element.append(view.element);
  });
  return {
    element,
    close: () => {
      isClosed = true;
      view?.close();
    },
  };
};
