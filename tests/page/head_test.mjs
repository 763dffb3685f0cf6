// SPDX-License-Identifier: Apache-2.0
// The page in a browser, on the running head.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, describe, test } from "node:test";
import {
  axeFile,
  Graph,
  headsetFile,
  openBrowser,
  until,
  watchdog,
  watchGaze,
} from "./harness.mjs";

// Images that take little time; with them it is not calibrated, and drives by these lenses.
const lenses = ["point", "track", "read_gaze"].flatMap((name) => [
  `${name}.focal=120`,
  `${name}.cx=79.5`,
  `${name}.cy=59.5`,
]);
const small = [
  "head_eyes.rate=10",
  "head_eyes.width=160",
  "head_eyes.height=120",
  "head_eyes.focal=120",
  "rectify.focal=120",
  "calibrate.salience=0",
  "left_ball.min_area=3",
  "right_ball.min_area=3",
  ...lenses,
];

let graph, browser, context, page, origin;

/** Shows panels: what follows # in the URL. */
async function show(panels) {
  await page.goto(`${origin}/#${panels}`);
  await page.reload();
}

const gaze = () => page.evaluate(() => window.gaze);

/** Waits until the head has turned from where it is by more than 3 degrees in a direction. */
async function turned(axis, sign, from, timeout = watchdog) {
  await page.waitForFunction(
    ([axis, sign, from]) => sign * (window.gaze[axis] - from) > 0.05,
    [axis, sign, from],
    { timeout },
  );
}

async function inFocus(task, timeout = watchdog) {
  await page.locator(".bar .focus", { hasText: task }).waitFor({ timeout });
}

/** Does again what counts once and not for long, as on a busy machine it may have come too late. */
function untilDone(what, act, ...results) {
  return until(what, async () => {
    await act();
    const all = Promise.all(results.map((result) => result(3_000)));
    return all.then(
      () => true,
      () => false,
    );
  });
}

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

async function takeSeat(panels = "seat") {
  await show(panels);
  await page.getByRole("button", { name: "Take the seat" }).click();
  await page.locator(".seat-who", { hasText: "You hold the head (point)." }).waitFor();
  await watchGaze(page);
}

describe("the page", { timeout: 10 * watchdog }, () => {
  before(async () => {
    graph = new Graph(
      "head.toml",
      small.flatMap((each) => ["--set", each]),
    );
    browser = await openBrowser();
    context = await browser.newContext({ viewport: { width: 1000, height: 720 } });
    context.setDefaultTimeout(watchdog);
    await context.addInitScript({ path: headsetFile });
    await context.addInitScript(() => {
      window.headset = new IWER.XRDevice(IWER.metaQuest3);
      window.headset.installRuntime({ forceInstall: true });
    });
    page = await context.newPage();
    const url = await graph.url();
    origin = new URL(url).origin;
    await page.goto(url);
  });

  after(async () => {
    await browser?.close();
    await graph?.end();
  });

  test("the graph appears, each module in one box", async () => {
    await show("graph");
    await page.locator(".node").first().waitFor();
    const drawn = await page
      .locator(".node")
      .evaluateAll((nodes) => nodes.flatMap((n) => n.dataset.members.split(" ")));
    assert.deepEqual(
      drawn.sort(),
      graph
        .state()
        .modules.map(({ name }) => name)
        .sort(),
    );
    assert.equal(await page.locator(".caption").first().textContent(), "head");
    await page.locator(".bar-why", { hasText: "has the focus" }).waitFor();
  });

  test("text in the graph has at least 10 px, also when all parts are open", async () => {
    await page.setViewportSize({ width: 1280, height: 800 });
    await show("watch");
    await page.locator(".node").first().waitFor();
    assert.ok((await smallestText()) >= 10);
    const closed = page.locator('.node[aria-expanded="false"]');
    assert.ok((await closed.count()) >= 4);
    while ((await closed.count()) > 0) await closed.first().press("Enter");
    assert.ok((await smallestText()) >= 10);
    await page.setViewportSize({ width: 1000, height: 720 });
  });

  test("no label of a link covers another one or a box, also with all links", async () => {
    await page.setViewportSize({ width: 1280, height: 800 });
    await show("watch");
    for (const all of [false, true]) {
      if (all) await page.getByLabel("all links").check();
      await page.locator(".edge-age:not(:empty)").nth(10).waitFor();
      const covered = await page.evaluate(() => {
        const areas = (selector) =>
          [...document.querySelectorAll(selector)]
            .map((element) => ({ text: element.textContent, area: element.getBoundingClientRect() }))
            .filter(({ area }) => area.width > 0);
        const labels = areas(".edge-words");
        const others = [...labels, ...areas(".node-box"), ...areas(".caption-text")];
        const isOver = (a, b) =>
          Math.min(a.right, b.right) - Math.max(a.left, b.left) > 0.5 &&
          Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 0.5;
        return labels.flatMap((a) =>
          others.filter((b) => a !== b && isOver(a.area, b.area)).map((b) => [a.text, b.text]),
        );
      });
      assert.deepEqual(covered, []);
    }
    await page.setViewportSize({ width: 1000, height: 720 });
  });

  test("the neck in the graph says how it is turned, as it turns", async () => {
    await takeSeat("seat|graph");
    const [pan, tilt] = [0, 1].map((i) => page.locator(".node-pose:visible tspan").nth(i));
    await pan.filter({ hasText: /^pan −?\d+°$/ }).waitFor();
    await tilt.filter({ hasText: /^tilt −?\d+°$/ }).waitFor();
    const before = await pan.textContent();
    await page.locator(".seat").focus();
    await page.keyboard.down("ArrowRight");
    await pan.filter({ hasNotText: before }).waitFor();
    await page.keyboard.up("ArrowRight");
  });

  test("each part and each link is reached with the keyboard, and has a name", async () => {
    await show("graph");
    await page.locator(".node").first().waitFor();
    await page.locator('.graph-drawing [tabindex="0"]').focus();
    const reached = new Set();
    for (;;) {
      const name = await page.evaluate(() => {
        const { activeElement: element } = document;
        return element.getAttribute("aria-label") ?? element.querySelector("title").textContent;
      });
      assert.match(name, /\S/);
      const of = await page.evaluate(() => {
        const { members, edge } = document.activeElement.dataset;
        return members ?? edge;
      });
      if (reached.has(of)) break;
      reached.add(of);
      await page.keyboard.press("ArrowDown");
    }
    const shown = await page.locator('.graph-drawing [role="button"]:visible').count();
    assert.ok(shown > 20);
    assert.equal(reached.size, shown);
  });

  test("a part opens into its modules with Enter, and closes again", async () => {
    await show("graph");
    const parts = page.locator(".node");
    const ball = page.locator('.node[data-members="left_ball right_ball"]');
    await ball.press("Enter");
    await page.locator('.node[data-members="left_ball"]').waitFor();
    await page.locator('.caption[aria-expanded="true"]').first().press("Enter");
    await ball.waitFor();
    assert.ok(await ball.evaluate((element) => element === document.activeElement));
    assert.ok((await parts.count()) < graph.state().modules.length);
  });

  test("its rates are those of hc top", async () => {
    await show("graph,show=tables");
    await until("rates of both agree", async () => {
      const cells = await page
        .locator(".live-table")
        .nth(1)
        .locator("tbody tr")
        .evaluateAll((rows) =>
          rows.map((row) => [...row.children].map((cell) => cell.textContent)),
        );
      const shown = new Map(cells.map(([from, to, , rate]) => [`${from} ${to}`, rate]));
      const { links } = graph.state();
      if (shown.size !== links.length) return false; // not shown yet
      const steady = links.filter(({ from }) => from.startsWith("head_eyes."));
      assert.ok(steady.length >= 5);
      return steady.every(({ from, to, per_second }) => {
        const rate = parseFloat(shown.get(`${from} ${to}`));
        return per_second > 1 && Math.abs(rate - per_second) < 0.25 * per_second + 1;
      });
    });
  });

  test("a module that is killed is red until it runs again", async () => {
    await show("graph");
    const node = page.locator('[data-members~="left_ball"]');
    await node.waitFor();
    await node.evaluate((element) => {
      window.seen = [];
      new MutationObserver(() => {
        window.seen.push({
          broken: element.classList.contains("broken"),
          text: element.querySelector("title").textContent,
        });
      }).observe(element, {
        attributes: true,
        childList: true,
        characterData: true,
        subtree: true,
      });
    });
    const { restarts } = graph.module("left_ball");
    process.kill(graph.pid("left_ball"), "SIGKILL");
    // It may have been red before, where it had no processor for long.
    await page.waitForFunction(() =>
      window.seen.find(({ broken, text }) => broken && /left_ball.*signal 9/.test(text)),
    );
    await page.waitForFunction(() => window.seen.length > 0 && !window.seen.at(-1).broken);
    assert.equal(graph.module("left_ball").restarts, restarts + 1);
  });

  test("a module opens with Enter, and a parameter that is changed there arrives", async () => {
    await show("graph");
    const node = page.locator('.node[data-members="workspace"]');
    await node.focus();
    await page.keyboard.press("Enter");
    const margin = page.getByLabel("margin", { exact: true });
    const value = () => graph.module("workspace").parameters.margin;
    await margin.fill("0.15");
    await margin.press("Enter");
    await until("the parameter arrives", () => value() === "0.15");
    await margin.fill("-1");
    await margin.press("Enter");
    await page.locator('[data-parameter="margin"] .problem', { hasText: /\S/ }).waitFor();
    assert.equal(value(), "0.15");
  });

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
      const end = performance.now() + 500; // longer than what is commanded lasts
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

  test("who leaves the page leaves the seat", async () => {
    await takeSeat();
    await page.evaluate(() => {
      Object.defineProperty(document, "hidden", { configurable: true, get: () => true });
      document.dispatchEvent(new Event("visibilitychange"));
    });
    await page.locator(".seat-who", { hasText: "You left the page" }).waitFor();
  });

  test("the stop stops, and is cleared by two other controls", async () => {
    await show("seat");
    await page.locator(".stop", { hasText: "Stop" }).waitFor();
    const bar = page.locator(".stopped-bar");
    // On a busy machine two presses can be further apart than those of a person who is in a hurry.
    await until("the robot is stopped", async () => {
      await page.keyboard.press("Escape");
      return bar.isVisible();
    });
    await noFocus();
    assert.ok(await bar.getByRole("button", { name: "Let it move" }).isDisabled());
    await bar.getByLabel("the robot's way is clear").check();
    await bar.getByRole("button", { name: "Let it move" }).click();
    await bar.waitFor({ state: "hidden" });
    await until("a task has the focus again", () => graph.state().focus.workspace);
  });

  test("a stop that is pressed before the page is connected stops", async () => {
    const early = await context.newPage();
    await early.addInitScript(() => {
      new MutationObserver((_, observer) => {
        const button = document.querySelector(".stop");
        if (!button) return;
        observer.disconnect();
        button.click();
      }).observe(document, { childList: true, subtree: true });
    });
    await early.goto(`${origin}/#seat`);
    const bar = early.locator(".stopped-bar");
    await bar.waitFor();
    await bar.getByLabel("the robot's way is clear").check();
    await bar.getByRole("button", { name: "Let it move" }).click();
    await bar.waitFor({ state: "hidden" });
    await early.close();
  });

  test("the switch goes between the views, and the URL names the one that is shown", async () => {
    await show("");
    const current = (name) =>
      page.locator('.switch [aria-current="page"]', { hasText: name }).waitFor();
    await current("Watch");
    await page.locator(".kind-graph").waitFor();
    await page.getByRole("link", { name: "Drive" }).click();
    await current("Drive");
    await page.locator(".seat").waitFor();
    assert.ok(page.url().endsWith("#drive"));
    await show("seat|graph,show=tables");
    await current("Build");
    await page.getByRole("link", { name: "Watch" }).click();
    await page.locator(".kind-log").waitFor();
    assert.ok(page.url().endsWith("#watch"));
    await page.getByRole("link", { name: "Build" }).click();
    await page.locator(".kind-seat").waitFor(); // its panels are those of before
    assert.ok(page.url().endsWith("#seat|graph,show=tables"));
  });

  test("nothing moves while the focus changes twenty times", async () => {
    const observers = await Promise.all(
      ["watch", "build"].map(async (view) => {
        const observer = await context.newPage();
        await observer.goto(`${origin}/#${view}`);
        return observer;
      }),
    );
    await takeSeat("drive");
    const all = [page, ...observers];
    for (const each of all) {
      await each.locator(".waiting").first().waitFor({ state: "detached" });
      await each.evaluate(() => {
        window.shifts = [];
        new PerformanceObserver((list) => {
          for (const { value, sources } of list.getEntries())
            window.shifts.push(`${value} ${sources.map(({ node }) => node?.className)}`);
        }).observe({ type: "layout-shift" });
      });
    }
    for (let i = 0; i < 20; i++) {
      const task = ["read", "track", "point"][i % 3];
      // Not by the mouse: a shift soon after a person's input does not count.
      await page.locator(`[data-task="${task}"]`).dispatchEvent("click");
      for (const each of all) await each.locator(".bar .focus", { hasText: task }).waitFor();
    }
    for (const each of all) assert.deepEqual(await each.evaluate(() => window.shifts), []);
    await Promise.all(observers.map((each) => each.close()));
  });

  for (const theme of ["light", "dark"]) {
    for (const [panels, ready] of [
      ["drive", ".task-button"],
      ["watch", ".kind-stream canvas"],
      ["build", ".kind-stream canvas"],
      ["graph,show=tables;module,name=head_eyes|seat", ".module .parameter"],
      ["recordings|graph", ".node"],
      ["bids", ".bid"],
    ]) {
      test(`${panels} is accessible, in ${theme}`, async () => {
        await page.emulateMedia({ colorScheme: theme });
        await show(panels);
        await page.locator(ready).first().waitFor();
        await assertAccessible();
      });
    }
  }

  for (const [width, height] of [
    [360, 640],
    [640, 360],
    [3840, 2160],
  ]) {
    test(`nothing is wider than the page at ${width} × ${height}`, async () => {
      await page.setViewportSize({ width, height });
      for (const panels of ["drive", "watch", "build", "bids", "module,name=head_eyes"]) {
        await show(panels);
        await page.locator(".graph, .bids, .seat, .module").first().waitFor();
        const excess = await page.evaluate(
          () => document.documentElement.scrollWidth - document.documentElement.clientWidth,
        );
        assert.ok(excess <= 0, `${panels}: ${excess} px too wide`);
      }
    });

    test(`image, pad and stop are in sight together at ${width} × ${height}`, async () => {
      await page.setViewportSize({ width, height });
      await show("drive");
      await page.locator(".seat-image").waitFor();
      for (const [selector, least] of [
        [".seat-image", 0.33],
        [".pad", 0.18],
        [".bar .stop", 0.05],
      ]) {
        const { x, y, width: w, height: h } = await page.locator(selector).boundingBox();
        const isInside = x >= 0 && y >= 0 && x + w <= width && y + h <= height;
        assert.ok(isInside, `${selector}: ${[x, y, w, h]}`);
        assert.ok(h >= least * height, `${selector}: ${h} px high`);
      }
    });
  }

  test("after the graph has ended, nothing says that it runs", async () => {
    await page.setViewportSize({ width: 1000, height: 720 });
    await show("graph,show=tables;graph;bids|module,name=head_eyes|seat");
    await page.locator(".module-status", { hasText: "running" }).waitFor();
    await page.locator(".node.has-focus").first().waitFor();
    graph.process.kill("SIGTERM");
    await page.locator(".trouble", { hasText: /ENDED/ }).waitFor();
    const said = await page.locator("body").innerText();
    assert.doesNotMatch(said, /has the focus|focus:|running|\bworks\b|bids 0|Take the seat|decides/);
    assert.equal(await page.locator(".graph-drawing .in-workspace").count(), 0);
    await page.getByRole("button", { name: "Stop", exact: true }).click();
    await page.locator(".not-stopped", { hasText: "The graph has ended" }).waitFor();
  });
});

/** Of the drawing of the graph [px]. */
function smallestText() {
  return page
    .locator(".graph-drawing text:visible")
    .evaluateAll((texts) =>
      Math.min(
        ...texts
          .filter((text) => text.textContent !== "")
          .map((text) => parseFloat(getComputedStyle(text).fontSize) * text.getScreenCTM().a),
      ),
    );
}

async function noFocus() {
  await page.locator(".bar .focus:empty").waitFor({ state: "attached" });
}

const axe = readFileSync(axeFile, "utf8");

/** axe-core finds nothing. */
async function assertAccessible() {
  const session = await context.newCDPSession(page);
  // As from the developer's tools: the page's policy allows no scripts from elsewhere.
  await session.send("Runtime.evaluate", { expression: axe });
  const { violations } = await page.evaluate(() =>
    axe.run(document, { resultTypes: ["violations"] }),
  );
  await session.detach();
  const text = violations.map(
    ({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join("\n  ")}`,
  );
  assert.equal(violations.length, 0, text.join("\n"));
}
