// SPDX-License-Identifier: Apache-2.0
#include "sequence.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include <hc/module/module.h>
#include <hc/os/file_stamp.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

namespace {

namespace fs = std::filesystem;

/// A missing or wrong file, which a restart would not cure.
hc::ModuleError unusable(const std::string& name, const std::string& why) {
  return hc::ModuleError(hc::Error{hc::Code::Invalid, name + ": " + why});
}

class ImageFiles final : public ImageSequence {
 public:
  explicit ImageFiles(std::vector<std::string> paths) : paths_(std::move(paths)) {}
  cv::Mat next() override {
    if (at_ == paths_.size()) return {};
    const std::string& path = paths_[at_++];
    // A single image is sent repeatedly, and read again only when it changes.
    const auto stamp = hc::file_stamp(path);
    if (paths_.size() > 1 || image_.empty() || stamp != stamp_) image_ = cv::imread(path);
    if (image_.empty()) throw unusable(path, "not a readable image");
    stamp_ = stamp;
    return image_;
  }
  void rewind() override { at_ = 0; }

 private:
  std::vector<std::string> paths_;
  std::size_t at_ = 0;
  cv::Mat image_;
  hc::FileStamp stamp_;
};

class Capture final : public ImageSequence {
 public:
  explicit Capture(std::string name) : name_(std::move(name)) { rewind(); }
  cv::Mat next() override {
    cv::Mat image;
    if (!capture_.read(image) && !any_) throw hc::ModuleError(name_ + ": no image in it");
    any_ = true;
    return image;
  }
  void rewind() override {
    const bool is_pipeline = name_.find('!') != std::string::npos;
    any_ = false;
    if (!capture_.open(name_, is_pipeline ? cv::CAP_GSTREAMER : cv::CAP_ANY))
      throw hc::ModuleError(name_ + ": cannot be opened as a video, folder or image");
  }

 private:
  std::string name_;
  cv::VideoCapture capture_;
  bool any_ = false;  // at least one image was read
};

std::vector<std::string> images_in(const std::string& folder) {
  std::vector<std::string> paths;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && cv::haveImageReader(entry.path().string()))
      paths.push_back(entry.path().string());
  if (paths.empty()) throw unusable(folder, "no images in this folder");
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

std::unique_ptr<ImageSequence> open_sequence(const std::string& name) {
  std::error_code unreadable;
  // Not a pipeline, a URL, or a pattern like frame_%04d.png.
  const bool is_path =
      name.find_first_of("!%") == std::string::npos && name.find("://") == std::string::npos;
  if (is_path && !fs::exists(name, unreadable))
    throw unusable(name, "no such file, folder or camera");
  if (fs::is_directory(name, unreadable)) return std::make_unique<ImageFiles>(images_in(name));
  if (fs::is_regular_file(name, unreadable) && cv::haveImageReader(name))
    return std::make_unique<ImageFiles>(std::vector<std::string>{name});
  return std::make_unique<Capture>(name);
}
