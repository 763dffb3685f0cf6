// SPDX-License-Identifier: Apache-2.0
#pragma once
// Semi-global matching of a rectified pair, on vectors of bytes: census transform, path costs from
// five directions in one sweep from the top, sub-pixel refinement, left-right check.
//
// Every number is an integer, and images are cut into stripes of rows by their height alone: the
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

/// Census words: a bit for each of these places, row and column from the pixel, that is darker than
/// the mean of the four pixels next to the pixel. Chosen, as the penalties, on the Aloe pair and on
/// drawn rooms with noise: words of 5×5 against the pixel itself are better there, worse here.
inline constexpr std::array<std::array<int, 2>, 24> kCensus = {
    {{-3, -4}, {-3, -2}, {-3, 0}, {-3, 2}, {-3, 4}, {-2, -3}, {-2, -1}, {-2, 1},
     {-2, 3},  {0, -4},  {0, -2}, {0, -1}, {0, 1},  {0, 2},   {0, 4},   {2, -3},
     {2, -1},  {2, 1},   {2, 3},  {3, -4}, {3, -2}, {3, 0},   {3, 2},   {3, 4}}};

/// What a change of disparity from a pixel to the next costs. A matching cost is the number of
/// different bits of two census words, 0 to 24.
struct Penalties {
  std::uint8_t slope = 0;                ///< a change by one
  std::array<std::uint8_t, 256> jump{};  ///< any other, by the difference of the two grey levels

  /// Jumps cost `max` where the grey levels are alike, and less, down to `min`, at edges.
  static Penalties with_jumps(int slope, int max, int min);
};

/// Disparities in fixed point.
inline constexpr int kSubPixels = 64;  ///< units in a pixel; 0 is unknown

/// The parameters of match_rows().
struct SemiGlobal {
  int disparities = 128;  ///< searched, from 0 on [px]; 1 to 256
  Penalties penalties = Penalties::with_jumps(10, 70, 10);
  int margin = 3;      ///< at least between the best sum of costs and the best of those that
                       ///< are more than one pixel away; less is ambiguous
  int left_right = 1;  ///< at most between the disparity of a pixel and of its partner [px]
};

/// The rows [begin, end) of a pair, and where their disparities go.
struct Stripe {
  const cv::Mat* left;   ///< (H + 8, W + 8 + kReadBeyond) u8, grey, with kBorder pixels around
  const cv::Mat* right;  ///< the same, flipped, so that the partners of a pixel follow one another
  int width;
  int begin, end;
  cv::Mat* disparity;  ///< (H, W) u16 [1/64 px], 0 where unknown
  cv::Mat* margin;     ///< (H, W) u8: how clear the best disparity is; 0 where unknown
};

/// Rows and columns around an image of a Stripe, which repeat its outermost ones.
inline constexpr int kBorder = 4;
/// Columns that an image of a Stripe has right of its border, which vectors read beyond it.
inline constexpr int kReadBeyond = 64;
/// Rows above a stripe whose path costs lead to its first row.
inline constexpr int kWarmUpRows = 16;

/// Memory of one call of match_rows(), to be used again.
using Scratch = std::vector<std::uint8_t>;

/// Finds the disparities of a stripe, with the widest vectors that the processor has.
///
/// Cost: width · rows · disparities; no allocation once `scratch` is large enough.
void match_rows(const Stripe& stripe, const SemiGlobal& options, Scratch& scratch);

/// The rows where stripes of an image begin, and its height at the end.
std::vector<int> stripes_of(int height);

}  // namespace hc::vision
