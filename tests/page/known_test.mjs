// SPDX-License-Identifier: Apache-2.0
// What the page shows of streams whose contents are known, and who may do what in it.
import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";
import { Graph, openBrowser, until, watchdog } from "./harness.mjs";

/** Colours of the quarters of known.image, row by row. */
const colours = [
  [200, 40, 30],
  [30, 160, 60],
  [20, 60, 200],
  [128, 128, 128],
];
const quarters = [
  [0.25, 0.25],
  [0.75, 0.25],
  [0.25, 0.75],
  [0.75, 0.75],
];
const tolerance = 8; // of video, whose colours have half the resolution

let graph, browser, context, page, origin;

/** Opens the page with panels: what follows # in its URL. */
async function show(panels, on = page) {
  await on.goto("about:blank"); // else only what follows # would change
  await on.goto(`${origin}/#${panels}`);
}

/** Waits until a canvas has been drawn. */
async function drawn(selector) {
  await page.waitForFunction((selector) => {
    const canvas = document.querySelector(selector);
    if (!canvas || canvas.width < 2) return false;
    const copy = document.createElement("canvas").getContext("2d");
    copy.drawImage(canvas, canvas.width / 4, canvas.height / 4, 1, 1, 0, 0, 1, 1);
    return copy
      .getImageData(0, 0, 1, 1)
      .data.slice(0, 3)
      .some((value) => value > 0);
  }, selector);
}

/** Colours of a canvas at parts of its width and height. */
function pixels(selector, spots) {
  return page.evaluate(
    ([selector, spots]) => {
      const canvas = document.querySelector(selector);
      const { width, height } = canvas;
      const copy = Object.assign(document.createElement("canvas"), { width, height });
      const context = copy.getContext("2d");
      context.drawImage(canvas, 0, 0);
      return spots.map(([x, y]) => {
        const { data } = context.getImageData(Math.floor(x * width), Math.floor(y * height), 1, 1);
        return [...data.slice(0, 3)];
      });
    },
    [selector, spots],
  );
}

function assertColours(shown, sent) {
  shown.forEach((colour, i) =>
    colour.forEach((value, k) =>
      assert.ok(Math.abs(value - sent[i][k]) <= tolerance, `${shown.join("; ")} of ${sent}`),
    ),
  );
}

/** Puts the pointer on a part of a canvas; gives the words for what is there. */
async function wordsAt(selector, x, y) {
  const canvas = page.locator(selector);
  const box = await canvas.boundingBox();
  const { width, height } = await canvas.evaluate(({ width, height }) => ({ width, height }));
  const scale = Math.min(box.width / width, box.height / height);
  await page.mouse.move(
    box.x + box.width / 2 + (x - 0.5) * width * scale,
    box.y + box.height / 2 + (y - 0.5) * height * scale,
  );
  const words = page.locator(".probe", { hasText: /\S/ });
  await words.waitFor();
  return words.textContent();
}

describe("the page, of what is known", { timeout: 10 * watchdog }, () => {
  before(async () => {
    graph = new Graph("../tests/page/known.toml");
    browser = await openBrowser();
    context = await browser.newContext({ viewport: { width: 1000, height: 720 } });
    context.setDefaultTimeout(watchdog);
    page = await context.newPage();
    const url = await graph.url();
    origin = new URL(url).origin;
    await page.goto(url);
  });

  after(async () => {
    await browser?.close();
    await graph?.end();
  });

  test("an image has the colours that were sent, and its header is that of the wire", async () => {
    await show("stream,port=known.image");
    await drawn(".picture");
    assertColours(await pixels(".picture", quarters), colours);
    const [x, y, ...colour] = (await wordsAt(".picture", 0.25, 0.25)).match(/[\d.]+/g).map(Number);
    assert.ok(Math.abs(x - 40) <= 1 && Math.abs(y - 30) <= 1, `${x}, ${y}`);
    assertColours([colour], [colours[0]]);
    await page.getByRole("button", { name: "Header" }).click();
    const header = await page.locator(".header-strip .value:visible").allTextContents();
    assert.match(header.join(" "), /^1 \d+ 0 \d+ 8 \d{19} 30301 0 7 160 120$/);
  });

  test("a page knows how old an image is although its machine has slept", async () => {
    const slept = await context.newPage();
    await slept.addInitScript(() => {
      const now = performance.now.bind(performance);
      performance.now = () => now() - 7_200_000; // this clock does not count sleep
    });
    await show("stream,port=known.image", slept);
    await slept.locator(".header-strip", { hasText: /\d ms old/ }).waitFor();
    await slept.close();
  });

  test("depth has the colours of its legend, and its value is under the pointer", async () => {
    await show("stream,port=known.depth");
    await drawn(".picture");
    const [near, far] = await pixels(".picture", [
      [0.25, 0.25],
      [0.75, 0.25],
    ]);
    const [least, most] = await pixels(".legend-bar", [
      [0, 0],
      [0.999, 0],
    ]);
    assertColours([near, far], [least, most]);
    assert.notDeepEqual(near, far);
    assert.match(await wordsAt(".picture", 0.25, 0.25), /: 1\.5 m$/);
    assert.match(await wordsAt(".picture", 0.75, 0.25), /: 3\.5 m$/);
    assert.match(await wordsAt(".picture", 0.5, 0.9), /: unknown m$/);
    const legend = await page.locator(".legend").textContent();
    assert.match(legend, /≤ 1\.5 m.*2\.5 m.*≥ 3\.5 m.*25\.0 % unknown/);
  });

  test("a number is plotted", async () => {
    await show("stream,port=known.number");
    await page.locator(".series-button", { hasText: "42.5" }).waitFor();
    // The line itself: pixels in the colour of the first series.
    await page.waitForFunction(() => {
      const canvas = document.querySelector(".uplot canvas");
      const colour = getComputedStyle(document.body).getPropertyValue("--series-1").trim();
      const context = canvas?.getContext("2d");
      if (!context || canvas.width === 0) return false;
      const one = document.createElement("canvas").getContext("2d");
      one.fillStyle = colour;
      one.fillRect(0, 0, 1, 1);
      const [r, g, b] = one.getImageData(0, 0, 1, 1).data;
      const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
      for (let i = 0; i < data.length; i += 4)
        if (data[i] === r && data[i + 1] === g && data[i + 2] === b) return true;
      return false;
    });
  });

  test("text and a table are shown as they were sent", async () => {
    await show("stream,port=known.text|stream,port=known.grid");
    await page.locator(".console div", { hasText: "red green blue grey" }).first().waitFor();
    await page.locator(".numbers td", { hasText: "6" }).waitFor();
    const rows = await page
      .locator(".numbers tbody tr")
      .evaluateAll((rows) =>
        rows.map((row) => [...row.querySelectorAll("td")].map((cell) => cell.textContent)),
      );
    assert.deepEqual(rows, [
      ["1", "2", "3"],
      ["4", "5", "6"],
    ]);
  });

  test("sound has its level, and is heard", async () => {
    await page.addInitScript(() => {
      const start = AudioBufferSourceNode.prototype.start;
      AudioBufferSourceNode.prototype.start = function (...when) {
        window.played = {
          rate: this.buffer.sampleRate,
          most: Math.max(...this.buffer.getChannelData(0)),
        };
        return start.apply(this, when);
      };
    });
    await show("stream,port=known.sound");
    await page.locator(".sound-view", { hasText: /channel 0\s+-6 dB/ }).waitFor();
    await page.locator(".sound-view", { hasText: /channel 1\s+-12 dB/ }).waitFor();
    await page.locator(".sound-view", { hasText: "8000 Hz" }).waitFor();
    await show("seat");
    await page.getByRole("button", { name: "Listen" }).click();
    const played = await page.waitForFunction(() => window.played);
    assert.deepEqual(await played.jsonValue(), { rate: 16000, most: 0.5 });
  });

  test("words that are typed are said", async () => {
    await show("seat|stream,port=known.heard");
    await page.getByRole("button", { name: "Take the seat" }).click();
    await page.locator(".seat-who", { hasText: "You hold the head (look)." }).waitFor();
    await page.getByLabel("Say", { exact: true }).fill("good morning");
    await page.getByRole("button", { name: "Say it" }).click();
    await page.locator(".console div", { hasText: "good morning" }).waitFor();
  });

  test("a recording that was made in the page is replayed", async () => {
    await show("recordings");
    await page.getByLabel("My choice").check(); // begins with the streams of the preset
    const ports = ["known.image", "known.number"];
    for (const box of await page.locator(".stream-choice input").all())
      await box.setChecked(ports.includes(await box.getAttribute("value")));
    await page.getByRole("button", { name: "Start recording" }).click();
    await page.locator(".running-words", { hasText: /: [1-9]\d* s,/ }).waitFor();
    await page.getByRole("button", { name: "End recording" }).click();
    await page.getByRole("button", { name: /^Open 2/ }).click();
    const scrub = page.getByLabel("Time in the recording");
    await scrub.waitFor();
    const seconds = Number(await scrub.getAttribute("max"));
    assert.ok(seconds > 0, `${seconds} s`);
    const at = (Math.floor(100 * seconds) / 100).toFixed(2); // at 0 there may be no image yet
    await scrub.fill(String(Number(at)));
    await page.locator(".clock", { hasText: `${at} of` }).waitFor();
    await drawn(".replay .picture");
    assertColours(await pixels(".replay .picture", quarters), colours);
    // With the name and the unit that its module declares.
    await page.locator(".replay .series-button", { hasText: /level.*42\.5 m/ }).waitFor();
  });

  test("a recording is deleted after a question", async () => {
    await show("recordings");
    const item = page.locator(".recording-list li");
    await item.getByRole("button", { name: /^Delete/ }).click();
    await page.getByRole("button", { name: "Keep" }).click();
    await item.getByRole("button", { name: /^Delete/ }).click();
    await page.getByRole("button", { name: "Delete", exact: true }).click();
    await page.getByText("No recordings yet.").waitFor();
  });

  test("the key ? opens the help, but not where text is typed", async () => {
    await show("log");
    const help = page.locator(".help-dialog");
    await page.getByRole("button", { name: "Open…" }).click();
    await page.getByRole("searchbox").press("?");
    assert.equal(await help.isVisible(), false);
    await page.getByRole("searchbox").fill(""); // else Escape would only empty it
    await page.keyboard.press("Escape");
    await page.getByRole("button", { name: "Help" }).focus();
    await page.keyboard.press("?");
    await help.getByRole("button", { name: "Close" }).click(); // Escape twice would be a stop
    await help.waitFor({ state: "hidden" });
  });

  test("streams are found by their type and their description", async () => {
    await page.getByRole("button", { name: "Open…" }).click();
    const dialog = page.getByRole("dialog", { name: "Open a panel" });
    await dialog.getByRole("button", { name: "Sound" }).click();
    await dialog.getByRole("button", { name: /^known\.sound/ }).waitFor();
    assert.equal(await dialog.getByRole("button", { name: /^known\.image/ }).count(), 0);
    await dialog.getByRole("button", { name: "Sound", exact: true }).click();
    await dialog.getByRole("searchbox").fill("a row for each mode");
    await page.keyboard.press("Enter");
    await page.locator(".bids .bid", { hasText: "look" }).waitFor();
  });

  test("a second page takes the seat from the first", async () => {
    await show("seat");
    await page.getByRole("button", { name: "Take the seat" }).click();
    await page.locator(".seat-who", { hasText: "You hold the head (look)." }).waitFor();
    const second = await context.newPage();
    await show("seat", second);
    await second.getByRole("button", { name: "Take the seat from them" }).click();
    await second.locator(".seat-who", { hasText: "You hold the head (look)." }).waitFor();
    await page.locator(".seat-who", { hasText: "Somebody else drives." }).waitFor();
    await second.getByRole("button", { name: "Leave the seat" }).click();
    await page.getByRole("button", { name: "Take the seat", exact: true }).waitFor();
    await second.close();
  });

  test("who has the seat holds the head until the robot is to decide, or they leave", async () => {
    await show("seat");
    await page.getByRole("button", { name: "Take the seat" }).click();
    const who = (words) => page.locator(".seat-who", { hasText: words }).waitFor();
    await who("You hold the head (look).");
    await page.getByRole("button", { name: "Let the robot decide" }).click();
    await who("The robot decides: no task.");
    await page.locator('[data-task="look"]').click();
    await who("You hold the head (look).");
    await page.getByRole("button", { name: "Let the robot decide" }).click();
    await who("The robot decides: no task.");
    await page.locator(".seat").focus();
    await page.keyboard.press("ArrowLeft", { delay: 200 }); // who steers holds it again
    await who("You hold the head (look).");
    await page.getByRole("button", { name: "Leave the seat" }).click();
    await who("The robot decides: no task.");
  });

  test("who may view may stop, and not clear", async () => {
    await show("graph");
    const invitation = await page.evaluate(
      () =>
        new Promise((resolve) => {
          const socket = new WebSocket(`ws://${location.host}/graph`);
          socket.onopen = () => socket.send("invite view");
          socket.onmessage = async ({ data }) => {
            const text = await data.text();
            const url = text.match(/https?:\/\/\S+token=\w+/);
            if (text.startsWith("1 4 ")) resolve(url[0]);
          };
        }),
    );
    const other = await browser.newContext();
    const viewer = await other.newPage();
    await viewer.goto(invitation);
    await show("seat", viewer);
    await viewer.locator(".seat-who", { hasText: "You may only look" }).waitFor();
    assert.ok(await viewer.getByRole("button", { name: "Take the seat" }).isHidden());
    await viewer.getByRole("button", { name: "Stop", exact: true }).click();
    const bar = page.locator(".stopped-bar");
    await bar.waitFor();
    await viewer.locator(".stop-note").waitFor();
    await bar.getByText("by a page (web.stop). No task has the focus.").waitFor();
    assert.ok(await viewer.getByRole("button", { name: "Let it move" }).isHidden());
    await bar.getByLabel("the robot's way is clear").check();
    await bar.getByRole("button", { name: "Let it move" }).click();
    await viewer.locator(".stopped-bar").waitFor({ state: "hidden" });
    await other.close();
  });

  test("a stop that is not confirmed is told in large letters, and nothing moves", async () => {
    await show("seat");
    await page.locator(".seat-who", { hasText: "The robot decides: no task." }).waitFor();
    const boxes = () =>
      page.evaluate(() =>
        [...document.querySelectorAll(".bar > *, .board, .seat *, .status-line")].map((element) => {
          const { x, y, width, height } = element.getBoundingClientRect();
          return `${element.className} ${[x, y, width, height].map(Math.round).join(" ")}`;
        }),
      );
    const before = await boxes();
    const alarm = page.locator(".not-stopped");
    for (const [name, words] of [
      ["workspace", "the workspace does not answer"],
      ["web", "There is no answer yet."],
    ]) {
      const pid = graph.pid(name);
      process.kill(pid, "SIGSTOP");
      try {
        await until("the stop is pressed", async () => {
          await page.keyboard.press("Escape");
          return alarm.isVisible();
        });
        await alarm.getByText(words).waitFor();
        await alarm.getByText("NOT STOPPED").waitFor();
        const { width, height } = await alarm.boundingBox();
        assert.ok(width >= 1000 && height > 150, `${width} x ${height}`);
        assert.ok(await page.locator(".stopped-bar").isHidden());
        assert.deepEqual(await boxes(), before);
      } finally {
        process.kill(pid, "SIGCONT");
      }
      // It was repeated.
      await alarm.waitFor({ state: "hidden" });
      const bar = page.locator(".stopped-bar");
      await bar.waitFor();
      await page.locator(".seat-who", { hasText: "Stopped." }).waitFor();
      assert.deepEqual(await boxes(), before);
      await bar.getByLabel("the robot's way is clear").check();
      await bar.getByRole("button", { name: "Let it move" }).click();
      await bar.waitFor({ state: "hidden" });
    }
  });

  test("a stop without a connection is told at once", async () => {
    const alone = await context.newPage();
    await alone.addInitScript(() => {
      const Real = window.WebSocket;
      window.WebSocket = class extends Real {
        constructor(url) {
          super(url);
          if (window.unplugged) this.close();
          (window.sockets ??= []).push(this);
        }
      };
      window.unplug = () => {
        window.unplugged = true;
        for (const socket of window.sockets) socket.close(4000);
      };
    });
    await show("seat", alone);
    await alone.locator(".seat-who", { hasText: "The robot decides" }).waitFor();
    await alone.evaluate(() => window.unplug());
    await alone.locator(".trouble", { hasText: "No connection" }).waitFor();
    await alone.getByRole("button", { name: "Stop", exact: true }).click();
    await alone.locator(".not-stopped", { hasText: "no connection to its server" }).waitFor();
    await alone.evaluate(() => (window.unplugged = false));
    await alone.locator(".not-stopped").waitFor({ state: "hidden" });
    const bar = alone.locator(".stopped-bar");
    await bar.waitFor();
    await bar.getByLabel("the robot's way is clear").check();
    await bar.getByRole("button", { name: "Let it move" }).click();
    await bar.waitFor({ state: "hidden" });
    await alone.close();
  });

  test("a stop outlives its server, and is pressed again where that hung", async () => {
    await show("graph");
    const bar = page.locator(".stopped-bar");
    const alarm = page.locator(".not-stopped");
    const clear = async () => {
      await bar.getByLabel("the robot's way is clear").check();
      await bar.getByRole("button", { name: "Let it move" }).click();
      await bar.waitFor({ state: "hidden" });
    };
    await page.getByRole("button", { name: "Stop", exact: true }).click();
    await bar.waitFor();
    // Whoever has no server does not know whether the robot is stopped.
    const trouble = page.locator(".trouble", { hasText: "whether the robot is stopped" });
    await page.evaluate(() => {
      window.seen = [];
      new MutationObserver(() => {
        const lost = document.querySelector(".trouble")?.textContent.includes("unknown");
        if (lost) window.seen.push(document.querySelector(".stopped-bar").hidden);
      }).observe(document.body, { subtree: true, childList: true, characterData: true });
    });
    process.kill(graph.pid("web"), "SIGKILL");
    await until("the connection is lost", () => page.evaluate(() => window.seen.length > 0));
    assert.equal(await page.evaluate(() => window.seen[0]), true);
    await trouble.waitFor({ state: "hidden" }); // the session is that of the run
    await bar.waitFor();
    await clear();
    const pid = graph.pid("web");
    process.kill(pid, "SIGSTOP");
    await page.getByRole("button", { name: "Stop", exact: true }).click();
    await alarm.waitFor();
    process.kill(pid, "SIGKILL");
    await bar.waitFor();
    await alarm.waitFor({ state: "hidden" });
    await clear();
  });
});
