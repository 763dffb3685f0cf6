// SPDX-License-Identifier: Apache-2.0
import type { Header } from "../mtp";
import type { Source } from "./view";

const step = 64; // [px], so that small changes of a panel do not change the stream

/**
 * Asks a source for no more width than an element shows, in pixels of the screen, now and when the
 * element changes its size.
 *
 * @param sent  header of what is shown.
 * @returns  ends it.
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

/** Whether an element is on the screen of a page that is seen. */
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

  /** Settled when the element is seen. */
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
