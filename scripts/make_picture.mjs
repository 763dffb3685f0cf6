// SPDX-License-Identifier: Apache-2.0
// Records the README's moving picture, doc/images/head.webp: the page, as it opens, while the simulated
// head follows the ball. `./dev picture` installs, builds and runs it; with all that is installed and
// built: node scripts/make_picture.mjs
import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { Graph, openBrowser, until, watchdog } from "../tests/page/harness.mjs";

const seconds = 9;
const rate = 8; // images a second
const width = 800; // of the picture [px]
const mostBytes = 2_000_000;
const output = join(dirname(fileURLToPath(import.meta.url)), "../doc/images/head.webp");

/** The page's images, each with the time at which it was drawn [s]. */
async function record(page) {
  const frames = [];
  const session = await page.context().newCDPSession(page);
  session.on("Page.screencastFrame", ({ data, metadata, sessionId }) => {
    frames.push({ data: Buffer.from(data, "base64"), time: metadata.timestamp });
    session.send("Page.screencastFrameAck", { sessionId });
  });
  await session.send("Page.startScreencast", { format: "jpeg", quality: 95 });
  const span = () => frames.length && frames.at(-1).time - frames[0].time;
  await until("the page has been recorded", () => span() > seconds);
  session.removeAllListeners("Page.screencastFrame"); // which would acknowledge to a closed page
  await session.send("Page.stopScreencast");
  return frames;
}

/** Writes them as one file that repeats, and gives its size. */
function write(frames, folder, quality) {
  const list = frames.map(({ data, time }, i) => {
    const file = join(folder, `${i}.jpg`);
    writeFileSync(file, data);
    const end = frames[i + 1]?.time ?? time;
    return `file '${file}'\nduration ${end - time}\n`;
  });
  writeFileSync(join(folder, "list"), list.join(""));
  const options = `-v error -y -f concat -safe 0 -i ${join(folder, "list")} -loop 0`.split(" ");
  const filter = `fps=${rate},scale=${width}:-2:flags=lanczos`;
  const form = `-c:v libwebp_anim -compression_level 6 -quality ${quality}`.split(" ");
  const done = spawnSync("ffmpeg", [...options, "-vf", filter, ...form, output], {
    stdio: "inherit",
  });
  if (done.error || done.status) throw done.error ?? new Error("ffmpeg has failed");
  return statSync(output).size;
}

const folder = mkdtempSync(join(tmpdir(), "hc-picture-"));
const graph = new Graph("head.toml", ["--quiet"], "head");
const browser = await openBrowser();
try {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 } });
  const page = await context.newPage();
  await page.goto(await graph.url());
  await page.locator("canvas").first().waitFor({ timeout: watchdog });
  await until("the head follows the ball", () => graph.state().focus.workspace?.mode === "track");
  const frames = await record(page);
  const quality = [80, 70, 60, 50, 40].find((each) => write(frames, folder, each) < mostBytes);
  if (!quality) throw new Error(`the picture is above ${mostBytes} B`);
  console.log(`${frames.length} images, quality ${quality}, ${statSync(output).size} B: ${output}`);
} finally {
  await browser.close();
  await graph.end();
  rmSync(folder, { recursive: true });
}
