// SPDX-License-Identifier: Apache-2.0
// The stop: always visible, one press, also for viewers. Clearing it takes two other controls.
import { CommandError, mayDrive, type Session } from "../server";
import { button, h, meanings, setText, type Shell } from "../shell";
import { patience, Stopping } from "./stopping";
import { stoppedBy } from "./who";

/** Two presses of Escape within this time stop the robot [ms]. */
const twice = 600;
/** Period at which an unconfirmed stop is sent again, over a new connection if necessary [ms]. */
const period = 200;

/**
 * Adds the stop to the bar, the words that the robot is stopped, and a large warning over everything
 * while a stop is not confirmed. They do not move other elements.
 */
export function addStop(shell: Shell): void {
  const { server } = shell;
  const stopping = new Stopping();
  let isAsked = false; // a stop was sent, but not answered

  const order = async (stops: boolean): Promise<void> => {
    if (stops) isAsked = true;
    try {
      await server.command(stops ? "estop" : "estop clear");
      stopping.answered(stops, "");
    } catch (error) {
      // Without a connection the state is unknown, and the page's own text says so.
      const isAnswer = error instanceof CommandError && server.connection.status === "open";
      if (!stops) shell.say(error instanceof Error ? error.message : String(error));
      else if (isAnswer) stopping.answered(true, error.message);
    }
    if (stops) isAsked = false;
    else stopping.forgetClear();
    show();
  };
  const stop = (): void => {
    stopping.press(true, performance.now());
    void order(true);
    show();
    setTimeout(show, patience + 10); // a timer may be early
  };
  const look = (): void => {
    const isOpen = server.connection.status === "open";
    if (stopping.isUnconfirmed && isOpen && !isAsked) void order(true);
    show();
  };
  setInterval(() => {
    const { connection } = server;
    const mayReturn = connection.status === "lost" && connection.retry !== null;
    if (stopping.isUnconfirmed && mayReturn) server.reconnect();
    look();
  }, period);

  const stopButton = button("Stop", stop, {
    class: "stop",
    title: `Stop the robot (Escape twice). ${meanings.stop}`,
  });
  const { bar, showBar, showSources } = stoppedBar(() => {
    stopping.press(false, performance.now());
    void order(false);
  });
  const why = h("p.not-stopped-why");
  const alarm = h("div.not-stopped", { role: "alert", hidden: true }, [
    h("strong", "NOT STOPPED"),
    why,
    h("p", "If the robot moves, switch it off at the robot."),
  ]);
  shell.stopSlot.append(stopButton);
  shell.words.append(bar);
  shell.stage.append(alarm);

  const show = (): void => {
    const { connection } = server;
    const hasEnded = connection.status === "lost" && connection.ended;
    const alarmed = stopping.alarm(performance.now());
    const text = alarmed && hasEnded ? endedWords : alarmed;
    alarm.hidden = text === "";
    if (text !== "") setText(why, text);
  };
  let last = -Infinity;
  document.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || event.repeat) return;
    if (event.timeStamp - last < twice) stop();
    last = event.timeStamp;
  });
  server.onState((state) => showSources(stoppedBy(state)));
  server.onConnection(({ status }) => {
    stopping.connected(status === "open");
    look();
  });
  server.onSession((session: Session) => {
    stopping.heard(session.stopped);
    const stopped = session.stopped === true;
    setText(stopButton, stopped ? "Stopped" : "Stop");
    stopButton.setAttribute("aria-pressed", String(stopped));
    showBar(stopped, mayDrive(session));
    show();
  });
}

const endedWords = "The graph has ended: no program takes the stop.";

/** The words in the bar while the robot is stopped. @param clear  lets the robot move. */
function stoppedBar(clear: () => void) {
  const confirm = h("input", { type: "checkbox", id: "stop-confirm" });
  const clearButton = button("Let it move", clear, {
    class: "stop-clear",
    title: "Lets the robot move, after you have ticked that its way is clear.",
    disabled: true,
  });
  confirm.onchange = () => (clearButton.disabled = !confirm.checked);
  const controls = h("span.stop-controls.row", [
    h("label.row", { for: "stop-confirm" }, [confirm, "the robot's way is clear"]),
    clearButton,
  ]);
  const note = h("span.stop-note", "Clearing this stop needs the right to drive.");
  const words = h("span.stopped-words");
  const bar = h("div.stopped-bar.row", { role: "alert", hidden: true }, [
    h("strong", "STOPPED"),
    words,
    controls,
    note,
  ]);
  const showBar = (stopped: boolean, mayClear: boolean): void => {
    if (bar.hidden === stopped) {
      bar.hidden = !stopped;
      confirm.checked = false;
      clearButton.disabled = true;
    }
    controls.hidden = !mayClear;
    note.hidden = mayClear;
  };
  const showSources = (sources: string): void =>
    setText(words, `${sources ? `${sources}. ` : ""}No task has the focus.`);
  showSources("");
  return { bar, showBar, showSources };
}
