// SPDX-License-Identifier: Apache-2.0
// Numbers and conditions of modules and links as text.
import type { GraphLink, GraphModule } from "../server";

/** A rate: "20/s", "0.5/s", "1.2 k/s"; "" for 0. */
export function rateText(perSecond: number): string {
  if (perSecond <= 0) return "";
  if (perSecond >= 999.5) return `${shortNumber(perSecond / 1000)} k/s`;
  return `${perSecond < 0.1 ? perSecond.toFixed(2) : shortNumber(perSecond)}/s`;
}

/** A duration [s]: "31 ms", "85 µs", "1.2 s". */
export function durationText(seconds: number): string {
  if (seconds >= 59.95) return `${Math.floor(seconds / 60)} min ${Math.round(seconds % 60)} s`;
  if (seconds >= 0.9995) return `${shortNumber(seconds)} s`;
  if (seconds >= 0.0009995) return `${shortNumber(seconds * 1e3)} ms`;
  return `${Math.round(seconds * 1e6)} µs`;
}

/** A size [byte]: "2.9 MB". */
export function bytesText(bytes: number): string {
  if (bytes >= 999.5e6) return `${shortNumber(bytes / 1e9)} GB`;
  if (bytes >= 999.5e3) return `${shortNumber(bytes / 1e6)} MB`;
  if (bytes >= 999.5) return `${shortNumber(bytes / 1e3)} kB`;
  return `${Math.round(bytes)} B`;
}

/** Two digits, or all digits before the point. */
function shortNumber(value: number): string {
  return value >= 9.95 ? String(Math.round(value)) : String(Number(value.toPrecision(2)));
}

/** A part of one processor: "27 %". */
export function percentText(part: number): string {
  return `${Math.round(part * 100)} %`;
}

/** Texts for messages that were delayed, dropped or ignored. */
const dropWords: readonly [keyof GraphLink & string, (count: string) => string][] = [
  ["delayed", (count) => `${count} delayed by the pace of the link`],
  ["throttled", (count) => `${count} dropped by the pace of the link`],
  ["dropped_newer", (count) => `${count} dropped for a newer message`],
  ["dropped_memory", (count) => `${count} dropped for lack of memory`],
  ["dropped_disconnect", (count) => `${count} lost when the link disconnected`],
  ["dropped_timeout", (count) => `${count} dropped because the reader hung`],
  ["ignored", (count) => `${count} ignored, because another task had the focus`],
];

/** The limit of a link, and how its images are adapted to it; "" without a limit. */
export function bandwidthText({ bandwidth, images }: GraphLink): string {
  if (bandwidth <= 0) return "";
  const limit = `at most ${bytesText(bandwidth)}/s`;
  return images ? `${limit}: quality ${images[0]}, scale ${images[1]}` : limit;
}

/** Texts for a link's limit, and for its messages that did not arrive in time, by cause. */
export function limitTexts(link: GraphLink): string[] {
  const dropped = dropWords
    .filter(([key]) => Number(link[key]) > 0)
    .map(([key, text]) => text(Number(link[key]).toLocaleString("en")));
  return [bandwidthText(link), ...dropped].filter((text) => text !== "");
}

/** Messages of a link that were dropped or lost; ignored ones did reach the reader. */
export function droppedCount(link: GraphLink): number {
  return (
    link.throttled +
    link.dropped_newer +
    link.dropped_memory +
    link.dropped_disconnect +
    link.dropped_timeout
  );
}

/** Median and 99th percentile of a latency: "31 ms, at most 48 ms". */
export function latencyText(age: GraphLink["age"]): string {
  return age ? `${durationText(age[0])}, p99 ${durationText(age[1])}` : "";
}

/** An angle [°] with its sign, without digits after the point: "−3°". */
export function degreesText(angle: number): string {
  const whole = Math.round(angle);
  return `${whole < 0 ? "−" : ""}${Math.abs(whole)}°`;
}

export type Condition = "works" | "slow" | "broken" | "ended";

/** The condition of a module, and the reason, which is empty if it works. */
export function moduleCondition(module: GraphModule): { is: Condition; why: string } {
  const detail = module.detail ? `: ${module.detail}` : "";
  switch (module.status) {
    case "running":
      return module.detail ? { is: "slow", why: module.detail } : { is: "works", why: "" };
    case "starting":
      return { is: "works", why: "" };
    case "ended":
      return { is: "ended", why: "has ended" };
    case "waiting":
      return { is: "broken", why: `${exitText(module)}; will be restarted${detail}` };
    case "stalled":
      // What takes long, such as reading, is busy meanwhile.
      return module.detail === "busy"
        ? { is: "slow", why: "busy" }
        : { is: "broken", why: module.detail || "does not respond" };
    case "stopping":
      return { is: "broken", why: `is being stopped${detail}` };
    default:
      return { is: "broken", why: `has ${module.status}${detail}` };
  }
}

/** As moduleCondition(), of a link. */
export function linkCondition({ status }: GraphLink): { is: Condition; why: string } {
  if (status === "") return { is: "works", why: "" };
  if (status.endsWith(": stalled")) return { is: "slow", why: status };
  return { is: status === "ended" ? "ended" : "broken", why: status };
}

/** How the last process of a module ended; a status above 128 means a signal. */
export function exitText(module: GraphModule): string {
  if (module.exit === null) return "has ended";
  if (module.exit > 128) return `was killed by signal ${module.exit - 128}`;
  return `ended with status ${module.exit}`;
}
