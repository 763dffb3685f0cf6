// SPDX-License-Identifier: Apache-2.0
// Pictures of the page on the simulated head: node page_pictures.mjs FOLDER. Each view as PNG on a
// phone, a laptop and a large screen, light and dark; the seat is taken where it is driven.
import { join } from "node:path";
import { Graph, openBrowser, watchdog } from "../tests/page/harness.mjs";

const folder = process.argv[2];
if (!folder) throw new Error("usage: node page_pictures.mjs FOLDER");
const sizes = [
  [360, 640],
  [640, 360],
  [1280, 800],
  [3840, 2160],
];

const graph = new Graph("head.toml", ["--quiet"], "head");
const browser = await openBrowser({ webgl: false });
try {
  const context = await browser.newContext();
  context.setDefaultTimeout(watchdog);
  const page = await context.newPage();
  await page.goto(await graph.url());
  const origin = new URL(page.url()).origin;
  for (const view of ["drive", "watch", "build"]) {
    for (const [width, height] of sizes) {
      await page.setViewportSize({ width, height });
      await page.goto("about:blank");
      await page.goto(`${origin}/#${view}`);
      if (view === "drive") {
        await page.getByRole("button", { name: "Take the seat" }).click();
        await page.locator(".seat-problem:empty").waitFor({ state: "attached" });
      }
      await page.locator(".waiting").first().waitFor({ state: "detached" });
      await page.locator(".bar .focus:not(:empty)").waitFor();
      for (const colorScheme of ["light", "dark"]) {
        await page.emulateMedia({ colorScheme });
        await page.screenshot({ path: join(folder, `${view}-${width}-${colorScheme}.png`) });
      }
    }
  }
} finally {
  await browser.close();
  await graph.end();
}
