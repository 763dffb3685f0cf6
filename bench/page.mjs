// SPDX-License-Identifier: Apache-2.0
// The page on the simulated head: node page.mjs. Rates and ages of both eyes' images, motion to photon
// and its parts, the server's load; then what 20 pages, five of them stopped, cost the head. Minutes.
import { Graph, openBrowser, watchdog } from "../tests/page/harness.mjs";
import { countDrawn, memory, quantile, row, ticks, wait } from "./page_measure.mjs";

const pushes = 20;
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

const graph = new Graph("head.toml", "--set", "head_eyes.ball=absent", "--quiet");
const browser = await openBrowser();
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
  await countDrawn(page);
  await wait(2000);
  const drawnBefore = await page.evaluate(() => window.drawn);
  const eyes = await measure(graph, "head_eyes.left");
  const drawn = (await page.evaluate(() => window.drawn)) - drawnBefore;
  print("both eyes in a page", eyes);

  // Motion to photon: pushes of the stick while the task is to point.
  await page.goto(`${origin}/#seat`);
  await page.reload();
  await page.getByRole("button", { name: "Take the seat" }).click();
  await page.locator('[data-task="point"]').click();
  await page
    .locator(".seat-who", { hasText: "Task in focus: point" })
    .waitFor({ timeout: watchdog });
  await wait(2000);
  await page.locator(".seat").focus();
  for (let i = 0; i < pushes; ++i) {
    const key = i % 2 ? "ArrowLeft" : "ArrowRight";
    await page.keyboard.down(key);
    await wait(250);
    await page.keyboard.up(key);
    await wait(1500);
  }
  const all = await page.evaluate(() => window.hypercolumn.latency.measurements);
  await page.close();

  const others = [];
  for (let i = 0; i < pages; ++i) {
    const one = await context.newPage();
    await one.goto(`${origin}/#stream,port=head_eyes.left;graph`);
    others.push(one);
  }
  await wait(3000);
  // Those that are stopped neither read nor answer.
  for (const one of others.slice(0, stopped)) {
    const session = await context.newCDPSession(one);
    await session.send("Debugger.enable");
    await session.send("Debugger.pause");
  }
  print(`${pages} pages, ${stopped} of them stopped`, await measure(graph, "head_eyes.left"));

  console.log(`\nDrawn in the page: ${(drawn / seconds).toFixed(1)} images/s of both eyes.\n`);
  console.log(
    `| from a push to the first image that shows it, ${all.length} pushes | median [ms] | p99 [ms] |`,
  );
  console.log("|---|---:|---:|");
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
} finally {
  await browser.close();
  await graph.end();
}
