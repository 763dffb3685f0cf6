// SPDX-License-Identifier: Apache-2.0
// The choices of the opener, and the search among them. Pure.
import type { PanelArgs } from "./panel";

export interface Choice {
  readonly label: string;
  readonly detail: string;
  /** Of a stream's messages. */
  readonly type?: string;
  readonly args: PanelArgs;
}

/** The standard panels, or a module with its streams. */
export interface Group {
  readonly name: string;
  readonly summary: string;
  readonly choices: readonly Choice[];
}

/** Types of streams as people name them. */
export const streamTypes: Readonly<Record<string, RegExp>> = {
  Images: /image/,
  Poses: /position|rotation|transformation/,
  "3D": /vector_field/,
  Numbers: /table/,
  Text: /string/,
  Sound: /sound/,
};

/** The name of a type: "images"; the type itself if it has none. */
export function wordFor(type: string): string {
  const [name] = Object.entries(streamTypes).find(([, types]) => types.test(type)) ?? [];
  return name?.replace(/^[A-Z][a-z]/, (letters) => letters.toLowerCase()) ?? type;
}

/**
 * The groups and their choices that match all words; those that begin with the first come first.
 *
 * @param type  only streams of this one of streamTypes; empty: all choices.
 */
export function found(groups: readonly Group[], typed: string, type: string): Group[] {
  const words = typed.toLowerCase().split(/\s+/).filter(Boolean);
  const has = (text: string) => words.every((word) => text.toLowerCase().includes(word));
  const isOfType = (choice: Choice) => !type || streamTypes[type]!.test(choice.type ?? "");
  const matching = groups.map((group) => ({
    ...group,
    choices: group.choices.filter(
      (choice) =>
        isOfType(choice) &&
        has([choice.label, choice.detail, choice.type ?? "", group.summary].join(" ")),
    ),
  }));
  const filled = matching.filter(({ choices }) => choices.length > 0);
  const first = typed === "" ? "" : words[0]!;
  const begins = ({ name }: Group) => first !== "" && name.toLowerCase().startsWith(first);
  return [...filled.filter(begins), ...filled.filter((group) => !begins(group))];
}
