// SPDX-License-Identifier: Apache-2.0
#pragma once
// Semi-global matching of a rectified pair, on vectors of bytes: census transform, path costs from
// five directions in one sweep from the top, sub-pixel refinement, left-right check.
//
// All arithmetic is on integers, and the stripes of rows depend only on the image height: the
// result is the same on every processor and with any number of threads.
//
// Sources: Zabih and Woodfill, Non-parametric Local Transforms for Computing Visual Correspondence,
// 1994 (census). Hirschmüller, Stereo Processing by Semiglobal Matching and Mutual Information,
// 2008 (path costs, left-right check).

#include <array>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace hc::vision {

/// Census words: a bit for each of these offsets (row, column), set if darker than the mean of the
/// four pixels next to the centre. Tuned, like the penalties, on the Aloe pair and on rendered
/// rooms with noise; 5×5 words compared with the centre pixel are better on the former, worse on
/// the latter.
inline constexpr std::array<std::array<int, 2>, 24> kCensus = {
    {{-3, -4}, {-3, -2}, {-3, 0}, {-3, 2}, {-3, 4}, {-2, -3}, {-2, -1}, {-2, 1},
     {-2, 3},  {0, -4},  {0, -2}, {0, -1}, {0, 1},  {0, 2},   {0, 4},   {2, -3},
     {2, -1},  {2, 1},   {2, 3},  {3, -4}, {3, -2}, {3, 0},   {3, 2},   {3, 4}}};

/// Costs of a change of disparity from a pixel to the next. For comparison, a matching cost is the
/// Hamming distance of two census words, 0 to 24.
struct Penalties {
  std::uint8_t slope = 0;                ///< a change by one
  std::array<std::uint8_t, 256> jump{};  ///< any other, by the difference of grey levels

  /// Jumps cost `max` between equal grey levels and less at edges, down to `min`.
  static Penalties with_jumps(int slope, int max, int min);
};

/// Disparities in fixed point.
inline constexpr int kSubPixels = 64;  ///< units in a pixel; 0 is unknown

/// The parameters of match_rows().
struct SemiGlobal {
  int disparities = 128;  ///< searched, from 0 on [px]; 1 to 256
  Penalties penalties = Penalties::with_jumps(10, 70, 10);
  int margin = 3;  ///< minimum difference between the best sum of costs and the best one more than
                   ///< one pixel away; below it, ambiguous
  int left_right = 1;  ///< maximum difference of the disparities of a pixel and its partner [px]
};

/// The rows [begin, end) of a pair and their results.
struct Stripe {
  const cv::Mat* left;   ///< (H + 8, W + 8 + kReadBeyond) u8, grey, with kBorder pixels around
  const cv::Mat* right;  ///< the same, mirrored, so that the partners of a pixel are consecutive
  int width;
  int begin, end;
  cv::Mat* disparity;  ///< (H, W) u16 [1/64 px], 0 where unknown
  cv::Mat* margin;     ///< (H, W) u8: cost margin of the best disparity; 0: unknown
  /// The same as `disparity` for the pixels of the right image, not mirrored; null: not wanted.
  cv::Mat* right_disparity = nullptr;
};

/// Width of the border of a Stripe's images, which repeats the outermost pixels.
inline constexpr int kBorder = 4;
/// Columns to the right of that border, which vectors may read.
inline constexpr int kReadBeyond = 64;
/// Rows above a stripe that initialise the path costs of its first row.
inline constexpr int kWarmUpRows = 16;

/// Working memory of match_rows(), to be reused.
using Scratch = std::vector<std::uint8_t>;

/// Finds the disparities of a stripe with the widest vectors of the processor.
///
/// Cost: width · rows · disparities; no allocation once `scratch` is large enough.
void match_rows(const Stripe& stripe, const SemiGlobal& options, Scratch& scratch);

/// The first rows of an image's stripes, followed by its height.
std::vector<int> stripes_of(int height);

}  // namespace hc::vision
