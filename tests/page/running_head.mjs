// SPDX-License-Identifier: Apache-2.0
// The running head and its page in a browser, for the tests of one file.
import { Graph, headsetFile, openBrowser, until, watchdog, watchGaze } from "./harness.mjs";

// Images that take little time; with them it is not calibrated, and drives by these lenses.
const lenses = ["point", "track", "read_gaze"].flatMap((name) => [
  `${name}.focal=120`,
  `${name}.cx=79.5`,
  `${name}.cy=59.5`,
]);
const small = [
  "head_eyes.rate=10",
  "head_eyes.width=160",
  "head_eyes.height=120",
  "head_eyes.focal=120",
  "rectify.focal=120",
  "calibrate.salience=0",
  "left_ball.min_area=3",
  "right_ball.min_area=3",
  ...lenses,
];

export let graph, browser, context, page, origin;

export async function startHead() {
  graph = new Graph(
    "head.toml",
    small.flatMap((each) => ["--set", each]),
  );
  browser = await openBrowser();
  context = await browser.newContext({ viewport: { width: 1000, height: 720 } });
  context.setDefaultTimeout(watchdog);
  await context.addInitScript({ path: headsetFile });
  await context.addInitScript(() => {
    window.headset = new IWER.XRDevice(IWER.metaQuest3);
    window.headset.installRuntime({ forceInstall: true });
  });
  page = await context.newPage();
  const url = await graph.url();
  origin = new URL(url).origin;
  await page.goto(url);
}

export async function endHead() {
  await browser?.close();
  await graph?.end();
}

/** Shows panels: what follows # in the URL. */
export async function show(panels) {
  await page.goto(`${origin}/#${panels}`);
  await page.reload();
}

export const gaze = () => page.evaluate(() => window.gaze);

/** Waits until the head has turned from where it is by more than 3 degrees in a direction. */
export async function turned(axis, sign, from, timeout = watchdog) {
  await page.waitForFunction(
    ([axis, sign, from]) => sign * (window.gaze[axis] - from) > 0.05,
    [axis, sign, from],
    { timeout },
  );
}

export async function inFocus(task, timeout = watchdog) {
  await page.locator(".bar .focus", { hasText: task }).waitFor({ timeout });
}

/** Does again what counts once and not for long, as on a busy machine it may have come too late. */
export function untilDone(what, act, ...results) {
  return until(what, async () => {
    await act();
    const all = Promise.all(results.map((result) => result(3_000)));
    return all.then(
      () => true,
      () => false,
    );
  });
}

export async function takeSeat(panels = "seat") {
  await show(panels);
  await page.getByRole("button", { name: "Take the seat" }).click();
  await page.locator(".seat-who", { hasText: "You hold the head (point)." }).waitFor();
  await watchGaze(page);
}
