// SPDX-License-Identifier: Apache-2.0
#include "camera.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include <hc/module/module.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

namespace {

namespace fs = std::filesystem;

class PictureFiles final : public PictureSource {
 public:
  explicit PictureFiles(std::vector<std::string> paths) : paths_(std::move(paths)) {}
  cv::Mat next() override {
    if (at_ == paths_.size()) return {};
    cv::Mat picture = cv::imread(paths_[at_]);
    if (picture.empty()) throw hc::ModuleError(paths_[at_] + ": not a picture that can be read");
    ++at_;
    return picture;
  }
  bool rewind() override {
    at_ = 0;
    return true;
  }

 private:
  std::vector<std::string> paths_;
  std::size_t at_ = 0;
};

class Capture final : public PictureSource {
 public:
  explicit Capture(std::string name) : name_(std::move(name)) { open(); }
  cv::Mat next() override {
    cv::Mat picture;
    if (!capture_.read(picture)) {
      if (is_device_ || !any_) throw hc::ModuleError(name_ + ": gives no picture");
      return {};
    }
    any_ = true;
    return picture;
  }
  bool rewind() override {
    if (is_device_) return false;
    open();
    return true;
  }

 private:
  void open() {
    bool is_number = !name_.empty() && std::all_of(name_.begin(), name_.end(),
                                                   [](char c) { return c >= '0' && c <= '9'; });
    std::string path = is_number ? "/dev/video" + name_ : name_;
    is_device_ = path.starts_with("/dev/");
    bool is_pipeline = name_.find('!') != std::string::npos;
    int backend = is_device_ ? cv::CAP_V4L2 : is_pipeline ? cv::CAP_GSTREAMER : cv::CAP_ANY;
    any_ = false;
    if (!capture_.open(path, backend))
      throw hc::ModuleError(name_ + ": cannot be opened as a camera, video, folder or picture");
  }

  std::string name_;
  cv::VideoCapture capture_;
  bool is_device_ = false;
  bool any_ = false;  // a picture has come
};

std::vector<std::string> pictures_in(const std::string& folder) {
  std::vector<std::string> paths;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && cv::haveImageReader(entry.path().string()))
      paths.push_back(entry.path().string());
  if (paths.empty()) throw hc::ModuleError(folder + ": no pictures in this folder");
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

std::unique_ptr<PictureSource> open_picture_source(const std::string& name) {
  std::error_code unreadable;
  if (fs::is_directory(name, unreadable)) return std::make_unique<PictureFiles>(pictures_in(name));
  if (fs::is_regular_file(name, unreadable) && cv::haveImageReader(name))
    return std::make_unique<PictureFiles>(std::vector<std::string>{name});
  return std::make_unique<Capture>(name);
}
