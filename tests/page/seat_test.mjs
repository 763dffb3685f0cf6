// SPDX-License-Identifier: Apache-2.0
// The driver's seat in a browser, on the running head.
import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";
import { until, watchdog } from "./harness.mjs";
import {
  context,
  endHead,
  gaze,
  graph,
  inFocus,
  origin,
  page,
  show,
  startHead,
  takeSeat,
  turned,
  untilDone,
} from "./running_head.mjs";

/** Of the left and the right half of the window, how much is not black, and how much is coloured. */
async function halvesSeen() {
  const picture = (await page.screenshot()).toString("base64");
  return page.evaluate(async (picture) => {
    const bytes = Uint8Array.from(atob(picture), (letter) => letter.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes]));
    const [width, height] = [bitmap.width / 2, bitmap.height];
    const context = new OffscreenCanvas(2 * width, height).getContext("2d");
    context.drawImage(bitmap, 0, 0);
    return [0, width].map((x) => {
      const { data } = context.getImageData(x, 0, width, height);
      let [drawn, coloured] = [0, 0];
      for (let i = 0; i < data.length; i += 4) {
        const all = [data[i], data[i + 1], data[i + 2]];
        const [most, least] = [Math.max(...all), Math.min(...all)];
        if (most > 40) ++drawn;
        if (most > 40 && most - least > most / 2) ++coloured;
      }
      return { drawn: (4 * drawn) / data.length, coloured: (4 * coloured) / data.length };
    });
  }, picture);
}

describe("the seat", { timeout: 10 * watchdog }, () => {
  before(startHead);
  after(endHead);

  test("a pad that is dragged turns the head, and the page names the task", async () => {
    await takeSeat();
    const pad = await page.locator(".pad").boundingBox();
    const [x, y] = [pad.x + pad.width / 2, pad.y + pad.height / 2];
    const { pan } = await gaze();
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x - 60, y, { steps: 4 });
    await turned("pan", 1, pan);
    await inFocus("point");
    await page.mouse.up();
  });

  test("arrow keys turn the head", async () => {
    await takeSeat();
    await page.locator(".seat").focus();
    const { pan } = await gaze();
    await page.keyboard.down("ArrowRight");
    await turned("pan", -1, pan);
    await page.keyboard.up("ArrowRight");
  });

  test("a gamepad turns the head", async () => {
    await takeSeat();
    const { tilt } = await gaze();
    const push = (down) =>
      page.evaluate((down) => {
        const pad = { axes: [0.05, down, 0, 0], buttons: [], connected: true };
        navigator.getGamepads = () => [null, pad];
      }, down);
    await push(tilt > 0 ? -0.8 : 0.8);
    await turned("tilt", tilt > 0 ? -1 : 1, tilt);
    await push(0);
  });

  test("the seat says that it waits until the first image has come", async () => {
    const other = await context.newPage();
    const images = [];
    await other.routeWebSocket(/streams\/head_eyes\.left/, (socket) => {
      const server = socket.connectToServer();
      server.onMessage((message) => images.push(() => socket.send(message)));
    });
    await other.goto(`${origin}/#seat`);
    await until("an image comes", () => images.length > 0);
    const says = await other.locator(".seat-problem").textContent();
    assert.equal(says, "Waiting for the first image…");
    for (const send of images) send();
    await other.locator(".seat-problem:empty").waitFor({ state: "attached" });
    await other.close();
  });

  test("an old image is marked, with the module that sends no more", async () => {
    await page.locator(".seat-view:not([data-old])").waitFor();
    const eyes = graph.pid("head_eyes");
    process.kill(eyes, "SIGSTOP");
    try {
      const says =
        /^The last image is \d+ s old\. Module head_eyes: stalled \(stopped by a signal\)\.$/;
      await page.locator(".seat-view[data-old] .seat-problem", { hasText: says }).waitFor();
    } finally {
      process.kill(eyes, "SIGCONT");
    }
    await page
      .locator(".seat-view:not([data-old]) .seat-problem:empty")
      .waitFor({ state: "attached" });
  });

  test("the head looks at a pixel that is pointed at", async () => {
    await takeSeat();
    const image = await page.locator(".seat-image").boundingBox();
    await page.waitForFunction(() => {
      const canvas = document.querySelector(".seat-image");
      const { width, height } = canvas;
      return canvas.getContext("2d").getImageData(width / 2, height / 2, 1, 1).data[3] > 0;
    });
    const { pan } = await gaze();
    const aside = Math.sign(pan || 1) * 0.3 * Math.min(image.width, (image.height * 4) / 3);
    const [x, y] = [image.x + image.width / 2 + aside, image.y + image.height / 2];
    await untilDone(
      "the head looks there",
      () => page.mouse.click(x, y),
      (timeout) => turned("pan", -Math.sign(aside), pan, timeout),
      (timeout) => inFocus("point", timeout),
    );
  });

  test("a phone that is turned turns the head", async () => {
    await takeSeat();
    const phone = await context.newCDPSession(page);
    const turn = (alpha, beta) =>
      phone.send("DeviceOrientation.setDeviceOrientationOverride", { alpha, beta, gamma: 0 });
    await turn(0, 90);
    await page.getByRole("button", { name: "Turn with this phone" }).click();
    await inFocus("telepresence");
    await page.waitForFunction(() => Math.abs(window.gaze.pan) < 0.05);
    const isThere = () =>
      Math.abs(window.gaze.pan - 0.349) < 0.05 && Math.abs(window.gaze.tilt - 0.175) < 0.05;
    await untilDone(
      "the head has turned",
      async () => {
        await turn(10, 85); // an orientation like the last one is no event
        await turn(20, 80);
      },
      (timeout) => page.waitForFunction(isThere, null, { timeout }),
    );
    await phone.send("DeviceOrientation.clearDeviceOrientationOverride");
    await phone.detach();
  });

  test("a headset that is turned turns the head", async () => {
    await page.setViewportSize({ width: 480, height: 400 }); // drawn without a graphics card
    await takeSeat();
    await page.getByRole("button", { name: "Enter the headset" }).click();
    await page.getByRole("button", { name: "Leave the headset" }).waitFor();
    await inFocus("telepresence");
    await page.evaluate(() => {
      const angle = -0.3; // about the vertical: to the right
      window.headset.quaternion.set(0, Math.sin(angle / 2), 0, Math.cos(angle / 2));
    });
    // The page's own frames are rare while the headset's are drawn.
    await page.waitForFunction(() => Math.abs(window.gaze.pan + 0.3) < 0.05, null, { polling: 50 });
    // The emulated headset's picture lies above the page.
    await page.getByRole("button", { name: "Leave the headset" }).dispatchEvent("click");
    await page.getByRole("button", { name: "Enter the headset" }).waitFor();
    await page.setViewportSize({ width: 1000, height: 720 });
  });

  test("a headset shows each eye its depth, in colours and as fog in its images", async () => {
    await page.setViewportSize({ width: 480, height: 400 });
    let isLost = false;
    await page.routeWebSocket(/streams\/depth\.right_depth/, (socket) => {
      socket.connectToServer().onMessage((message) => isLost || socket.send(message));
    });
    await takeSeat();
    await page.locator(".seat-tools button", { hasText: "Depth" }).click();
    await page.evaluate(() => (window.headset.stereoEnabled = true));
    await page.getByRole("button", { name: "Enter the headset" }).click();
    await page.getByRole("button", { name: "Leave the headset" }).waitFor();
    const coding = page.getByLabel("How depth is shown");
    await until("both halves are coloured", async () =>
      (await halvesSeen()).every(({ drawn, coloured }) => drawn > 0.2 && coloured > 0.5 * drawn),
    );
    await coding.selectOption("fog", { force: true });
    await until("both halves are the room in fog", async () =>
      (await halvesSeen()).every(({ drawn, coloured }) => drawn > 0.2 && coloured < 0.2 * drawn),
    );
    isLost = true;
    await until("the eye whose images are lost is dark, the other one is not", async () => {
      const [left, right] = await halvesSeen();
      return left.drawn > 0.2 && right.drawn === 0;
    });
    await page.getByRole("button", { name: "Leave the headset" }).dispatchEvent("click");
    await page.getByRole("button", { name: "Enter the headset" }).waitFor();
    await page.evaluate(() => (window.headset.stereoEnabled = false));
    await page.setViewportSize({ width: 1000, height: 720 });
  });

  test("a task that is chosen has the focus until it is released", async () => {
    await takeSeat("seat");
    const read = page.locator('[data-task="read"]');
    await read.click();
    await inFocus("read");
    assert.equal(await read.getAttribute("aria-pressed"), "true");
    await page.locator(".bar-why", { hasText: "read has the focus: a person's bid" }).waitFor();
    await read.click();
    assert.equal(await read.getAttribute("aria-pressed"), "false");
  });

  test("a page that is too slow to drive says so", async () => {
    await takeSeat();
    await page.locator('[data-task="read"]').click();
    await inFocus("read");
    await page.evaluate(() => {
      const end = performance.now() + 500; // longer than a command lasts
      while (performance.now() < end);
    });
    const slow = page.locator(".seat-who", { hasText: "this page is too slow" });
    await slow.waitFor();
    // Until it has been fast enough for a while; the other panels are heavy.
    await show("seat");
    await page.getByRole("button", { name: "Take the seat" }).click();
    await slow.waitFor({ state: "hidden" });
    await page.getByRole("button", { name: "Leave the seat" }).click();
  });

  test("a person who leaves the page leaves the seat", async () => {
    await takeSeat();
    await page.evaluate(() => {
      Object.defineProperty(document, "hidden", { configurable: true, get: () => true });
      document.dispatchEvent(new Event("visibilitychange"));
    });
    await page.locator(".seat-who", { hasText: "You left the page" }).waitFor();
  });
});
