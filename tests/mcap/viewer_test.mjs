// SPDX-License-Identifier: Apache-2.0
// A recording of the head in Rerun's viewer, in Chromium: its images, its depth, and in 3D the camera
// at its frame are on the screen. HC_SHOT=FILE keeps the picture. Runs with HC_FULL=1 alone: which
// views the viewer makes depends on what it has read when it chooses them.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { open, readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader } from "@mcap/core";
import { FileHandleReadable } from "@mcap/nodejs";
import { loadDecompressHandlers } from "@mcap/support";

const here = dirname(fileURLToPath(import.meta.url));
const { chromium } = createRequire(join(here, "../../page/package.json"))("playwright-core");
const viewer = join(here, "node_modules/@rerun-io/web-viewer");
const folder = mkdtempSync(join(tmpdir(), "hc-viewer-"));
const file = join(folder, "head.mcap");
const isFull = process.env.HC_FULL === "1";
const watchdog = 240_000; // [ms]
const patience = 60_000; // after which the viewer is opened again, which makes its views again [ms]
const screen = { width: 800, height: 600 };
const grid = { columns: 16, rows: 12 }; // in which images are compared

const graph = `version = 1
[graphs.head]
file = "simulated_head.toml"
modules.eyes.parameters = { ball = "roll", count = 30, width = 400, height = 300, focal = 300 }
[modules.rectify]
parameters.focal = 300
inputs = { left = "head_eyes.left", right = "head_eyes.right" }
[modules.depth]
parameters.disparities = 32
inputs = { left = "rectify.left", right = "rectify.right", intrinsics = "rectify.intrinsics" }
[modules.view]
parameters = { save = "depth.png", stay = false }
inputs.image = "depth.depth"
`;

const page = `<!doctype html><body style="margin:0"><script type="module">
import { WebViewer } from "/index.js";
const viewer = new WebViewer();
viewer.on("recording_open", ({ recording_id }) => {
  for (const panel of ["top", "blueprint", "selection", "time"])
    viewer.override_panel_state(panel, "hidden");
  const timeline = "message_log_time";
  window.showEnd = (end) => {
    const read = viewer.get_time_range(recording_id, timeline);
    if (!read || read.max < end) return false;
    viewer.set_active_timeline(recording_id, timeline);
    viewer.set_playing(recording_id, false);
    viewer.set_current_time(recording_id, timeline, read.max);
    return true;
  };
});
await viewer.start(location.origin + "/head.mcap", document.body, {
  width: "${screen.width}px", height: "${screen.height}px",
  hide_welcome_screen: true, render_backend: "webgl", theme: "light",
});
</script>`;

/** Serves the page, the viewer's own files and the recording. */
const server = createServer(async ({ url }, response) => {
  const name = url.split("?")[0].slice(1);
  const files = { "head.mcap": file, re_viewer: join(viewer, "re_viewer.js") };
  const types = { wasm: "application/wasm", mcap: "application/octet-stream" };
  try {
    const data = name === "" ? page : await readFile(files[name] ?? join(viewer, name));
    const type = name === "" ? "text/html" : (types[name.split(".")[1]] ?? "text/javascript");
    response.setHeader("content-type", type);
    response.setHeader("content-length", data.length);
    response.end(data);
  } catch {
    response.statusCode = 404;
    response.end();
  }
});

let browser;
before(async () => {
  if (!isFull) return;
  writeFileSync(join(folder, "graph.toml"), graph);
  const hc = join(process.env.HC_BUILD, "bin/hc");
  const run = spawnSync(hc, ["run", "graph.toml", "--record", file, "--quiet"], {
    cwd: folder,
    encoding: "utf8",
    timeout: watchdog,
  });
  assert.equal(run.status, 0, run.stderr);
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  browser = await chromium.launch({
    executablePath: "/usr/bin/chromium",
    // WebGL by software; no sandbox, since tests may run as root.
    args: [
      "--no-sandbox",
      "--use-gl=angle",
      "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader",
    ],
  });
});
after(async () => {
  await browser?.close();
  server.close();
  rmSync(folder, { recursive: true, force: true });
});

/** The last message of each topic of images, decoded by its schema, and when the last of all came. */
async function lastImages() {
  const handle = await open(file);
  const last = new Map();
  let end = 0n;
  const reader = await McapIndexedReader.Initialize({
    readable: new FileHandleReadable(handle),
    decompressHandlers: await loadDecompressHandlers(),
  });
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    if (schema.name !== "sensor_msgs/msg/Image") continue;
    const text = new TextDecoder().decode(schema.data);
    last.set(
      channel.topic,
      new MessageReader(parse(text, { ros2: true })).readMessage(message.data),
    );
    end = message.logTime;
  }
  await handle.close();
  return { images: last, end };
}

/** Means of what `value` gives for the pixels of each cell of the grid. */
function cellsOf({ width, height }, value) {
  const sums = Array.from({ length: grid.columns * grid.rows }, () => ({ sum: 0, count: 0 }));
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const row = Math.floor((y * grid.rows) / height);
      const cell = sums[row * grid.columns + Math.floor((x * grid.columns) / width)];
      const each = value(y * width + x);
      if (!Number.isFinite(each)) continue;
      cell.sum += each;
      cell.count += 1;
    }
  return sums.map(({ sum, count }) => sum / count);
}

/** What a picture of the screen has in rectangles, each scaled to a grid: [r, g, b, a, …] for each. */
function sample(decoder, picture, rectangles, { columns, rows }) {
  return decoder.evaluate(
    async ({ data, rectangles, columns, rows }) => {
      const bytes = await (await fetch("data:image/png;base64," + data)).blob();
      const image = await createImageBitmap(bytes);
      return rectangles.map(({ x, y, width, height }) => {
        const context = new OffscreenCanvas(columns, rows).getContext("2d");
        context.imageSmoothingQuality = "high";
        context.drawImage(image, x, y, width, height, 0, 0, columns, rows);
        return [...context.getImageData(0, 0, columns, rows).data];
      });
    },
    { data: picture.toString("base64"), rectangles, columns, rows },
  );
}

/** Where the views may be: in three rows of three or four, each below its title. */
const views = [3, 4].flatMap((columns) =>
  Array.from({ length: 3 * columns }, (_, i) => {
    const width = screen.width / columns;
    const height = screen.height / 3 - 25;
    return {
      x: (i % columns) * width,
      y: Math.floor(i / columns) * (height + 25) + 25,
      width,
      height,
    };
  }),
);

/** Where a view in 2D shows an image of 4 : 3: in its middle, as large as it can. */
function shownAt({ x, y, width, height }) {
  const scale = Math.min(width / 4, height / 3);
  const [w, h] = [4 * scale, 3 * scale];
  return { x: x + (width - w) / 2, y: y + (height - h) / 2, width: w, height: h };
}

const mean = (values) => values.reduce((sum, each) => sum + each, 0) / values.length;
const variance = (values) => mean(values.map((each) => (each - mean(values)) ** 2));

/** Whether a view shows an image: the colours of each cell are those that were recorded. */
function shows(seen, cells) {
  const differences = cells.flatMap((each, k) =>
    each.map((value, i) => Math.abs(value - seen[4 * i + k])),
  );
  return mean(differences) < 10;
}

/** How much of the variance of the colours a depth explains, whose colour scale is not known here. */
function explained(seen, depths) {
  const known = depths
    .map((depth, i) => ({ depth, i }))
    .filter(({ depth }) => Number.isFinite(depth));
  known.sort((a, b) => a.depth - b.depth);
  const size = Math.ceil(known.length / 12);
  let within = 0;
  let all = 0;
  for (let k = 0; k < 3; ++k) {
    const colours = known.map(({ i }) => seen[4 * i + k]);
    all += variance(colours) * colours.length;
    for (let begin = 0; begin < colours.length; begin += size) {
      const alike = colours.slice(begin, begin + size);
      within += variance(alike) * alike.length;
    }
  }
  return all / known.length < 300 ? 0 : 1 - within / all;
}

/** The part of a 3D view that something covers: darker than its sky and floor; 0 of other views. */
function covered(seen) {
  const pixels = Array.from({ length: seen.length / 4 }, (_, i) => seen.slice(4 * i, 4 * i + 3));
  const [r, g, b] = pixels.at(-1); // the floor
  if (r - b < 12 || g < 190) return 0;
  return pixels.filter((pixel) => mean(pixel) < 130).length / pixels.length;
}

/** Opens the viewer, and waits until it has read the recording up to a time. */
async function openViewer(end) {
  const page = await browser.newPage({ viewport: screen });
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  await page.waitForFunction((time) => window.showEnd?.(time), end, { timeout: watchdog });
  return page;
}

const skip = isFull ? false : "runs with HC_FULL=1";
const limits = { skip, timeout: 3 * watchdog };
test("Rerun shows the images, the depth and the frames of the head", limits, async () => {
  const { images, end } = await lastImages();
  const colours = [..."012"].map(Number);
  const wanted = new Map(
    ["/head_eyes/left", "/head_eyes/right", "/rectify/left", "/rectify/right"].map((topic) => {
      const image = images.get(topic);
      assert.equal(image.encoding, "rgb8");
      return [topic, colours.map((k) => cellsOf(image, (i) => image.data[3 * i + k]))];
    }),
  );
  const depth = images.get("/depth/depth");
  assert.equal(depth.encoding, "32FC1");
  const metres = new Float32Array(depth.data.slice().buffer);
  const depths = cellsOf(depth, (i) => (metres[i] > 0 ? metres[i] : NaN));
  const decoder = await browser.newPage();

  /** What the viewer does not show. */
  async function missingOn(page) {
    const picture = await page.screenshot();
    if (process.env.HC_SHOT) writeFileSync(process.env.HC_SHOT, picture);
    const seen = await sample(decoder, picture, views.map(shownAt), grid);
    const inside = await sample(decoder, picture, views, { columns: 80, rows: 60 });
    const missing = [...wanted].filter(([, cells]) => !seen.some((view) => shows(view, cells)));
    const names = missing.map(([topic]) => topic);
    const best = Math.max(...seen.map((view) => explained(view, depths)));
    if (best < 0.6) names.push(`/depth/depth (${best})`);
    const cover = Math.max(...inside.map(covered));
    if (cover < 0.02) names.push(`the camera in 3D (${cover})`);
    return names;
  }

  const lastSeen = Number(end) - 1000; // [ns]; the viewer's numbers are less exact
  const latest = performance.now() + watchdog;
  let missing = ["all"];
  while (missing.length > 0) {
    assert.ok(performance.now() < latest, `not shown: ${missing.join(", ")}`);
    const page = await openViewer(lastSeen);
    const given = performance.now() + patience;
    while (missing.length > 0 && performance.now() < given) {
      await page.evaluate((time) => window.showEnd(time), lastSeen);
      missing = await missingOn(page);
    }
    await page.close();
  }
});
