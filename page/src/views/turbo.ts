// SPDX-License-Identifier: Apache-2.0

/** Polynomials of the colour map Turbo. Source: A. Mikhailov, Google, 2019, turbo_colormap.glsl. */
const polynomials = [
  [0.13572138, 4.6153926, -42.66032258, 132.13108234, -152.94239396, 59.28637943],
  [0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604],
  [0.1066733, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973],
];

/** The lowest level, a clear blue: the scale's end is nearly as black as a hole. */
const lowest = 28 / 255;

/** Red, green, blue [0, 255] of a level from 0 (blue) to 1 (red), as in `hc view`. */
export function turbo(level: number): [number, number, number] {
  const x = lowest + Math.min(1, Math.max(0, level)) * (1 - lowest);
  const [r, g, b] = polynomials.map((terms) => {
    const value = terms.reduceRight((sum, term) => sum * x + term, 0);
    return Math.round(255 * Math.min(1, Math.max(0, value)));
  });
  return [r!, g!, b!];
}

/** 256 colours of turbo(), as pixels of a canvas: ABGR in a number. */
export function turboPixels(): Uint32Array {
  return Uint32Array.from({ length: 256 }, (_, i) => {
    const [r, g, b] = turbo(i / 255);
    return 0xff000000 | (b << 16) | (g << 8) | r;
  });
}
