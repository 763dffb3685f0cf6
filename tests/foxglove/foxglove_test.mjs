// SPDX-License-Identifier: Apache-2.0
// The module foxglove against Foxglove's own client library and its decoders of messages.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { get } from "node:http";
import { createRequire } from "node:module";
import { connect } from "node:net";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const root = join(here, "../..");
const packages = createRequire(join(root, "tests/mcap/package.json"));
const { FoxgloveClient } = packages("@foxglove/ws-protocol");
const { parse } = packages("@foxglove/rosmsg");
const { MessageReader } = packages("@foxglove/rosmsg2-serialization");
const WebSocket = packages("ws");

const build = process.env.HC_BUILD ?? join(root, "build");
const watchdog = 60_000; // [ms]
const protocols = ["foxglove.sdk.v1", "foxglove.websocket.v1"];

const folder = mkdtempSync(join(tmpdir(), "hc-foxglove-"));
let graph, log = "", driver, viewer;

/** Waits for an event that gives no notice; gives what the condition gave. */
async function until(what, condition) {
  const end = performance.now() + watchdog;
  for (;;) {
    const result = await condition();
    if (result) return result;
    assert.ok(performance.now() < end, `it did not happen: ${what}\n${log}`);
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
}

before(async () => {
  graph = spawn(
    join(build, "bin/hc"),
    ["run", join(here, "known.toml"), "--as", `foxglove-${process.pid}`, "--set", "foxglove.port=0"],
    {
      cwd: folder,
      env: { ...process.env, PATH: `${join(build, "tests/programs")}:${process.env.PATH}` },
      stdio: ["ignore", "ignore", "pipe"],
    },
  );
  graph.stderr.on("data", (data) => (log += data));
  driver = await until("the URL", () => log.match(/foxglove: (ws:\/\/\S+)/)?.[1]);
  viewer = await until("the second URL", () => log.match(/view only: (ws:\/\/\S+)/)?.[1]);
});

after(async () => {
  const ended = new Promise((resolve) => graph.on("exit", resolve));
  graph.kill("SIGTERM");
  await ended;
  rmSync(folder, { recursive: true });
});

/** A viewer, with what it was sent. */
class Client {
  channels = new Map(); // by topic
  messages = new Map(); // by topic, decoded
  statuses = [];
  graphs = [];
  parameters = [];
  times = 0;

  constructor(url = driver, protocol = protocols[0]) {
    this.socket = new WebSocket(url, [protocol]);
    this.client = new FoxgloveClient({ ws: this.socket });
    this.ready = new Promise((resolve, reject) => {
      this.client.on("serverInfo", (info) => resolve((this.info = info)));
      this.client.on("error", reject);
    });
    this.closed = new Promise((resolve) => this.client.on("close", resolve));
    this.client.on("advertise", (channels) => {
      for (const channel of channels) this.channels.set(channel.topic, channel);
    });
    this.client.on("unadvertise", (ids) => {
      for (const [topic, channel] of this.channels)
        if (ids.includes(channel.id)) this.channels.delete(topic);
    });
    this.client.on("status", (status) => this.statuses.push(status));
    this.client.on("connectionGraphUpdate", (update) => this.graphs.push(update));
    this.client.on("parameterValues", (values) => this.parameters.push(values));
    this.client.on("time", () => (this.times += 1));
    this.readers = new Map();
    this.client.on("message", ({ subscriptionId, timestamp, data }) => {
      const { topic, reader } = this.readers.get(subscriptionId);
      const message = reader ? reader.readMessage(data) : data;
      this.messages.get(topic).push({ timestamp, message });
    });
  }

  async subscribe(topic, decode = true) {
    await this.ready;
    const channel = await until(topic, () => this.channels.get(topic));
    const reader = decode && new MessageReader(parse(channel.schema, { ros2: true }));
    this.messages.set(topic, []);
    const id = this.client.subscribe(channel.id);
    this.readers.set(id, { topic, reader });
    return id;
  }

  /** The next message of a topic. */
  async next(topic) {
    const messages = this.messages.get(topic);
    const count = messages.length;
    return until(`a message of ${topic}`, () => messages[count]);
  }

  close() {
    this.client.close();
    return this.closed;
  }
}

/** The status of an answer to a handshake. */
const refusal = (url, options = {}, offered = [protocols[0]]) =>
  new Promise((resolve) => {
    const socket = new WebSocket(url, offered, options);
    socket.on("unexpected-response", (_, response) => {
      let text = "";
      response.on("data", (data) => (text += data));
      response.on("end", () => resolve({ status: response.statusCode, text }));
    });
    socket.on("error", () => {});
    socket.on("open", () => resolve({ status: 101, protocol: socket.protocol }) ?? socket.close());
  });

test("both names of the protocol are spoken, the newer where both are offered", async () => {
  for (const protocol of protocols)
    assert.deepEqual(await refusal(driver, {}, [protocol]), { status: 101, protocol });
  const both = await refusal(driver, {}, [...protocols].reverse());
  assert.equal(both.protocol, protocols[0]);
  const neither = await refusal(driver, {}, ["foxglove.websocket.v9"]);
  assert.equal(neither.status, 400);
  assert.match(neither.text, /speaks foxglove\.sdk\.v1/);
});

test("who has no token, or another host, is refused", async () => {
  assert.equal((await refusal(driver.replace(/=.*/, "=wrong"))).status, 401);
  assert.equal((await refusal(driver.replace(/\?.*/, ""))).status, 401);
  assert.equal((await refusal(driver, { headers: { Host: "evil.example" } })).status, 421);
  assert.equal((await refusal(driver.replace("/?", "/other?"))).status, 404);
  const plain = await new Promise((resolve) =>
    get(driver.replace("ws:", "http:"), (response) => {
      response.resume();
      resolve(response.statusCode);
    }),
  );
  assert.equal(plain, 426);
});

for (const protocol of protocols)
  test(`each stream arrives as what it is (${protocol})`, async () => {
    const client = new Client(viewer, protocol);
    const info = await client.ready;
    assert.ok(info.name.startsWith("Hypercolumn: foxglove-"));
    assert.deepEqual(info.capabilities.sort(), [
      "connectionGraph",
      "parameters",
      "parametersSubscribe",
      "time",
    ]);
    for (const name of ["image", "depth", "number", "grid", "text", "sound"])
      await client.subscribe(`/known/${name}`);
    await client.subscribe("/tf");

    const image = (await client.next("/known/image")).message;
    assert.deepEqual([image.width, image.height, image.encoding], [160, 120, "rgb8"]);
    const pixel = (x, y) => [...image.data.subarray(3 * (160 * y + x), 3 * (160 * y + x) + 3)];
    assert.deepEqual(pixel(40, 30), [200, 40, 30]);
    assert.deepEqual(pixel(120, 90), [128, 128, 128]);

    const depth = (await client.next("/known/depth")).message;
    assert.equal(depth.encoding, "32FC1");
    const metres = new DataView(depth.data.buffer, depth.data.byteOffset);
    assert.equal(metres.getFloat32(0, true), 1.5);
    assert.equal(metres.getFloat32(4 * 120, true), 3.5);

    assert.deepEqual([...(await client.next("/known/number")).message.data], [42.5]);
    const grid = (await client.next("/known/grid")).message;
    assert.deepEqual([...grid.data], [1, 2, 3, 4, 5, 6]);
    assert.equal((await client.next("/known/text")).message.data, "red green blue grey");
    const sound = (await client.next("/known/sound")).message;
    assert.deepEqual([sound.format, sound.sample_rate, sound.number_of_channels], ["pcm-s16", 16000, 2]);

    const { timestamp } = await client.next("/known/image");
    const age = BigInt(Date.now()) * 1_000_000n - timestamp;
    assert.ok(age > -1_000_000_000n && age < 60_000_000_000n, `${age}`);

    const { transforms } = (await client.next("/tf")).message;
    assert.deepEqual(
      [transforms[0].header.frame_id, transforms[0].child_frame_id, transforms[0].transform.translation.z],
      ["robot", "head", 1.2],
    );
    await until("the time", () => client.times > 2);
    await client.close();
  });

test("the log is a topic", async () => {
  const client = new Client(driver);
  await client.subscribe("/log");
  client.client.setParameters([{ name: "blob.hue", value: 0.25 }], "set");
  client.client.setParameters([{ name: "blob.hue", value: 7 }], "wrong");
  await until("the error", () => client.statuses.some(({ message }) => /hue/.test(message)));
  const child = await until("its process", () => log.match(/blob/) && processOf("blob"));
  process.kill(child, "SIGKILL");
  const line = await until("its end in the log", () =>
    client.messages.get("/log").find(({ message }) => /killed by signal 9/.test(message.msg)),
  );
  assert.equal(line.message.name, "blob");
  await client.close();
});

/** The process of a module of the graph. */
function processOf(name) {
  for (const pid of readdirSync("/proc").filter((each) => /^\d+$/.test(each))) {
    try {
      const command = readFileSync(`/proc/${pid}/cmdline`, "utf8").split("\0");
      const status = readFileSync(`/proc/${pid}/environ`, "utf8");
      const ours = status.includes(`HC_GRAPH=foxglove-${process.pid}.`);
      if (ours && command.includes("--name") && command[command.indexOf("--name") + 1] === name)
        return Number(pid);
    } catch {
      // it has ended meanwhile
    }
  }
  return 0;
}

test("parameters go both ways, and only for who may operate", async () => {
  const client = new Client(driver), other = new Client(viewer);
  await Promise.all([client.ready, other.ready]);
  await until("the blob", () => client.channels.has("/blob/target") && other.channels.has("/blob/target"));
  client.client.getParameters(["blob.min_area", "blob.none"], "get");
  const got = await until("values", () => client.parameters.find(({ id }) => id === "get"));
  assert.deepEqual(got.parameters, [{ name: "blob.min_area", value: 60, type: "float64" }]);

  other.client.subscribeParameterUpdates(["blob.min_area"]);
  client.client.setParameters([{ name: "blob.min_area", value: 75 }], "set");
  const set = await until("the update", () => other.parameters.find(({ id }) => id === undefined));
  assert.deepEqual(set.parameters, [{ name: "blob.min_area", value: 75, type: "float64" }]);

  other.client.setParameters([{ name: "blob.min_area", value: 1 }], "no");
  await until("the refusal", () => other.statuses.some(({ message }) => /view only/.test(message)));
  client.client.setParameters([{ name: "blob.min_area", value: -1 }], "wrong");
  await until("why", () => client.statuses.some(({ message }) => /min_area.*not/.test(message)));
  client.client.getParameters(["blob.min_area"], "again");
  const kept = await until("values", () => client.parameters.find(({ id }) => id === "again"));
  assert.equal(kept.parameters[0].value, 75);
  // The answer has the new value, and of what there is not nothing.
  client.client.setParameters([{ name: "blob.min_area", value: 80 }, { name: "a.b", value: 1 }], "now");
  const now = await until("the answer", () => client.parameters.find(({ id }) => id === "now"));
  assert.deepEqual(now.parameters, [{ name: "blob.min_area", value: 80, type: "float64" }]);
  await Promise.all([client.close(), other.close()]);
});

test("the graph of modules is the connection graph", async () => {
  const client = new Client(viewer);
  await client.ready;
  client.client.subscribeConnectionGraph();
  const update = await until("it", () =>
    client.graphs.find(({ subscribedTopics }) => subscribedTopics.length > 1),
  );
  const of = (list, topic) => list.find(({ name }) => name === topic);
  assert.deepEqual(of(update.publishedTopics, "/known/image").publisherIds, ["known"]);
  assert.deepEqual(of(update.subscribedTopics, "/known/image").subscriberIds, ["blob"]);
  await client.close();
});

test("of ten viewers five that stop reading hold up nobody", async () => {
  const memory = () =>
    Number(readFileSync(`/proc/${processOf("foxglove")}/status`, "utf8").match(/VmRSS:\s+(\d+)/)[1]);
  const slow = [], quick = [];
  for (let i = 0; i < 5; ++i) {
    slow.push(new Client(viewer));
    quick.push(new Client(viewer));
  }
  for (const client of slow) {
    await client.subscribe("/known/depth", false);
    client.socket.pause();
  }
  for (const client of quick) await client.subscribe("/known/depth", false);
  const count = (client) => client.messages.get("/known/depth").length;
  await until("50 images", () => quick.every((client) => count(client) > 50));
  const first = memory();
  await until("100 more", () => quick.every((client) => count(client) > 150));
  assert.ok(memory() - first < 20_000, `${first} kB, then ${memory()} kB`);
  for (const client of slow) client.socket.resume();
  await until("what was dropped", () =>
    slow.every(({ statuses }) => statuses.some(({ message }) => /were dropped/.test(message))),
  );
  for (const client of [...slow, ...quick]) await client.close();
});

test("what is hostile is answered or cut off, and the others go on", async () => {
  const other = new Client(viewer);
  await other.subscribe("/known/number");
  const hostile = async (send, expected) => {
    const client = new Client(driver);
    await client.ready;
    send(client.socket);
    if (typeof expected === "number") {
      client.socket.on("error", () => {});
      const code = await new Promise((resolve) => client.socket.on("close", resolve));
      assert.ok([expected, 1006].includes(code), `${code}`);
      return;
    }
    await until(`${expected}`, () => client.statuses.some(({ message }) => expected.test(message)));
    await client.close();
  };
  await hostile((socket) => socket.send("{"), /not a JSON object/);
  await hostile((socket) => socket.send("[".repeat(60_000)), /not a JSON object/);
  await hostile((socket) => socket.send('{"op":7}'), /"" is not supported/);
  for (let length = 90; length < 104; ++length) // cut in the middle of a letter
    await hostile((socket) => socket.send(`{"op":"${"x".repeat(length)}ééé"}`), /is not supported/);
  await hostile(
    (socket) => socket.send(`{"op":"subscribe","subscriptions":["${"x".repeat(97)}éé"]}`),
    /no such channel/,
  );
  await hostile((socket) => socket.send('{"op":"advertise","channels":[]}'), /"advertise" is not/);
  await hostile((socket) => socket.send(Buffer.from([1, 0, 0, 0, 0])), /accepts no publications/);
  for (const subscription of ['{"id":-1,"channelId":3}', '{"id":1,"channelId":4000000000}', "3", "null",
    '{"id":1e300,"channelId":1}', '{"id":"a","channelId":[]}'])
    await hostile(
      (socket) => socket.send(`{"op":"subscribe","subscriptions":[${subscription}]}`),
      /no such channel/,
    );
  for (const parameter of ['{"name":"blob.hue"}', '{"name":7,"value":1}', "null", '{"name":"a.b","value":1}'])
    await hostile(
      (socket) => socket.send(`{"op":"setParameters","parameters":[${parameter}]}`),
      /no such parameter/,
    );
  await hostile(
    (socket) => socket.send('{"op":"setParameters","parameters":[{"name":"blob.hue","value":"1\\nstop"}]}'),
    /single line/,
  );
  await hostile((socket) => socket.send("x".repeat(1 << 20)), 1009);
  await hostile((socket) => socket._socket.write(Buffer.from([0xff, 0xff, 0xff, 0xff])), 1002);
  const raw = connect(Number(new URL(driver).port), "127.0.0.1");
  raw.on("error", () => {});
  raw.write(`GET /${"x".repeat(100_000)} HTTP/1.1\r\n\r\n`);
  await new Promise((resolve) => raw.resume().on("close", resolve));
  await other.next("/known/number");
  await other.close();
});
