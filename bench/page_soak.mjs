// SPDX-License-Identifier: Apache-2.0
// The page open for long under load: node page_soak.mjs [SECONDS]. The simulated head runs, and a
// page shows both eyes, the graph, depth, a plot and the scene. Each minute a row: the page's heap
// after a collection, memory of the browser and of the server; at the end how far these drifted
// since the second minute: in the first both are still starting.
import { Graph, openBrowser } from "../tests/page/harness.mjs";
import { countDrawn, memory, row, wait } from "./page_measure.mjs";

const seconds = Number(process.argv[2] ?? 3600);
const period = 60; // [s]
const starting = 1; // row, not compared
const window = 10; // rows that are compared at the end

const panels =
  "stream,port=head_eyes.left;stream,port=head_eyes.right|graph;stream,port=depth.depth" +
  "|stream,port=left_ball.target,view=plot;scene";

const columns = {
  drawn: "images drawn [1/s]",
  heap: "page's heap [MB]",
  nodes: "its nodes",
  tab: "its process [MB]",
  browser: "all of the browser [MB]",
  server: "server [MB]",
  graph: "hc run [MB]",
};

const graph = new Graph("head.toml", ["--quiet"]);
const browser = await openBrowser();
try {
  const page = await browser.newPage({ viewport: { width: 1200, height: 700 } });
  const url = await graph.url();
  await page.goto(url);
  await page.goto(`${new URL(url).origin}/#${panels}`);
  await page.reload();
  const own = await page.context().newCDPSession(page);
  const all = await browser.newBrowserCDPSession();

  await countDrawn(page);
  let drawnBefore = 0;
  const sample = async () => {
    const drawn = await page.evaluate(() => window.drawn);
    const drawnNow = (drawn - drawnBefore) / period;
    drawnBefore = drawn;
    await own.send("HeapProfiler.collectGarbage");
    const { usedSize } = await own.send("Runtime.getHeapUsage");
    const { nodes } = await own.send("Memory.getDOMCounters");
    const { processInfo } = await all.send("SystemInfo.getProcessInfo");
    const tabs = processInfo.filter(({ type }) => type === "renderer");
    const pid = (name) => graph.module(name).pid;
    return {
      drawn: drawnNow,
      heap: usedSize / 1e6,
      nodes,
      tab: memory(...tabs.map(({ id }) => id)),
      browser: memory(...processInfo.map(({ id }) => id)),
      server: memory(pid("web")),
      graph: memory(graph.process.pid),
    };
  };

  const print = (name, values, text = (value) => value.toFixed(1)) =>
    row(name, ...Object.keys(columns).map((key) => text(values[key])));
  row("minute", ...Object.values(columns));
  console.log("|---:".repeat(1 + Object.keys(columns).length) + "|");
  const samples = [];
  const begin = performance.now();
  for (let next = period; next <= seconds; next += period) {
    await wait(begin + next * 1000 - performance.now());
    samples.push(await sample());
    print(next / period, samples.at(-1));
  }

  const ofEach = (value) =>
    Object.fromEntries(Object.keys(columns).map((key) => [key, value(key)]));
  const mean = (rows) =>
    ofEach((key) => rows.reduce((sum, each) => sum + each[key], 0) / rows.length);
  const first = mean(samples.slice(starting, starting + window));
  const last = mean(samples.slice(-window));
  print(`first ${window}`, first);
  print(`last ${window}`, last);
  const drift = ofEach((key) => 100 * (last[key] / first[key] - 1));
  print("drift [%]", drift, (value) => (value > 0 ? "+" : "") + value.toFixed(1));
} finally {
  await browser.close();
  await graph.end();
}
