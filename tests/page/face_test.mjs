// SPDX-License-Identifier: Apache-2.0
// A face in a photograph gets a name, from the page alone, as doc/people.md says.
import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { fileURLToPath } from "node:url";
import { Graph, openBrowser, watchdog } from "./harness.mjs";

const photograph = fileURLToPath(
  new URL("../../nets/node_modules/@vladmandic/face-api/demo/sample1.jpg", import.meta.url),
);

describe("a face before the camera", { timeout: 10 * watchdog }, () => {
  let graph, browser, page, folder;

  before(async () => {
    browser = await openBrowser();
    page = await (await browser.newContext()).newPage();
    page.setDefaultTimeout(watchdog);
    folder = mkdtempSync(join(tmpdir(), "hc-face-"));
    process.env.HC_LEFT_EYE = join(folder, "half.jpg");
    writeFileSync(process.env.HC_LEFT_EYE, await halved(photograph));
    graph = new Graph("people.toml", ["--set", "camera.rate=5"]); // it costs less
  });

  after(async () => {
    await browser?.close();
    await graph?.end();
    if (folder) rmSync(folder, { recursive: true });
  });

  /** A photograph at half its size. */
  async function halved(file) {
    const small = await page.evaluate(
      async (data) => {
        const bitmap = await createImageBitmap(await (await fetch(data)).blob());
        const canvas = document.createElement("canvas");
        canvas.width = bitmap.width / 2;
        canvas.height = bitmap.height / 2;
        canvas.getContext("2d").drawImage(bitmap, 0, 0, canvas.width, canvas.height);
        return canvas.toDataURL("image/jpeg", 0.95).split(",")[1];
      },
      `data:image/jpeg;base64,${readFileSync(file, "base64")}`,
    );
    return Buffer.from(small, "base64");
  }

  test("is named by a click, shown by that name, and forgotten with its file", async () => {
    await page.goto(await graph.url());
    await page.getByRole("link", { name: "Drive" }).click();
    await page.getByRole("button", { name: "Take the seat" }).click();
    await page.getByRole("button", { name: "Leave the seat" }).waitFor();
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
