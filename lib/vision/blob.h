// SPDX-License-Identifier: Apache-2.0
#pragma once
// The blob of a colour in images: the roundest and largest, or the one that was seen before. No
// messages; plain cv::Mat in.

#include <cstdint>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

namespace hc::vision {

/// Which pixels are of a colour, by hue, saturation and value, all from 0 to 1; hue 0 is red, 1/3
/// green, 2/3 blue, and 1 red again.
struct BlobColour {
  double hue = 0;           ///< 0 … 1
  double hue_width = 0.05;  ///< how far a pixel's hue may be from it, on either side
  double min_saturation = 0.5;
  double min_value = 0.2;

  bool operator==(const BlobColour&) const = default;
};

/// A colour as hue, saturation and value, each 0 … 1. Source: Smith, Color Gamut Transform Pairs,
/// 1978. @param rgb  0 … 255.
cv::Vec3d hue_saturation_value(const cv::Vec3d& rgb);

/// The colour about a pixel, as what a blob is to be looked for by: its hue, and somewhat more than
/// half its saturation and value, since a thing has shades.
///
/// @param rgb  (H, W, 3) u8.  @param at  [px], inside of the image.
/// @returns  nothing where there is hardly any colour.
std::optional<BlobColour> colour_at(const cv::Mat& rgb, cv::Point at);

/// What was found. [px]
struct Blob {
  double x = 0, y = 0;  ///< its middle, (0, 0) being the middle of the top left pixel
  double radius = 0;    ///< of the disc of the same area
  double area = 0;      ///< [px²], holes filled
};

/// Finds the blob of a colour, and follows it: of several, the one that is round and large, and
/// near and of the size of the last one. What is in shadow belongs to it where it makes it rounder.
class BlobFinder {
 public:
  explicit BlobFinder(const BlobColour& colour);

  [[nodiscard]] const BlobColour& colour() const { return colour_; }

  /// @param rgb  (H, W, 3) u8, the next of a sequence.
  /// @param min_area  of what counts as found [px²].
  /// @returns  nothing where no blob is as large, or for a second of 20 images, only one of more
  ///     than four times the last one's area.
  /// Cost: 1 ms at 800×600.
  std::optional<Blob> find(const cv::Mat& rgb, double min_area);

  /// What a blob of the hue is like that is too dark or too pale to be found: its mean saturation
  /// and value; nothing where there is none.
  std::optional<BlobColour> find_faint(const cv::Mat& rgb, double min_area);

 private:
  /// [px] of the image that it was found in.
  struct Region {
    double x = 0, y = 0, area = 0;
    double fit = 0;  // share of the circle around it that it fills
    cv::Rect box;
  };
  using Table = std::vector<std::uint8_t>;  // 255 where a colour is the one looked for

  static Table table_of(const BlobColour& colour);
  void mark(const cv::Mat& rgb, const Table& table);  // in mask_
  std::vector<Region> regions(const cv::Mat& rgb, const Table& table);
  const cv::Mat& shrink(const cv::Mat& rgb, int scale);
  [[nodiscard]] double score(const Region& region, int scale) const;
  void remember(const std::optional<Blob>& blob);

  static constexpr int kBits = 6;  // of each of red, green, blue that the table distinguishes
  BlobColour colour_, faint_;
  Table table_, faint_table_;
  cv::Mat small_, smooth_, mask_, labels_, sizes_, middles_;
  std::optional<Blob> last_;
  cv::Point2d velocity_;  // of the last one [px an image]
  int missed_ = 0;        // images since
};

}  // namespace hc::vision
