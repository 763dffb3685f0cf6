// SPDX-License-Identifier: Apache-2.0

/** Samples of sound, channel by channel, from -1 to 1 (R45). */
export function channelsOf(
  numbers: ArrayLike<number>,
  scalar: string,
  channels: number,
): Float32Array<ArrayBuffer>[] {
  const bits = { u8: 8, i8: 8, u16: 16, i16: 16, u32: 32, i32: 32, u64: 64, i64: 64 }[scalar];
  const full = bits === undefined ? 1 : 2 ** (bits - 1);
  const silence = scalar.startsWith("u") ? full : 0;
  const frames = Math.floor(numbers.length / channels);
  return Array.from({ length: channels }, (_, channel) => {
    const samples = new Float32Array(frames);
    for (let i = 0; i < frames; ++i) {
      const value = (numbers[i * channels + channel]! - silence) / full;
      samples[i] = Math.min(1, Math.max(-1, value));
    }
    return samples;
  });
}

/** Level of samples [dB]; 0: square wave at full scale; at least -100. */
export function level(samples: ArrayLike<number>): number {
  let sum = 0;
  for (let i = 0; i < samples.length; ++i) sum += samples[i]! ** 2;
  return Math.max(-100, 10 * Math.log10(sum / Math.max(1, samples.length)));
}

/**
 * Magnitudes of count / 2 frequencies from 0 to half the sample rate [dB]; 0: sine at full scale.
 * Hann window.
 *
 * @param samples  their number must be a power of two.
 */
export function spectrum(samples: ArrayLike<number>): Float64Array {
  const count = samples.length;
  const real = new Float64Array(count);
  const imaginary = new Float64Array(count);
  const bits = Math.log2(count);
  for (let i = 0; i < count; ++i) {
    let reversed = 0;
    for (let bit = 0; bit < bits; ++bit) reversed |= ((i >> bit) & 1) << (bits - 1 - bit);
    real[reversed] = samples[i]! * (0.5 - 0.5 * Math.cos((2 * Math.PI * i) / count));
  }
  for (let size = 2; size <= count; size *= 2) {
    const half = size / 2;
    for (let k = 0; k < half; ++k) {
      const angle = (-2 * Math.PI * k) / size;
      const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
      for (let i = k; i < count; i += size) {
        const j = i + half;
        const re = real[j]! * cos - imaginary[j]! * sin;
        const im = real[j]! * sin + imaginary[j]! * cos;
        real[j] = real[i]! - re;
        imaginary[j] = imaginary[i]! - im;
        real[i]! += re;
        imaginary[i]! += im;
      }
    }
  }
  return Float64Array.from({ length: count / 2 }, (_, i) => {
    const size = Math.hypot(real[i]!, imaginary[i]!) * (4 / count);
    return Math.max(-120, 20 * Math.log10(size + 1e-12));
  });
}
