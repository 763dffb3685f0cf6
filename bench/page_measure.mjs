// SPDX-License-Identifier: Apache-2.0
// What the measurements of the page share.
import { readFileSync } from "node:fs";

export const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** Prints a row of a table. */
export const row = (...cells) => console.log(`| ${cells.join(" | ")} |`);

export const quantile = (values, part) =>
  [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(part * values.length))];

/** Ticks of the processor that a process has had; 100 a second. */
export function ticks(pid) {
  const words = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
  return Number(words[11]) + Number(words[12]);
}

/** Memory of processes [MB]; what several share is counted in parts. */
export function memory(...pids) {
  const sizes = pids.map((pid) => {
    try {
      const text = readFileSync(`/proc/${pid}/smaps_rollup`, "utf8");
      return Number(text.match(/^Pss:\s+(\d+)/m)[1]);
    } catch {
      return 0; // it has ended
    }
  });
  return sizes.reduce((sum, size) => sum + size, 0) / 1000;
}

/** Has a page count in `window.drawn` the different images that it draws from now on. */
export function countDrawn(page) {
  return page.evaluate(() => {
    const draw = CanvasRenderingContext2D.prototype.drawImage;
    const seen = new WeakSet();
    window.drawn = 0;
    CanvasRenderingContext2D.prototype.drawImage = function (image, ...where) {
      const isImage = image instanceof ImageBitmap || image instanceof VideoFrame;
      if (isImage && !seen.has(image)) window.drawn += 1;
      if (isImage) seen.add(image);
      return draw.call(this, image, ...where);
    };
  });
}
