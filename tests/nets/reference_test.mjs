// SPDX-License-Identifier: Apache-2.0
// Every number that our networks compute for 20 pictures, beside those of TensorFlow Lite's own
// interpreter (WebAssembly), and for 5 beside those of face-api, both in Chromium.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { dirname, extname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { openBrowser, watchdog } from "../page/harness.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const build = process.env.HC_BUILD;
const most = 1e-3; // deviation, of an output's range in an image
const tensorflow = join(here, "node_modules/@tensorflow");
const faceApi = join(here, "../../nets/node_modules/@vladmandic/face-api");
const folders = {
  nets: join(build, "share/hypercolumn/nets"),
  core: join(tensorflow, "tfjs-core/dist"),
  cpu: join(tensorflow, "tfjs-backend-cpu/dist"),
  tflite: join(tensorflow, "tfjs-tflite"),
  "face-api": faceApi,
  photographs: join(faceApi, "demo"),
};
const document = `<!doctype html>
<script src="/core/tf-core.min.js"></script>
<script src="/cpu/tf-backend-cpu.min.js"></script>
<script src="/tflite/dist/tf-tflite.min.js"></script>
<script type="module" src="/page.mjs"></script>`;
const types = { ".wasm": "application/wasm", ".json": "application/json", ".bin": "binary" };

const given = {};
const server = createServer(async (request, response) => {
  const [, folder, ...name] = new URL(request.url, "http://a").pathname.split("/");
  if (request.method === "POST") {
    given[folder] = Buffer.concat(await request.toArray());
    response.end();
  } else if (folder === "") {
    response.setHeader("content-type", "text/html").end(document);
  } else {
    const path = name.length > 0 ? join(folders[folder], ...name) : join(here, folder);
    try {
      const data = folder === "wide" ? await widened() : await readFile(path);
      response.setHeader("content-type", types[extname(path)] ?? "text/javascript").end(data);
    } catch {
      response.writeHead(404).end();
    }
  }
});

let browser, page;
before(async () => {
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  browser = await openBrowser({ webgl: false });
  page = await browser.newPage();
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
});
after(async () => {
  await browser?.close();
  server.close();
});

const numbers = (bytes) =>
  new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));

/** face_detection_full_range for images of 192 × 256, and the interpreter infers all other shapes. */
async function widened() {
  const bytes = await readFile(join(folders.nets, "face_detection_full_range.tflite"));
  const file = new Int32Array(bytes.buffer, bytes.byteOffset, bytes.length >> 2);
  const changes = {
    "1 192 192 3": "1 192 256 3", // the image
    "8 12 12": "8 12 16", // sizes of resizes, of 8 bytes
    "8 24 24": "8 24 32",
    "8 48 48": "8 48 64",
    "1 2304 1": "1 3072 1", // results
    "1 2304 16": "1 3072 16",
  };
  for (const [from, to] of Object.entries(changes)) {
    const known = from.split(" ").map(Number);
    const at = [...file.keys()].filter((i) => known.every((number, k) => file[i + k] === number));
    assert.ok(at.length > 0, from);
    for (const i of at) file.set(to.split(" ").map(Number), i);
  }
  return bytes;
}

/** Compares what was given with what our program computes of it. */
function compare(file, sizes, ...size) {
  const run = spawnSync(join(build, "tests/programs/nets_compute"), [file, ...size], {
    input: given.inputs,
    maxBuffer: 1 << 28,
    timeout: watchdog,
  });
  assert.equal(run.status, 0, run.stderr.toString());
  const [ours, theirs] = [numbers(run.stdout), numbers(given.outputs)];
  assert.equal(ours.length, theirs.length);
  assert.ok(ours.every(Number.isFinite));
  const all = sizes.reduce((sum, size) => sum + size);
  let begin = 0;
  for (const [output, size] of sizes.entries()) {
    const images = []; // how far apart they are, and the range of theirs
    for (let from = begin; from < ours.length; from += all) {
      const known = theirs.subarray(from, from + size);
      const differences = known.map((number, i) => Math.abs(number - ours[from + i]));
      images.push({
        off: Math.max(...differences),
        low: Math.min(...known),
        high: Math.max(...known),
      });
    }
    const low = Math.min(...images.map((image) => image.low));
    const high = Math.max(...images.map((image) => image.high));
    // A single number has a range over all images only.
    const shares = images.map(
      (image) => image.off / (size > 1 ? image.high - image.low : high - low),
    );
    const share = Math.max(...shares);
    console.log(
      `${file} output ${output}: ${images.length} × ${size} numbers, ` +
        `${low.toPrecision(4)} … ${high.toPrecision(4)}, off by ${share.toExponential(1)} of the range`,
    );
    assert.ok(share < most, `${file}, output ${output}: ${share}`);
    begin += size;
  }
}

for (const [name, side, least] of [
  ["face_detection_short_range", 128, -1],
  ["face_detection_full_range", 192, -1],
  ["palm_detection_lite", 192, 0],
  ["hand_landmark_lite", 224, 0],
])
  test(name, { timeout: watchdog }, async () => {
    const file = `${name}.tflite`;
    const asked = [`/nets/${file}`, side, side, least];
    compare(file, await page.evaluate((all) => window.computeByTflite(...all), asked));
  });

test("a network that is wider than in its file", { timeout: watchdog }, async () => {
  const asked = ["/wide", 192, 256, -1];
  const sizes = await page.evaluate((all) => window.computeByTflite(...all), asked);
  compare("face_detection_full_range.tflite", sizes, 192, 256);
});

test("face_recognition", { timeout: watchdog }, async () => {
  compare("face_recognition.json", await page.evaluate(() => window.computeByFaceApi()));
});
