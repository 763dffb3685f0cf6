// SPDX-License-Identifier: Apache-2.0
import type { Server } from "../server";
import { filesOfTar, type NamedFile } from "./tar";
import { Track } from "./track";

/** Files that the person has given this page; a URL cannot hold them. */
let given: readonly NamedFile[] = [];

/** Takes .mtp files, and those in .tar archives; returns how many streams there are. */
export async function giveFiles(files: Iterable<File>): Promise<number> {
  const all = await Promise.all(
    [...files].map((file) =>
      file.name.endsWith(".tar") ? filesOfTar(file) : [{ name: file.name, blob: file }],
    ),
  );
  const streams = all.flat().filter((file) => file.name.endsWith(".mtp"));
  if (streams.length > 0) given = streams;
  return streams.length;
}

/** Indexes the streams of a recording of the server, or of the files given where `name` is empty. */
export async function openRecording(
  server: Server,
  name: string,
  progress: (words: string) => void,
): Promise<Track[]> {
  const files =
    name === ""
      ? given.map(({ name: fileName, blob }) => ({ name: fileName, blob: () => blob }))
      : await filesOf(server, name);
  const tracks: Track[] = [];
  for (const { name: fileName, blob } of files) {
    const port = fileName.replace(/\.mtp$/, "");
    progress(`Reading ${port} …`);
    const file = await blob();
    tracks.push(
      await Track.open(port, file, (part) =>
        progress(`Reading ${port}: ${Math.round(100 * part)} %`),
      ),
    );
  }
  return tracks.filter((track) => track.length > 0);
}

interface RecordedFile {
  readonly name: string;
  blob(): Blob | Promise<Blob>;
}

async function filesOf(server: Server, name: string): Promise<RecordedFile[]> {
  const recording = (await server.recordings()).find((each) => each.name === name);
  if (!recording) throw new Error(`The server has no recording ${name}.`);
  return recording.streams.map((port) => ({
    name: `${port}.mtp`,
    // The browser keeps large blobs on disk.
    blob: async () => {
      const response = await fetch(`/recordings/${name}/${port}.mtp`);
      if (!response.ok) throw new Error(`The server does not give ${port}: ${response.status}.`);
      return response.blob();
    },
  }));
}
