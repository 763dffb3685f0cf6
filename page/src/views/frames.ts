// SPDX-License-Identifier: Apache-2.0
// The frames of a graph (spec/graph.md, section 6).

export interface Frame {
  readonly name: string;
  /** Its number in headers; 0: none. */
  readonly coord: number;
  readonly parent: string;
  /** If fixed: origin in the parent [m], and rotation as a quaternion x, y, z, w. */
  readonly fixed?: {
    readonly translation: readonly [number, number, number];
    readonly quaternion: readonly [number, number, number, number];
  };
  /** The output that moves it. */
  readonly movedBy?: string;
}

/** The frames in the text of G31, parents before children. */
export function framesOf(text: string): Frame[] {
  const frames = text.split(";").flatMap((part): Frame[] => {
    const [name, coord, parent, ...place] = part.trim().split(/ +/);
    if (!name || !parent) return [];
    const frame = { name, coord: Number(coord), parent };
    if (place.length === 7) {
      const [x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 0] = place.map(Number);
      return [{ ...frame, fixed: { translation: [x, y, z], quaternion: [qx, qy, qz, qw] } }];
    }
    return [{ ...frame, movedBy: place[0] }];
  });
  return inOrder(frames);
}

function inOrder(frames: readonly Frame[]): Frame[] {
  const names = new Set(frames.map(({ name }) => name));
  const ordered: Frame[] = [];
  const done = new Set<string>();
  let left = [...frames];
  while (left.length > 0) {
    const ready = left.filter(({ parent }) => !names.has(parent) || done.has(parent));
    if (ready.length === 0) break; // a cycle, which the graph refuses
    ready.forEach(({ name }) => done.add(name));
    ordered.push(...ready);
    left = left.filter(({ name }) => !done.has(name));
  }
  return ordered;
}
