// SPDX-License-Identifier: Apache-2.0
import { openMcap } from "./mcap";
import { openMessages, type Track } from "./track";

/** Files opened by the person; a URL cannot contain them. */
let given: readonly File[] = [];

const isRecording = (name: string) => /\.(mtp|mcap)$/.test(name);

/** Takes .mtp and .mcap files; returns their number. */
export function giveFiles(files: Iterable<File>): number {
  const recordings = [...files].filter(({ name }) => isRecording(name));
  if (recordings.length > 0) given = recordings;
  return recordings.length;
}

/** Indexes the streams of a recording on the server, or of the opened files if `name` is empty. */
export async function openRecording(
  name: string,
  progress: (words: string) => void,
): Promise<Track[]> {
  const files = name === "" ? given : [await fileOf(name, progress)];
  const tracks: Track[] = [];
  for (const file of files) {
    const words = (part: number) => progress(`Reading ${file.name}: ${Math.round(100 * part)} %`);
    if (/\.mcap$/i.test(file.name)) tracks.push(...(await openMcap(file, words)));
    else tracks.push(await openMessages(file.name.replace(/\.mtp$/, ""), file, words));
  }
  return tracks.filter((track) => track.length > 0);
}

/** A recording on the server. The browser keeps large ones on disk. */
async function fileOf(name: string, progress: (words: string) => void): Promise<File> {
  progress(`Reading ${name} …`);
  const response = await fetch(`/recordings/${name}.mcap`);
  if (!response.ok) throw new Error(`The server refuses ${name}: ${response.status}.`);
  return new File([await response.blob()], `${name}.mcap`);
}
