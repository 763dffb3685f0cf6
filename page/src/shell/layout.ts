// SPDX-License-Identifier: Apache-2.0
// The layout: columns of panels with shares of the room; and its form in the URL.
import type { PanelArgs } from "./panel";

export interface Place {
  args: PanelArgs;
  /** Share of the column's height, relative to the others. */
  share: number;
}

export interface Column {
  /** Share of the width, relative to the others. */
  share: number;
  places: Place[];
}

export type Layout = Column[];

const keep = (text: string) => encodeURIComponent(text).replace(/%20/g, "+").replace(/\*/g, "%2A");
const open = (text: string) => decodeURIComponent(text.replace(/\+/g, "%20"));
const shareText = (share: number) => (share === 1 ? "" : `*${Number(share.toFixed(2))}`);

/**
 * The layout as the fragment of a URL: columns separated by "|", panels by ";", as in
 * `stream,port=head_eyes.left;stream,port=depth.depth*0.5|graph*2`. A column's share follows
 * "**" at its end.
 */
export function layoutText(layout: Layout): string {
  return layout
    .map((column) => {
      const places = column.places.map(({ args, share }) => {
        const { kind, ...others } = args;
        const fields = Object.entries(others).flatMap(([key, value]) =>
          value === undefined ? [] : [`,${keep(key)}=${keep(value)}`],
        );
        return keep(kind) + fields.join("") + shareText(share);
      });
      const share = shareText(column.share);
      return places.join(";") + (share && "*" + share);
    })
    .join("|");
}

/** Parses such a text; invalid parts are dropped. */
export function layoutOf(text: string): Layout {
  const layout: Layout = [];
  for (const columnText of text.replace(/^#/, "").split("|")) {
    const [places = "", columnShare] = columnText.split("**");
    const column: Column = { share: shareOf(columnShare), places: [] };
    for (const placeText of places.split(";")) {
      const [argsText = "", share] = placeText.split("*");
      const [kind, ...fields] = argsText.split(",");
      if (!kind) continue;
      try {
        const entries = fields.map((field) => {
          const [key = "", value = ""] = field.split("=", 2);
          return [open(key), open(value)] as const;
        });
        const args = { ...Object.fromEntries(entries), kind: open(kind) };
        column.places.push({ args, share: shareOf(share) });
      } catch (error) {
        if (!(error instanceof URIError)) throw error;
      }
    }
    if (column.places.length > 0) layout.push(column);
  }
  return layout;
}

function shareOf(text: string | undefined): number {
  const share = Number(text);
  return text && share > 0 && share < 100 ? share : 1;
}

export function sameArgs(a: PanelArgs, b: PanelArgs): boolean {
  const keys = new Set([...Object.keys(a), ...Object.keys(b)]);
  return [...keys].every((key) => a[key] === b[key]);
}
