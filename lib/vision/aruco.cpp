// SPDX-License-Identifier: Apache-2.0
#include <vision/marker_finder.h>

#include <algorithm>
#include <string_view>

#include <hc/base/format.h>
#include <opencv2/aruco.hpp>

namespace hc::vision {
namespace {

namespace aruco = cv::aruco;

// PREDEFINED_DICTIONARY_NAME in OpenCV 4.6, PredefinedDictionaryType in 4.7 and later.
using DictionaryName = decltype(aruco::DICT_6X6_250);

/// In OpenCV's order.
constexpr std::string_view kDictionaries[] = {
    "4X4_50",  "4X4_100",  "4X4_250", "4X4_1000", "5X5_50",        "5X5_100",
    "5X5_250", "5X5_1000", "6X6_50",  "6X6_100",  "6X6_250",       "6X6_1000",
    "7X7_50",  "7X7_100",  "7X7_250", "7X7_1000", "ARUCO_ORIGINAL"};
static_assert(kDictionaries[aruco::DICT_6X6_250] == "6X6_250" &&
              kDictionaries[aruco::DICT_ARUCO_ORIGINAL] == "ARUCO_ORIGINAL");

/// A dictionary for detectMarkers: a cv::Ptr in OpenCV 4.6, a value since 4.7.
template <typename Given>
cv::Ptr<aruco::Dictionary> pointer_to(const Given& given) {
  if constexpr (requires { given.get(); })
    return given;
  else
    return cv::makePtr<aruco::Dictionary>(given);
}

/// OpenCV 4.6 keeps only the outermost of outlines closer than `minMarkerDistanceRate`. With the
/// default of 0.05 this is the edge of a white margin instead of the marker. Versions with
/// `minGroupDistance` (seen: 4.10) try the others too.
template <typename Parameters>
void keep_inner_outlines(Parameters& parameters) {
  if constexpr (!requires { parameters.minGroupDistance; }) parameters.minMarkerDistanceRate = 0.01;
}

}  // namespace

struct ArucoFinder::Detector {
  cv::Ptr<aruco::Dictionary> dictionary;
  cv::Ptr<aruco::DetectorParameters> parameters = cv::makePtr<aruco::DetectorParameters>();
};

Result<ArucoFinder> ArucoFinder::make(const std::string& dictionary) {
  const auto* named = std::ranges::find(kDictionaries, dictionary);
  if (named == std::end(kDictionaries))
    return Error{Code::Invalid, "unknown ArUco dictionary \"" + dictionary + "\""};
  auto detector = std::make_shared<Detector>();
  keep_inner_outlines(*detector->parameters);
  detector->dictionary = pointer_to(aruco::getPredefinedDictionary(
      static_cast<DictionaryName>(named - std::begin(kDictionaries))));
  return ArucoFinder(std::move(detector));
}

Status ArucoFinder::has(std::size_t markers) const {
  const auto all = static_cast<std::size_t>(detector_->dictionary->bytesList.rows);
  if (markers <= all) return {};
  return Error{Code::Invalid,
               hc::format("the dictionary has {} markers, the board {}", all, markers)};
}

cv::Mat ArucoFinder::cells(int id) const {
  const auto& all = *detector_->dictionary;
  return 255 *
         aruco::Dictionary::getBitsFromByteList(all.bytesList.rowRange(id, id + 1), all.markerSize);
}

std::vector<Marker> ArucoFinder::find(const cv::Mat& grey) const {
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  aruco::detectMarkers(grey, detector_->dictionary, corners, ids, detector_->parameters);
  std::vector<Marker> markers;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    Marker marker{MarkerKind::Aruco, ids[i], {}};
    std::copy_n(corners[i].begin(), 4, marker.corners.begin());
    // A wide rim is detected by its outer and its inner edge: keep the outer one.
    const auto known = std::find_if(markers.begin(), markers.end(), [&](const Marker& other) {
      return other.id == marker.id &&
             cv::norm(other.middle() - marker.middle()) < marker.mean_side() / 4;
    });
    if (known == markers.end())
      markers.push_back(marker);
    else if (marker.mean_side() > known->mean_side())
      *known = marker;
  }
  // Short of the rim's inner edge, about a cell (1/8) away; edges of a large marker out of focus
  // are many pixels wide.
  for (auto& marker : markers)
    refine_corners(grey, marker.corners, std::clamp(0.06 * marker.mean_side(), 1.5, 10.0));
  return markers;
}

}  // namespace hc::vision
