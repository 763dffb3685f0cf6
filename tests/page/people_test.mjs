// SPDX-License-Identifier: Apache-2.0
// People and hands on the page: over the images, named and held from the seat.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, describe, test } from "node:test";
import { axeFile, Graph, openBrowser, watchdog } from "./harness.mjs";

/** Of the images, and of the boxes of the two faces [px] (tests/modules/seen). */
const image = { width: 320, height: 240 };
const ann = { x: 40, y: 60, side: 80 };
const stranger = { x: 200, y: 80, side: 60 };

let graph, browser, context, page, origin;

async function show(panels) {
  await page.goto("about:blank");
  await page.goto(`${origin}/#${panels}`);
}

/** Where a pixel of the sensor is in the window, in an image that is shown as large as possible. */
async function windowPoint(selector, x, y) {
  const box = await page.locator(selector).boundingBox();
  const scale = Math.min(box.width / image.width, box.height / image.height);
  return [
    box.x + box.width / 2 + (x + 0.5 - image.width / 2) * scale,
    box.y + box.height / 2 + (y + 0.5 - image.height / 2) * scale,
  ];
}

async function clickAt(x, y) {
  await page.mouse.click(...(await windowPoint(".seat-image", x, y)));
}

const clickOn = ({ x, y, side }) => clickAt(x + side / 2, y + side / 2);

const person = (track) => page.locator(`.seen-person[data-track="${track}"]`);
const heard = (words) => page.locator(".console div", { hasText: words }).first().waitFor();

async function takeSeat() {
  await show("seat|stream,port=seen.heard");
  await page.getByRole("button", { name: "Take the seat" }).click();
  await page.locator(".seat-who", { hasText: "You hold the head (look)." }).waitFor();
  await person(7).waitFor({ state: "attached" });
}

/** Whether a box is drawn where the face is, to 3 px of the window. */
async function assertOver(selector, track, { x, y, side }) {
  const box = await person(track).locator(".seen-lines.ink").boundingBox();
  const [left, top] = await windowPoint(selector, x, y);
  const [right, bottom] = await windowPoint(selector, x + side, y + side);
  const shown = [box.x, box.y, box.x + box.width, box.y + box.height];
  [left, top, right, bottom].forEach((each, i) =>
    assert.ok(Math.abs(each - shown[i]) <= 3, `${shown} is not ${[left, top, right, bottom]}`),
  );
}

async function setShow(value) {
  await page.evaluate(
    (value) =>
      new Promise((resolve) => {
        const socket = new WebSocket(`ws://${location.host}/graph`);
        socket.onopen = () => socket.send(`set seen.show=${value}`);
        socket.onmessage = async ({ data }) => {
          if ((await data.text()).startsWith("1 4 ")) resolve(socket.close());
        };
      }),
    value,
  );
}

describe("people on the page", { timeout: 10 * watchdog }, () => {
  before(async () => {
    graph = new Graph("../tests/page/people.toml");
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

  test("faces have boxes with names where they are, in the seat and over a stream", async () => {
    await show("seat");
    await person(7).locator("text", { hasText: "Ann · nearest" }).waitFor();
    await person(8).locator("text", { hasText: /^\?$/ }).waitFor();
    await assertOver(".seat-image", 7, ann);
    await assertOver(".seat-image", 8, stranger);
    await page.locator(".seen-hand text", { hasText: "open hand" }).waitFor();
    assert.ok(await person(7).evaluate((each) => each.classList.contains("attended")));
    await show("stream,port=seen.left");
    await person(7).waitFor({ state: "attached" });
    await assertOver(".picture", 7, ann);
  });

  test("who is clicked is named, and the head is not turned", async () => {
    await takeSeat();
    await clickOn(stranger);
    const name = page.getByLabel("Name:");
    await name.fill("../Bob");
    await name.press("Enter");
    await page.locator(".status-line", { hasText: "This name is too long, begins with a dot, or has a" }).waitFor();
    await name.fill("Zoë van der Berg");
    await name.press("Enter");
    await heard("name 8 Zoë van der Berg");
    await page.locator(".status-line", { hasText: "seen: nobody can be learned here" }).waitFor();
    await name.waitFor({ state: "hidden" });
    await page.locator(".seat-who", { hasText: "You hold the head (look)." }).waitFor();
    assert.equal(await page.locator(".console div", { hasText: "target" }).count(), 0);
    await clickAt(160, 20); // nobody is there
    await heard("target");
  });

  test("who is held is looked at until the next click", async () => {
    await takeSeat();
    await clickOn(stranger);
    await page.getByRole("button", { name: "Hold", exact: true }).click();
    await heard("hold 8");
    await person(8).locator("text", { hasText: "? · held" }).waitFor();
    await page.locator(".seat-who", { hasText: "You hold the head (attend)." }).waitFor();
    await page.getByRole("button", { name: "Close", exact: true }).click();
    await clickOn(stranger);
    await heard("hold 0");
    await person(7).locator("text", { hasText: "Ann · nearest" }).waitFor();
  });

  test("who leaves the seat holds nobody", async () => {
    await takeSeat();
    await clickOn(ann);
    await page.getByRole("button", { name: "Hold", exact: true }).click();
    await heard("hold 7");
    await page.getByRole("button", { name: "Leave the seat" }).click();
    await heard("hold 0");
  });

  test("people are named and held with the keyboard, from a list", async () => {
    await takeSeat();
    const list = page.getByRole("group", { name: "People seen" });
    await list.getByRole("button", { name: "Ann · nearest" }).focus();
    await page.keyboard.press("Enter");
    const name = page.getByLabel("Name:");
    assert.equal(await name.inputValue(), "Ann");
    await name.fill("Anna");
    await page.keyboard.press("Enter");
    await heard("name 7 Anna");
    await list.getByRole("button", { name: "? 8" }).press("Enter");
    await page.keyboard.press("Tab");
    await page.keyboard.press("Tab");
    await page.keyboard.press("Enter");
    await heard("hold 8");
    await list.getByRole("button", { name: "? 8 · held" }).waitFor();
  });

  test("it is accessible in both themes, also narrow", async () => {
    await takeSeat();
    await clickOn(stranger);
    // As from the developer's tools: the page's policy allows no scripts from elsewhere.
    const session = await context.newCDPSession(page);
    await session.send("Runtime.evaluate", { expression: readFileSync(axeFile, "utf8") });
    for (const theme of ["light", "dark"])
      for (const width of [1000, 390]) {
        await page.setViewportSize({ width, height: 720 });
        await page.evaluate((theme) => (document.documentElement.dataset.theme = theme), theme);
        const { violations } = await page.evaluate(() => window.axe.run(document));
        assert.deepEqual(
          violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join("\n  ")}`),
          [],
        );
      }
    await page.setViewportSize({ width: 1000, height: 720 });
  });

  test("who is not seen any more has no box and no button", async () => {
    await takeSeat();
    await setShow("false");
    await person(7).waitFor({ state: "detached" });
    await page.locator(".seen-hand").waitFor({ state: "detached" });
    await page.locator(".seat-people", { hasText: "No face is seen." }).waitFor();
    await setShow("true");
    await person(7).waitFor({ state: "attached" });
  });

  test("a module that finds faces and hangs is late", async () => {
    const seen = graph.pid("seen");
    process.kill(seen, "SIGSTOP");
    try {
      await page
        .locator(".seat-people", { hasText: "seen is late: no faces for some seconds." })
        .waitFor();
    } finally {
      process.kill(seen, "SIGCONT");
    }
    await person(7).waitFor({ state: "attached" });
  });
});
