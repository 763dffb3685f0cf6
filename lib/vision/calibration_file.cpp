// SPDX-License-Identifier: Apache-2.0
// Calibration files. They are untrusted: everything is checked.
#include <vision/calibration.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <hc/os/new_file.h>
#include <opencv2/core/persistence.hpp>

namespace hc::vision {
namespace {

constexpr std::size_t kLargestFile = 64 << 10;  // [byte]
constexpr int kLargestSide = 65535;             // of an image [px]
constexpr double kMostFocal = 1e6;              // [px]
constexpr double kMostBaseline = 1000;          // [m], or squares of a board in OpenCV's own files
constexpr std::ptrdiff_t kMostNested = 64;

Error malformed(const std::string& what) {
  return {Code::Malformed, "calibration: " + what};
}

/// The numbers of a matrix, without allocating the size that the file claims.
Result<std::vector<double>> numbers_of(const cv::FileNode& root, const std::string& key) {
  const cv::FileNode node = root[key];
  if (node.empty()) return malformed(key + " is missing");
  if (!node.isMap()) return malformed(key + " is not a matrix");
  const cv::FileNode data = node["data"], dt = node["dt"];
  if (!data.isSeq() || !node["rows"].isInt() || !node["cols"].isInt() || !dt.isString())
    return malformed(key + " is not a matrix");
  const std::string scalar = dt;
  if (scalar != "d" && scalar != "f")
    return malformed(key + " has elements \"" + scalar + "\", not d or f");
  const double cells = node["rows"].real() * node["cols"].real();
  if (node["rows"].real() < 1 || cells != static_cast<double>(data.size()) || cells > 64)
    return malformed(key + " does not have the stated shape");
  std::vector<double> numbers;
  for (const auto& each : data) {
    if (!each.isReal() && !each.isInt())
      return malformed(key + " contains a value that is not a number");
    numbers.push_back(each.real());
    if (!std::isfinite(numbers.back()))
      return malformed(key + " contains a value that is not finite");
  }
  return numbers;
}

template <int kRows, int kColumns>
Status read(const cv::FileNode& root, const std::string& key,
            cv::Matx<double, kRows, kColumns>& matrix) {
  auto numbers = HC_TRY(numbers_of(root, key));
  // Accept a column vector written as a row.
  const bool is_vector = kColumns == 1;
  if (numbers.size() != std::size_t{kRows} * std::size_t{kColumns} ||
      (!is_vector && (root[key]["rows"].real() != kRows)))
    return malformed(key + " is not " + std::to_string(kRows) + " x " + std::to_string(kColumns));
  std::copy(numbers.begin(), numbers.end(), matrix.val);
  return {};
}

Status read_distortion(const cv::FileNode& root, const std::string& key,
                       std::vector<double>& distortion) {
  auto numbers = HC_TRY(numbers_of(root, key));
  const auto count = numbers.size();
  if (count != 4 && count != 5 && count != 8 && count != 12 && count != 14)
    return malformed(key + " has " + std::to_string(count) + " numbers, not 4, 5, 8, 12 or 14");
  distortion = numbers;
  return {};
}

Status read_size(const cv::FileNode& root, cv::Size& size) {
  for (auto [key, side] : {std::pair{"image_width", &size.width}, {"image_height", &size.height}}) {
    const cv::FileNode node = root[key];
    if (node.empty()) continue;
    if (!node.isInt()) return malformed(std::string(key) + " is not an integer");
    const double value = node.real();
    if (value < 1 || value > kLargestSide)
      return Error{Code::TooLarge, "calibration: " + std::string(key) + " is not from 1 to 65535"};
    *side = static_cast<int>(value);
  }
  if ((size.width == 0) != (size.height == 0))
    return malformed("image_width or image_height is missing");
  return {};
}

bool is_camera(const double fx, const double fy, const double skew) {
  return fx > 0 && fy > 0 && fx <= kMostFocal && fy <= kMostFocal && skew == 0;
}

bool is_rotation(const cv::Matx33d& R) {
  constexpr double kTolerance = 1e-3;  // accepts four decimals
  return cv::norm(R * R.t(), cv::Matx33d::eye(), cv::NORM_INF) < kTolerance &&
         cv::determinant(R) > 0;
}

Status check(const StereoCalibration& c) {
  for (auto [name, M] : {std::pair{"M1", &c.M1}, {"M2", &c.M2}})
    if (!is_camera((*M)(0, 0), (*M)(1, 1), (*M)(1, 0)) || (*M)(2, 0) != 0 || (*M)(2, 1) != 0 ||
        (*M)(2, 2) != 1)
      return malformed(std::string(name) + " is not a camera matrix");
  for (auto [name, R] : {std::pair{"R", &c.R}, {"R1", &c.R1}, {"R2", &c.R2}})
    if (!is_rotation(*R)) return malformed(std::string(name) + " is not a rotation");
  for (auto [name, P] : {std::pair{"P1", &c.P1}, {"P2", &c.P2}})
    if (!is_camera((*P)(0, 0), (*P)(1, 1), (*P)(1, 0)) || (*P)(2, 2) != 1)
      return malformed(std::string(name) + " is not a projection matrix");
  if (c.P1(0, 0) != c.P2(0, 0) || c.P1(1, 1) != c.P2(1, 1) || c.P1(1, 2) != c.P2(1, 2))
    return malformed("P1 and P2 differ in focal length or cy");
  if (!(cv::norm(c.T) > 0) || cv::norm(c.T) > kMostBaseline)
    return malformed("T is not a valid baseline");
  if (c.P2(1, 3) != 0) return malformed("the cameras are above one another");
  if (c.baseline() < 0) return malformed("the left camera is on the right (P2)");
  if (!(c.baseline() > 0)) return malformed("P2 has no baseline");
  if (!(c.rms >= 0)) return malformed("rms is below 0");
  if (!(c.focal_deviation >= 0)) return malformed("focal_deviation is below 0");
  return {};
}

}  // namespace

std::string text_of(const StereoCalibration& calibration) {
  cv::FileStorage file("calibration.yml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
  const auto& c = calibration;
  if (c.size.area() > 0) file << "image_width" << c.size.width << "image_height" << c.size.height;
  file << "M1" << cv::Mat(c.M1) << "D1" << cv::Mat(c.D1).reshape(1, 1);
  file << "M2" << cv::Mat(c.M2) << "D2" << cv::Mat(c.D2).reshape(1, 1);
  file << "R" << cv::Mat(c.R) << "T" << cv::Mat(c.T) << "R1" << cv::Mat(c.R1);
  file << "R2" << cv::Mat(c.R2) << "P1" << cv::Mat(c.P1) << "P2" << cv::Mat(c.P2);
  file << "Q" << cv::Mat(c.Q) << "rms" << c.rms;
  if (c.focal_deviation > 0) file << "focal_deviation" << c.focal_deviation;
  if (!c.head.empty()) file << "head" << cv::Mat(c.head).reshape(1, 1);
  return file.releaseAndGetString();
}

Result<StereoCalibration> calibration_of(const std::string& text) {
  if (text.size() > kLargestFile)
    return Error{Code::TooLarge, "calibration: more than 65536 bytes"};
  if (!text.starts_with("%YAML")) return malformed("does not begin with %YAML");
  if (text.find('\0') != std::string::npos) return malformed("holds a zero byte");
  // OpenCV's parser recurses without a limit on the depth.
  std::ptrdiff_t nested =
      std::count(text.begin(), text.end(), '[') + std::count(text.begin(), text.end(), '{');
  for (std::size_t i = 0; i + 1 < text.size(); ++i)
    nested += text[i] == '-' && (text[i + 1] == ' ' || text[i + 1] == '\n');
  if (nested > kMostNested) return malformed("contains too many lists");
  // In concatenated files, drop the header of the second one.
  std::string joined, line;
  std::istringstream lines(text);
  for (bool is_first = true; std::getline(lines, line); is_first = false)
    if (is_first || (!line.starts_with("%YAML") && line != "---" && line != "..."))
      joined += line + "\n";
  try {
    cv::FileStorage file(
        joined, cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
    const cv::FileNode root = file.root();
    if (!root.isMap()) return malformed("is not a map");
    StereoCalibration c;
    HC_TRY(read_size(root, c.size));
    HC_TRY(read(root, "M1", c.M1));
    HC_TRY(read_distortion(root, "D1", c.D1));
    HC_TRY(read(root, "M2", c.M2));
    HC_TRY(read_distortion(root, "D2", c.D2));
    for (auto [key, R] : {std::pair{"R", &c.R}, {"R1", &c.R1}, {"R2", &c.R2}})
      HC_TRY(read(root, key, *R));
    for (auto [key, P] : {std::pair{"P1", &c.P1}, {"P2", &c.P2}}) HC_TRY(read(root, key, *P));
    cv::Matx31d T;
    HC_TRY(read(root, "T", T));
    c.T = {T(0), T(1), T(2)};
    HC_TRY(read(root, "Q", c.Q));
    for (auto [key, number] : {std::pair{"rms", &c.rms}, {"focal_deviation", &c.focal_deviation}})
      if (const cv::FileNode node = root[key]; node.isReal() || node.isInt()) *number = node.real();
    if (!root["head"].empty()) {
      c.head = HC_TRY(numbers_of(root, "head"));
    }
    HC_TRY(check(c));
    return c;
  } catch (const std::exception&) {  // cv::Exception, or another from its parser
    return malformed("is not a cv::FileStorage file");
  }
}

Result<StereoCalibration> read_calibration(const std::string& path) {
  auto failed = [&](int number) {
    return Error{Code::System, "open " + path + ": " + std::strerror(number)};
  };
  std::error_code unreadable;
  if (std::filesystem::is_directory(path, unreadable)) return failed(EISDIR);
  std::ifstream file(path, std::ios::binary);
  if (!file) return failed(errno);
  std::string text(kLargestFile + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad()) return failed(EIO);
  text.resize(static_cast<std::size_t>(file.gcount()));
  auto calibration = calibration_of(text);
  if (!calibration)
    return Error{calibration.error().code, path + ": " + calibration.error().detail};
  return calibration;
}

Status write_calibration(const std::string& path, const StereoCalibration& calibration) {
  return replace_file(path, text_of(calibration));
}

bool has_changed(const std::string& path, const std::optional<StereoCalibration>& before) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error) || std::filesystem::is_empty(path, error))
    return false;
  const auto now = read_calibration(path);
  return !now || !before || text_of(*now) != text_of(*before);
}

}  // namespace hc::vision
