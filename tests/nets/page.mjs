// SPDX-License-Identifier: Apache-2.0
// In the browser: pictures, and what networks compute for them by the interpreter of TensorFlow Lite
// and by face-api. Both are given to the server.

/** Numbers of 0 … 1, the same each time. Source: mulberry32, Tommy Ettinger. */
function seeded(seed) {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

/** The number of a picture at column u and row v (0 … 1), channel c, of index i: 0 … 1. */
const drawn = [
  ...[1, 2].map((seed) =>
    (
      (random) => () =>
        random()
    )(seeded(seed)),
  ),
  ((random) => () => (random() < 0.5 ? 0 : 1))(seeded(3)),
  (
    (random) => () =>
      0.45 + 0.1 * random()
  )(seeded(4)),
  (u) => u,
  (u, v) => 1 - v,
  (u, v) => (u + v) / 2,
  (u, v, c) => [u, v, 1 - u][c],
  () => 0,
  () => 0.5,
  () => 1,
  (u, v, c) => [0.8, 0.55, 0.45][c],
  ...[0.01, 0.1, 1].map((step) => (u, v, c, i) => (1 + Math.sin(step * i)) / 2),
  (u, v, c) => (1 + Math.sin(60 * Math.hypot(u - 0.5, v - 0.5) + c)) / 2,
];
const photographs = ["sample1.jpg", "sample2.jpg", "sample3.jpg", "sample5.jpg"];

async function photographed(name, height, width) {
  const image = await createImageBitmap(await (await fetch(`/photographs/${name}`)).blob());
  const scale = Math.min(image.width / width, image.height / height);
  const context = new OffscreenCanvas(width, height).getContext("2d");
  const left = (image.width - scale * width) / 2;
  context.drawImage(image, left, 0, scale * width, scale * height, 0, 0, width, height);
  const { data } = context.getImageData(0, 0, width, height);
  return (u, v, c, i) => data[4 * Math.floor(i / 3) + c] / 255;
}

/** All pictures, height × width × 3. */
async function pictures(height, width) {
  const all = [...drawn];
  for (const name of photographs) all.push(await photographed(name, height, width));
  return all.map((draw) => {
    const picture = new Float32Array(height * width * 3);
    for (let i = 0; i < picture.length; ++i) {
      const at = Math.floor(i / 3);
      picture[i] = draw((at % width) / width, Math.floor(at / width) / height, i % 3, i);
    }
    return picture;
  });
}

const give = (what, arrays) => fetch(`/${what}`, { method: "POST", body: new Blob(arrays) });

/** Gives inputs and outputs of a file; returns the numbers of each output. */
window.computeByTflite = async (path, height, width, least) => {
  tflite.setWasmPath("/tflite/wasm/");
  const model = await tflite.loadTFLiteModel(path);
  const all = await pictures(height, width);
  const inputs = all.map((picture) => picture.map((p) => least + (1 - least) * p));
  const outputs = [];
  for (const input of inputs) {
    const made = model.predict(tf.tensor(input, [1, height, width, 3]));
    // A copy: these are views of the interpreter's memory.
    for (const { name } of model.outputs) outputs.push((await made[name].data()).slice());
  }
  await give("inputs", inputs);
  await give("outputs", outputs);
  return outputs.slice(0, model.outputs.length).map((each) => each.length);
};

/** The same of a face chip, for the last picture of each sort. */
window.computeByFaceApi = async () => {
  const { nets, tf } = await import("/face-api/dist/face-api.esm.js");
  await tf.setBackend("cpu");
  await tf.ready();
  await nets.faceRecognitionNet.loadFromUri("/face-api/model");
  const chosen = (await pictures(150, 150)).filter((_, i) => i % 4 === 3);
  const chips = chosen.map((all) => all.map((p) => Math.round(255 * p)));
  const mean = [122.782, 117.001, 104.298];
  const outputs = [];
  for (const chip of chips) {
    const made = await nets.faceRecognitionNet.forward(tf.tensor(chip, [1, 150, 150, 3]));
    outputs.push(await made.data());
  }
  await give(
    "inputs",
    chips.map((chip) => chip.map((p, i) => (p - mean[i % 3]) / 255)),
  );
  await give("outputs", outputs);
  return [outputs[0].length];
};
