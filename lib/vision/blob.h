// SPDX-License-Identifier: Apache-2.0
#pragma once
// Finds blobs of a colour in images and follows the best one. No messages; plain cv::Mat in.

#include <cstdint>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

namespace hc::vision {

/// A colour as ranges of hue, saturation and value, all from 0 to 1; hue 0 is red, 1/3 green, 2/3
/// blue, and 1 red again.
struct BlobColour {
  double hue = 0;           ///< 0 … 1
  double hue_width = 0.05;  ///< largest deviation of a pixel's hue, on either side
  double min_saturation = 0.5;
  double min_value = 0.2;

  bool operator==(const BlobColour&) const = default;
};

/// A colour as hue, saturation and value, each 0 … 1. Source: Smith, Color Gamut Transform Pairs,
/// 1978. @param rgb  0 … 255.
cv::Vec3d hue_saturation_value(const cv::Vec3d& rgb);

/// The colour to look for, from the surroundings of a pixel: their hue, and somewhat more than half
/// of their saturation and value, to allow for shading.
///
/// @param rgb  (H, W, 3) u8. @param at  [px], inside the image.
/// @returns  nothing where the image is almost grey.
std::optional<BlobColour> colour_at(const cv::Mat& rgb, cv::Point at);

/// A blob in an image [px].
struct Blob {
  double x = 0, y = 0;  ///< centre; (0, 0) is the centre of the top left pixel
  double radius = 0;    ///< of the disc of the same area
  double area = 0;      ///< [px²], holes filled
};

/// Finds the blob of a colour and follows it. Prefers round and large blobs that are close to the
/// last one in position and size. Includes shaded parts if they make the blob rounder.
class BlobFinder {
 public:
  explicit BlobFinder(const BlobColour& colour);

  [[nodiscard]] const BlobColour& colour() const { return colour_; }

  /// @param rgb  (H, W, 3) u8, the next of a sequence.
  /// @param min_area  of a blob [px²].
  /// @returns  nothing if all blobs are smaller; also, for up to 20 images, if the best blob has
  ///     more than four times the area of the last one.
  /// Cost: 1 ms at 800×600.
  std::optional<Blob> find(const cv::Mat& rgb, double min_area);

  /// The mean saturation and value of a blob of the right hue that is too dark or too pale to be
  /// found; nothing if there is none.
  std::optional<BlobColour> find_faint(const cv::Mat& rgb, double min_area);

 private:
  /// In pixels of the image that was searched.
  struct Region {
    double x = 0, y = 0, area = 0;
    double fit = 0;  // filled share of the enclosing circle
    cv::Rect box;
  };
  using Table = std::vector<std::uint8_t>;  // 255 for the colours searched

  static Table table_of(const BlobColour& colour);
  void mark(const cv::Mat& rgb, const Table& table);  // in mask_
  std::vector<Region> regions(const cv::Mat& rgb, const Table& table);
  const cv::Mat& shrink(const cv::Mat& rgb, int scale);
  [[nodiscard]] double score(const Region& region, int scale) const;
  void remember(const std::optional<Blob>& blob);

  static constexpr int kBits = 6;  // of red, green and blue each, in the table
  BlobColour colour_, faint_;
  Table table_, faint_table_;
  cv::Mat small_, smooth_, mask_, labels_, sizes_, middles_;
  std::optional<Blob> last_;
  cv::Point2d velocity_;  // of the last one [px an image]
  int missed_ = 0;        // images since
};

}  // namespace hc::vision
