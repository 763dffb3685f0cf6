// SPDX-License-Identifier: Apache-2.0
// unpack.mjs FOLDER: puts the weights of the networks into a folder, under the names by which
// programs know them, with their licences and where they are from (NOTICE).
import { mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const [folder] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url));
const packaged = (name) => readFileSync(join(here, "node_modules", name));
const source = (name) => readFileSync(join(here, "..", name));
const detection = "@mediapipe/face_detection";
const bundle = "@mediapipe/hands/hands_solution_packed_assets";
const recognition = "@vladmandic/face-api/model/face_recognition_model";

/** A file of the bundle, whose loader lists where each begins and ends. */
function bundled(name) {
  const loader = packaged(`${bundle}_loader.js`).toString();
  const files = JSON.parse(/"files": (\[.*?\])/.exec(loader)[1]);
  const { start, end } = files.find(({ filename }) => filename.endsWith(name));
  return packaged(`${bundle}.data`).subarray(start, end);
}

const unpacked = {
  "face_detection_full_range.tflite": packaged(`${detection}/face_detection_full_range.tflite`),
  "face_detection_short_range.tflite": packaged(`${detection}/face_detection_short_range.tflite`),
  "face_recognition.bin": packaged(`${recognition}.bin`),
  "face_recognition.json": packaged(`${recognition}-weights_manifest.json`),
  "hand_landmark_lite.tflite": packaged("@mediapipe/hands/hand_landmark_lite.tflite"),
  "palm_detection_lite.tflite": bundled("palm_detection_lite.tflite"),
  "LICENSE.face-api": packaged("@vladmandic/face-api/LICENSE"),
  "LICENSE.mediapipe": source("LICENSE"), // Apache 2.0, of which its packages have no copy
  NOTICE: source("NOTICE"),
};
mkdirSync(folder, { recursive: true });
for (const [name, bytes] of Object.entries(unpacked)) {
  rmSync(join(folder, name), { force: true });
  writeFileSync(join(folder, name), bytes);
}
