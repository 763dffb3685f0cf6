// SPDX-License-Identifier: Apache-2.0
#include "sequence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include <hc/base/natural_order.h>
#include <hc/base/time.h>
#include <hc/compress/compress.h>
#include <hc/module/module.h>
#include <hc/os/file_stamp.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "partners.h"

namespace {

namespace fs = std::filesystem;

/// A missing or wrong file, which a restart would not cure.
[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  hc::refuse(name + ": " + why);
}

/// The bytes of a JPEG file; none of another file.
std::vector<std::uint8_t> read_jpeg(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  constexpr std::array<char, 2> kJpeg{'\xff', '\xd8'};
  std::array<char, 2> begin{};
  if (!file.read(begin.data(), begin.size()) || begin != kJpeg) return {};
  file.seekg(0);
  return {std::istreambuf_iterator(file), {}};
}

/// Reads an image file as (H, W, 3) u8. Errors: Malformed.
hc::Result<cv::Mat> read_image(const std::string& path, const Reading& reading) {
  const int flags = cv::IMREAD_COLOR | cv::IMREAD_ANYDEPTH |
                    (reading.upright ? 0 : cv::IMREAD_IGNORE_ORIENTATION);
  const auto jpeg = read_jpeg(path);
  if (!jpeg.empty()) HC_TRY(hc::check_jpeg(std::as_bytes(std::span(jpeg))));
  cv::Mat image = jpeg.empty() ? cv::imread(path, flags) : cv::imdecode(jpeg, flags);
  if (image.empty()) return hc::Error{hc::Code::Malformed, "not a readable image"};
  if (image.depth() == CV_8U) return image;
  const bool is_16_bit = image.depth() == CV_16U;
  reading.log("deeper than 8 bits",
              path + (is_16_bit ? ": 16 bits a channel, divided by 257 to 8"
                                : ": floating point, 0 to 1 becomes 0 to 255"));
  image.convertTo(image, CV_8U, is_16_bit ? 1.0 / 257 : 255);
  return image;
}

class ImageFiles final : public ImageSequence {
 public:
  ImageFiles(Paths paths, Reading reading)
      : paths_(std::move(paths)), reading_(std::move(reading)) {}
  SequenceImage next() override {
    if (at_ == paths_.size()) return {};
    const std::string path = paths_[at_++].string();
    // A single image is sent repeatedly, and read again only when it changes.
    const auto stamp = hc::file_stamp(path);
    if (paths_.size() == 1 && !image_.empty() && stamp == stamp_) return {image_};
    auto image = read_image(path, reading_);
    if (image) {
      image_ = std::move(*image);
      stamp_ = stamp;
    } else if (paths_.size() > 1 || image_.empty()) {
      refuse(path, image.error().detail);
    } else {
      reading_.log("not readable", path + ": " + image.error().detail + ": stays as it was");
    }
    return {image_};
  }
  void rewind() override { at_ = 0; }

 private:
  Paths paths_;
  Reading reading_;
  std::size_t at_ = 0;
  cv::Mat image_;
  hc::FileStamp stamp_;
};

class Capture final : public ImageSequence {
 public:
  Capture(std::string name, bool upright) : name_(std::move(name)), upright_(upright) { open(); }
  SequenceImage next() override {
    SequenceImage next;
    if (!capture_.read(next.image)) {
      if (!any_) fail("no image in it");
      return {};
    }
    if (has_times_) next.at = time_of_image();
    any_ = true;
    return next;
  }
  void rewind() override { open(); }
  [[nodiscard]] std::optional<std::chrono::nanoseconds> length() const override {
    return has_times_ ? std::optional(last_ + period_) : std::nullopt;
  }

 private:
  void open() {
    const bool is_pipeline = name_.find('!') != std::string::npos;
    any_ = false;
    if (!capture_.open(name_, is_pipeline ? cv::CAP_GSTREAMER : cv::CAP_ANY))
      fail("cannot be opened as a video, folder or image");
    capture_.set(cv::CAP_PROP_ORIENTATION_AUTO, upright_ ? 1 : 0);
    const double rate = capture_.get(cv::CAP_PROP_FPS);
    // What has a length is a recording. A pattern of image files has no times of its own.
    std::error_code unreadable;
    const bool is_recorded =
        !is_pipeline && name_.find('%') == std::string::npos &&
        (fs::is_regular_file(name_, unreadable) || capture_.get(cv::CAP_PROP_FRAME_COUNT) > 0);
    has_times_ = is_recorded && rate > 0 && std::isfinite(rate);
    if (has_times_) period_ = hc::duration(1 / rate);
  }

  /// A file stays as it is; what a pipeline or URL leads to may come later.
  [[noreturn]] void fail(const std::string& why) const {
    std::error_code unreadable;
    if (fs::is_regular_file(name_, unreadable)) refuse(name_, why);
    throw hc::ModuleError(name_ + ": " + why);
  }

  /// The decoder does not know the times of all images, such as those that it gives at the end.
  std::chrono::nanoseconds time_of_image() {
    auto time = hc::duration(capture_.get(cv::CAP_PROP_POS_MSEC) / 1000);
    if (any_ && time <= last_) time = last_ + period_;
    if (any_) period_ = time - last_;
    return last_ = time;
  }

  std::string name_;
  bool upright_;
  cv::VideoCapture capture_;
  bool any_ = false;  // at least one image was read
  bool has_times_ = false;
  std::chrono::nanoseconds last_{0}, period_{0};  // of the last image, and from the one before
};

bool is_folder(const std::string& name) {
  std::error_code unreadable;
  return fs::is_directory(name, unreadable);
}

/// Whether a file is an image, or has its name and is empty or damaged.
bool is_image(const std::string& path) {
  return cv::haveImageReader(path) || cv::haveImageWriter(path);
}

Paths images_in(const std::string& folder) {
  Paths paths;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const bool is_hidden = entry.path().filename().string().starts_with('.');
    const bool may_be_file = entry.is_regular_file() || !entry.exists();
    if (!is_hidden && may_be_file && is_image(entry.path().string())) paths.push_back(entry.path());
  }
  if (paths.empty()) refuse(folder, "no images in this folder");
  std::ranges::sort(paths, hc::natural_less, [](const fs::path& path) { return path.string(); });
  return paths;
}

/// The images without a partner, the first few by name.
std::string remark_on(const Paths& alone) {
  constexpr std::size_t kNamed = 5;
  if (alone.empty()) return "";
  std::string text = std::to_string(alone.size()) + (alone.size() == 1 ? " image" : " images") +
                     " without a partner, not sent:";
  for (std::size_t i = 0; i < std::min(kNamed, alone.size()); ++i) text += " " + alone[i].string();
  return alone.size() > kNamed ? text + " …" : text;
}

}  // namespace

std::unique_ptr<ImageSequence> open_sequence(const std::string& name, const Reading& reading) {
  std::error_code unreadable;
  // Not a pipeline, a URL, or a pattern like frame_%04d.png.
  const bool is_path =
      name.find_first_of("!%") == std::string::npos && name.find("://") == std::string::npos;
  if (is_path && !fs::exists(name, unreadable)) refuse(name, "no such file, folder or camera");
  if (is_folder(name)) return std::make_unique<ImageFiles>(images_in(name), reading);
  if (fs::is_regular_file(name, unreadable) && is_image(name))
    return std::make_unique<ImageFiles>(Paths{name}, reading);
  return std::make_unique<Capture>(name, reading.upright);
}

SequencePair open_sequences(const std::string& left, const std::string& right,
                            const Reading& reading) {
  if (!is_folder(left) || !is_folder(right)) {
    auto one = open_sequence(left, reading), other = open_sequence(right, reading);
    return {std::move(one), std::move(other)};
  }
  auto partners = partners_of(images_in(left), images_in(right));
  if (partners.left.empty()) refuse(right, "no image has the name or the number of one in " + left);
  return {std::make_unique<ImageFiles>(std::move(partners.left), reading),
          std::make_unique<ImageFiles>(std::move(partners.right), reading),
          remark_on(partners.alone)};
}
