// SPDX-License-Identifier: Apache-2.0
// A face in a photograph gets a name, from the page alone, as doc/people.md says.
import assert from "node:assert/strict";
import { existsSync, rmSync } from "node:fs";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { fileURLToPath } from "node:url";
import { Graph, openBrowser, watchdog } from "./harness.mjs";

const photograph = fileURLToPath(
  new URL("../../nets/node_modules/@vladmandic/face-api/demo/sample1.jpg", import.meta.url),
);

describe("a face before the camera", { timeout: 10 * watchdog }, () => {
  let graph, browser, page;

  before(async () => {
    process.env.HC_LEFT_EYE = photograph;
    graph = new Graph("people.toml");
    browser = await openBrowser();
    page = await (await browser.newContext()).newPage();
    page.setDefaultTimeout(watchdog);
  });

  after(async () => {
    await browser?.close();
    await graph?.end();
  });

  test("is named by a click, shown by that name, and forgotten with its file", async () => {
    await page.goto(await graph.url());
    await page.getByRole("link", { name: "Drive" }).click();
    await page.getByRole("button", { name: "Take the seat" }).click();
    const face = page.locator(".seen-person").first();
    await face.waitFor({ state: "attached" });
    const track = await face.getAttribute("data-track");
    const box = await page
      .locator(`.seen-person[data-track="${track}"] .seen-lines.ink`)
      .boundingBox();
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
    const name = page.getByLabel("Name:");
    await name.fill("Ann");
    await name.press("Enter");
    const label = page.locator(`.seen-person[data-track="${track}"] text`);
    await label.filter({ hasText: /^Ann/ }).waitFor();
    const file = join(graph.folder, "people/Ann");
    assert.ok(existsSync(file));
    rmSync(file);
    await label.filter({ hasNotText: "Ann" }).waitFor();
  });
});
