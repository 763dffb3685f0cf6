// SPDX-License-Identifier: Apache-2.0
// The page on the simulated head: node page.mjs. Rates and ages of both eyes' images, motion to photon
// and its parts from a push of the stick and from a turn of a person's head, how soon a killed module
// is red, the server's load; then what 20 pages, five of them stopped, cost the head. Minutes.
import { Graph, openBrowser, watchdog } from "../tests/page/harness.mjs";
import { countDrawn, memory, quantile, row, ticks, wait } from "./page_measure.mjs";

const moves = 20;
const pages = 20;
const stopped = 5;
const seconds = 10;

/** Messages a second of an output over some seconds, and the share of a processor of `web`. */
async function measure(graph, link) {
  const count = () => {
    const state = graph.state();
    return [state.links.find(({ from }) => from === link).messages, state.uptime];
  };
  const pid = graph.module("web").pid;
  const [messages, uptime] = count();
  const begin = ticks(pid);
  await wait(seconds * 1000);
  const [later, end] = count();
  return {
    rate: (later - messages) / (end - uptime),
    load: (ticks(pid) - begin) / (end - uptime),
    memory: memory(pid),
  };
}

/** The same of the left eye, and the images a second that a page draws. */
async function measureDrawn(page, graph) {
  await wait(2000);
  await countDrawn(page);
  const begin = performance.now();
  const measured = await measure(graph, "head_eyes.left");
  const drawn = await page.evaluate(() => window.drawn);
  return { ...measured, drawn: (1000 * drawn) / (performance.now() - begin) };
}

/** Waits until a task has the focus. */
const inFocus = (page, task) =>
  page.locator(".bar .focus", { hasText: task }).waitFor({ timeout: watchdog });

const graph = new Graph("head.toml", ["--set", "head_eyes.ball=absent", "--quiet"]);
const browser = await openBrowser({ webgl: false });
try {
  const url = await graph.url();
  const origin = new URL(url).origin;
  await wait(8000); // the head calibrates itself
  const idle = await measure(graph, "head_eyes.left");
  const context = await browser.newContext({ viewport: { width: 1000, height: 700 } });
  const page = await context.newPage();
  await page.goto(url);

  console.log("| | pairs/s of the head | server [% of a core] | server [MB] |");
  console.log("|---|---:|---:|---:|");
  const print = (name, { rate, load, memory }) =>
    row(name, rate.toFixed(1), load.toFixed(0), memory.toFixed(0));
  print("no page", idle);

  // Both eyes at full size, as any client sees them: decoded in the page.
  await page.goto(`${origin}/#stream,port=head_eyes.left|stream,port=head_eyes.right`);
  await page.reload();
  const eyes = await measureDrawn(page, graph);
  print("both eyes in a page", eyes);

  // The same in the seat, both eyes beside one another.
  await page.setViewportSize({ width: 1700, height: 1000 });
  await page.goto(`${origin}/#seat`);
  await page.reload();
  const way = page.getByLabel("How the eyes are shown");
  await way.selectOption("side by side");
  const seat = await measureDrawn(page, graph);
  print("both eyes in the seat", seat);
  await page.setViewportSize({ width: 1000, height: 700 });
  await way.selectOption("left");

  // Motion to photon: pushes of the stick while the task is to point, then turns of a person's head.
  await page.getByRole("button", { name: "Take the seat" }).click(); // which chooses to point
  await inFocus(page, "point");
  await wait(2000);
  await page.locator(".seat").focus();
  const measurements = () => page.evaluate(() => window.hypercolumn.latency.measurements);
  for (let i = 0; i < moves; ++i) {
    const key = i % 2 ? "ArrowLeft" : "ArrowRight";
    await page.keyboard.down(key);
    await wait(250);
    await page.keyboard.up(key);
    await wait(1500);
  }
  const pushed = await measurements();
  await page.locator('[data-task="point"]').click(); // which releases it
  const phone = await context.newCDPSession(page);
  const turn = (alpha) =>
    phone.send("DeviceOrientation.setDeviceOrientationOverride", { alpha, beta: 90, gamma: 0 });
  await turn(0);
  await page.getByRole("button", { name: "Turn with this phone" }).click();
  await inFocus(page, "telepresence");
  await wait(3000);
  await page.evaluate(() => (window.hypercolumn.latency.measurements.length = 0));
  for (let i = 0; i < moves; ++i) {
    await turn(i % 2 ? 0 : 15);
    await wait(1750);
  }
  const turned = await measurements();

  // From the end of a module's process until the page has it in red.
  await page.goto(`${origin}/#graph,show=drawing`);
  await page.reload();
  const reds = [];
  for (const name of ["left_ball", "right_ball", "view_left", "view_depth", "view_augmented"]) {
    // Several are in one box, which stays red for a while.
    const node = page.locator(`[data-members~="${name}"]:not(.broken)`);
    await node.waitFor({ timeout: watchdog });
    await node.evaluate((element) => {
      new MutationObserver(() => {
        if (element.classList.contains("broken")) window.red ??= Date.now();
      }).observe(element, { attributes: true });
      window.red = undefined;
    });
    const pid = graph.pid(name);
    const killed = Date.now();
    process.kill(pid, "SIGKILL");
    const red = await page.waitForFunction(() => window.red, null, { timeout: watchdog });
    reds.push((await red.jsonValue()) - killed);
  }
  await page.close();

  // Of pages on other machines the head's has the connections, and not the drawing.
  const others = await context.newPage();
  await others.goto(`${origin}/#graph,show=tables`);
  await others.evaluate(
    ([pages, stopped]) => {
      window.received = 0;
      const open = (path, isStopped) => {
        const socket = new WebSocket(location.origin.replace("http", "ws") + path);
        socket.onmessage = ({ data }) => {
          if (isStopped || typeof data === "string") return; // who is stopped answers nothing
          window.received += path.startsWith("/streams");
          if (path.startsWith("/streams")) socket.send("ok");
        };
      };
      for (let i = 0; i < pages; ++i) {
        open("/graph", i < stopped);
        open("/streams/head_eyes.left?as=vp8&width=480", i < stopped);
        open("/streams/head_eyes.right?as=vp8&width=480", i < stopped);
      }
    },
    [pages, stopped],
  );
  await wait(3000);
  const before = await others.evaluate(() => window.received);
  const crowd = await measure(graph, "head_eyes.left");
  const received = (await others.evaluate(() => window.received)) - before;
  print(`${pages} pages, ${stopped} of them stopped`, crowd);

  console.log(
    `\nDrawn of both eyes: ${eyes.drawn.toFixed(1)} images/s in a page, ` +
      `${seat.drawn.toFixed(1)} in the seat; the ${pages - stopped} others get ` +
      `${(received / seconds / (pages - stopped)).toFixed(1)} each.\n`,
  );
  for (const [what, all] of [
    ["push of the stick", pushed],
    ["turn of a head", turned],
  ]) {
    const caption = `from a ${what} to the first image that shows it, ${all.length} of ${moves}`;
    console.log(`| ${caption} | median [ms] | p99 [ms] |\n|---|---:|---:|`);
    for (const [key, name] of [
      ["sensed", "until the image is taken"],
      ["arrived", "rendered, encoded, sent"],
      ["decoded", "decoded"],
      ["drawn", "drawn"],
      ["total", "in all"],
    ]) {
      const values = all.map((each) => each[key]);
      row(name, quantile(values, 0.5)?.toFixed(0), quantile(values, 0.99)?.toFixed(0));
    }
    console.log();
  }
  const red = [quantile(reds, 0.5), Math.max(...reds)].map((value) => value.toFixed(0));
  console.log(`A killed module is red after ${red[0]} ms (median), ${red[1]} ms at most.`);
} finally {
  await browser.close();
  await graph.end();
}
