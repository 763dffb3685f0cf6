// SPDX-License-Identifier: Apache-2.0
// The stop: always visible, one press, for viewers too. It is cleared by two other controls.
import type { Session } from "../server";
import { h, type Shell } from "../shell";

/** Two presses of Escape within this time stop the robot [ms]. */
const twice = 600;

/** Puts the stop button into the header, and a red bar above all while the robot is stopped. */
export function addStop(shell: Shell): void {
  const { server } = shell;
  const say = (error: unknown): void =>
    shell.say(error instanceof Error ? error.message : String(error));
  let pending = false; // pressed, and not answered
  const stop = async (): Promise<void> => {
    pending = true;
    try {
      await server.command("estop");
      pending = false;
    } catch (error) {
      pending = server.connection.status !== "open";
      say(
        pending
          ? "There is no connection to the server: the stop is sent when there is one."
          : error,
      );
    }
  };
  server.onConnection(({ status }) => {
    if (status === "open" && pending) void stop();
  });
  const button = h(
    "button",
    { class: "stop", title: "Stop the robot (Escape twice)", onclick: () => void stop() },
    "Stop",
  );

  const confirm = h("input", { type: "checkbox", id: "stop-confirm" });
  const clear = h(
    "button",
    {
      class: "stop-clear",
      disabled: true,
      onclick: () => void server.command("estop clear").catch(say),
    },
    "Let it move",
  );
  confirm.addEventListener("change", () => {
    clear.disabled = !confirm.checked;
  });
  const controls = h(
    "span",
    { class: "stop-controls" },
    h("label", { for: "stop-confirm" }, confirm, "nobody is in its way"),
    clear,
  );
  const note = h("span", { class: "stop-note" }, "Who may drive it can clear this.");
  const bar = h(
    "div",
    { class: "stopped-bar", role: "alert", hidden: true },
    h("strong", {}, "STOPPED"),
    h("span", {}, "The robot is stopped: no task has the focus."),
    controls,
    note,
  );
  shell.headerSlot.append(button);
  shell.element.prepend(bar);

  let last = -Infinity;
  document.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || event.repeat) return;
    if (event.timeStamp - last < twice) void stop();
    last = event.timeStamp;
  });

  server.onSession((session: Session) => {
    const stopped = session.stopped === true;
    button.disabled = session.stopped === null;
    button.textContent = stopped ? "STOPPED" : "Stop";
    button.title =
      session.stopped === null
        ? "This graph has no workspace that can be stopped."
        : "Stop the robot (Escape twice)";
    button.setAttribute("aria-pressed", String(stopped));
    if (bar.hidden === stopped) {
      bar.hidden = !stopped;
      confirm.checked = false;
      clear.disabled = true;
    }
    controls.hidden = session.right !== "drive";
    note.hidden = session.right === "drive";
  });
}
