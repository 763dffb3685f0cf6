// SPDX-License-Identifier: Apache-2.0
#pragma once
// The largest blob of a colour in an image. No messages; plain cv::Mat in.

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

/// Finds the largest blob of a colour.
class BlobFinder {
 public:
  explicit BlobFinder(const BlobColour& colour) : colour_(colour) { fill_table(); }

  [[nodiscard]] const BlobColour& colour() const { return colour_; }

  /// @param rgb  (H, W, 3) u8.
  /// @param min_area  of what counts as found [px²].
  /// @returns  nothing where no blob is as large.
  /// Cost: 1 ms at 800×600.
  std::optional<Blob> find(const cv::Mat& rgb, double min_area);

 private:
  struct Region {
    double x = 0, y = 0, area = 0;
    cv::Rect box;
  };

  void fill_table();
  std::optional<Region> largest(const cv::Mat& rgb);

  static constexpr int kBits = 6;  // of each of red, green, blue that the table distinguishes
  BlobColour colour_;
  std::vector<std::uint8_t> table_;  // 255 where a colour is the one looked for
  cv::Mat small_, smooth_, mask_, labels_, sizes_, middles_;
};

}  // namespace hc::vision
