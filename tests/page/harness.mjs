// SPDX-License-Identifier: Apache-2.0
// What the tests of the page share: a running graph, one browser, and events to wait for.
import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const root = join(here, "../..");
const packages = createRequire(join(root, "page/package.json"));
const { chromium } = packages("playwright-core");

export const axeFile = packages.resolve("axe-core/axe.min.js");
export const headsetFile = join(
  dirname(packages.resolve("iwer/package.json")),
  "build/iwer.min.js",
);

/** After so long a program or a page hangs [ms]. */
export const watchdog = 60_000;

const build = process.env.HC_BUILD ?? join(root, "build");
const hc = join(build, "bin/hc");

/** Waits for an event that gives no notice; gives what the condition gave. */
export async function until(what, condition, timeout = watchdog) {
  const end = performance.now() + timeout;
  for (;;) {
    const result = await condition();
    if (result) return result;
    if (performance.now() > end) throw new Error(`it did not happen: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
}

/** The first that is tried: a restarted server has the same one again. */
const port = 20000 + (process.pid % 10000);

/** A graph that runs in a folder of its own, with its page. */
export class Graph {
  folder = mkdtempSync(join(tmpdir(), "hc-page-"));
  log = "";

  /** @param name  shown in the page; a test that runs beside others needs one of its own. */
  constructor(file, options = [], name = `page-${process.pid}`) {
    this.name = name;
    const programs = join(build, "tests/programs"); // those of tests
    this.process = spawn(
      hc,
      [
        "run",
        join(root, "graphs", file),
        "--as",
        this.name,
        "--set",
        `web.port=${port}`,
        ...options,
      ],
      {
        cwd: this.folder,
        env: { ...process.env, PATH: `${programs}:${process.env.PATH}` },
        stdio: ["ignore", "pipe", "pipe"],
      },
    );
    const take = (data) => (this.log += data);
    this.process.stdout.on("data", take);
    this.process.stderr.on("data", take);
    process.once("exit", (code) => {
      if (code !== 0) console.error(`the log of ${file}:\n${this.log}`);
    });
  }

  /** A URL with a token that has not been used. */
  url() {
    return until("the graph prints its URL", () => {
      if (this.process.exitCode !== null) throw new Error(`the graph has ended:\n${this.log}`);
      return this.log.match(/https?:\/\/\S+token=\w+/g)?.at(-1);
    });
  }

  /** Its state as `hc top` sees it. */
  state() {
    const { stdout } = spawnSync(hc, ["top", "--json", "--once", "--of", this.name], {
      encoding: "utf8",
      timeout: watchdog,
    });
    return JSON.parse(stdout.split("\n")[0]);
  }

  module(name) {
    return this.state().modules.find((module) => module.name === name);
  }

  /** The process of a module. During a restart it is 0, which a signal takes for our own group. */
  pid(name) {
    const { pid } = this.module(name);
    if (!pid) throw new Error(`${name} has no process`);
    return pid;
  }

  async end() {
    if (this.process.exitCode === null) {
      const ended = new Promise((resolve) => this.process.once("exit", resolve));
      this.process.kill("SIGTERM");
      await ended;
    }
    rmSync(this.folder, { recursive: true, force: true });
  }
}

/** Debian's Chromium. WebGL is drawn by software, which costs much time. */
export function openBrowser({ webgl = true } = {}) {
  const drawing = webgl
    ? ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
    : ["--disable-gpu"];
  return chromium.launch({
    executablePath: "/usr/bin/chromium",
    args: ["--no-sandbox", ...drawing], // tests may run as root
  });
}

/**
 * Reads the neck's pose in the page, as any other client may: window.gaze is then the head's pan
 * and tilt [rad].
 */
export async function watchGaze(page) {
  await page.evaluate(() => {
    const socket = new WebSocket(`ws://${location.host}/streams/head_neck.pose?rate=50`);
    socket.binaryType = "arraybuffer";
    socket.onmessage = ({ data }) => {
      if (typeof data === "string") return;
      const bytes = new Uint8Array(data);
      const end = bytes.indexOf(10);
      const fields = new TextDecoder().decode(bytes.subarray(0, end)).trim().split(/ +/);
      const body = bytes.slice(end + 1, -1);
      const isText = fields[6].endsWith("0");
      const m = isText
        ? new TextDecoder().decode(body).trim().split(/\s+/).map(Number)
        : new Float64Array(body.buffer);
      window.gaze = { pan: Math.atan2(m[4], m[0]), tilt: Math.asin(-m[8]) };
      socket.send("ok");
    };
  });
  await page.waitForFunction(() => window.gaze, null, { timeout: watchdog });
}
