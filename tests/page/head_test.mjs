// SPDX-License-Identifier: Apache-2.0
// The page in a browser, on the running head: its views, the graph, stops, and how it looks.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, describe, test } from "node:test";
import { axeFile, until, watchdog } from "./harness.mjs";
import {
  context,
  endHead,
  graph,
  origin,
  page,
  show,
  startHead,
  takeSeat,
  untilDone,
} from "./running_head.mjs";

describe("the page", { timeout: 10 * watchdog }, () => {
  before(startHead);
  after(endHead);

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
    const closed = page.locator('.node[aria-expanded="false"]');
    await closed.nth(3).waitFor();
    await fitted();
    while ((await closed.count()) > 0) await closed.first().press("Enter");
    assert.ok((await smallestText()) >= 10);
    await page.setViewportSize({ width: 1000, height: 720 });
  });

  test("no label of a link covers another one or a box, also with all links", async () => {
    await page.setViewportSize({ width: 1280, height: 800 });
    await show("watch");
    const lines = page.locator(".edge-line").filter({ visible: true });
    for (const all of [false, true]) {
      const few = await lines.count();
      if (all) {
        await page.getByLabel("all links").check();
        await until("more links are drawn", async () => (await lines.count()) > few);
      }
      const aged = page.locator(".edge-age:not(:empty)").filter({ visible: true });
      await aged.nth(all ? Math.floor(few / 2) : 10).waitFor();
      await fitted();
      const covered = await page.evaluate(() => {
        const areas = (selector) =>
          [...document.querySelectorAll(selector)]
            .map((element) => ({
              text: element.textContent,
              area: element.getBoundingClientRect(),
            }))
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
    // A page that the server takes for lost, since it is too slow, loses the command.
    await untilDone(
      "the parameter is set",
      async () => {
        await margin.fill("0.15");
        await margin.press("Enter");
      },
      (timeout) => until("the parameter arrives", () => value() === "0.15", timeout),
    );
    await margin.fill("-1");
    await margin.press("Enter");
    await page.locator('[data-parameter="margin"] .problem', { hasText: /\S/ }).waitFor();
    assert.equal(value(), "0.15");
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

  /** Changes the focus from the seat; nothing moves in a page, which may be that of the seat. */
  async function assertNothingMoves(observer, changes) {
    await observer.locator(".bar .focus:not(:empty)").waitFor();
    await observer.locator(".waiting").first().waitFor({ state: "detached" });
    await observer.evaluate(() => {
      window.shifts = [];
      new PerformanceObserver((list) => {
        for (const { value, sources } of list.getEntries())
          window.shifts.push(`${value} ${sources.map(({ node }) => node?.className)}`);
      }).observe({ type: "layout-shift" });
    });
    for (let i = 0; i < changes; i++) {
      const task = ["read", "track", "point"][i % 3];
      // Not by the mouse: a shift soon after a person's input does not count.
      await page.locator(`[data-task="${task}"]`).dispatchEvent("click");
      await observer.locator(".bar .focus", { hasText: task }).waitFor();
    }
    assert.deepEqual(await observer.evaluate(() => window.shifts), []);
  }

  test("nothing moves in drive while the focus changes twenty times", async () => {
    await takeSeat("drive");
    await assertNothingMoves(page, 20);
  });

  for (const view of ["watch", "build"]) {
    test(`nothing moves in ${view} while the focus changes`, async () => {
      await takeSeat("drive");
      const observer = await context.newPage();
      try {
        await page.setViewportSize({ width: 360, height: 640 }); // little to draw
        await observer.goto(`${origin}/#${view}`);
        await assertNothingMoves(observer, 6);
      } finally {
        await observer.close();
        await page.setViewportSize({ width: 1000, height: 720 });
      }
    });
  }

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
    assert.doesNotMatch(
      said,
      /has the focus|focus:|running|\bworks\b|bids 0|Take the seat|decides/,
    );
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

/** The graph is fitted into its window before it is painted, which may be after it is built. */
function fitted() {
  return until("the graph is fitted", async () => (await smallestText()) >= 10);
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
