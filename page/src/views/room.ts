// SPDX-License-Identifier: Apache-2.0
import type { Header } from "../mtp";
import type { Source } from "./view";

const step = 64; // [px], so that small changes of a panel do not restart the stream

/**
 * Requests at most the width of an element in screen pixels from a source, now and when the
 * element's size changes.
 *
 * @param sent  original header of the shown messages.
 * @returns  a function that ends this.
 */
export function askForWidth(
  element: HTMLElement,
  source: Source,
  sent: () => Header | undefined,
): () => void {
  let timer: number | undefined;
  const ask = () => {
    const header = sent();
    const ratio = header && header.height > 0 ? header.width / header.height : 4 / 3;
    const shown = Math.min(element.clientWidth, element.clientHeight * ratio) * devicePixelRatio;
    if (shown > 0) source.setWidth(Math.max(step, Math.ceil(shown / step) * step));
  };
  const observer = new ResizeObserver(() => {
    clearTimeout(timer);
    timer = window.setTimeout(ask, 200);
  });
  observer.observe(element);
  return () => {
    clearTimeout(timer);
    observer.disconnect();
  };
}

/** Whether an element is visible. */
export class Sight {
  private isInside = true;
  private readonly observer: IntersectionObserver;
  private waiting: (() => void)[] = [];
  private readonly update = () => {
    if (!this.isSeen) return;
    for (const each of this.waiting.splice(0)) each();
  };

  constructor(element: Element) {
    this.observer = new IntersectionObserver((entries) => {
      this.isInside = entries.at(-1)?.isIntersecting ?? true;
      this.update();
    });
    this.observer.observe(element);
    document.addEventListener("visibilitychange", this.update);
  }

  get isSeen(): boolean {
    return this.isInside && document.visibilityState === "visible";
  }

  /** Settled when the element is visible. */
  seen(): Promise<void> {
    if (this.isSeen) return Promise.resolve();
    return new Promise((resolve) => this.waiting.push(resolve));
  }

  close(): void {
    this.observer.disconnect();
    document.removeEventListener("visibilitychange", this.update);
    for (const each of this.waiting.splice(0)) each();
  }
}
