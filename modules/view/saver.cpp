// SPDX-License-Identifier: Apache-2.0
#include "saver.h"

#include <system_error>
#include <utility>

#include <hc/os/new_file.h>
#include <vision/window.h>

namespace fs = std::filesystem;

void Saver::save(const std::string& to, const hc::Header& header, const cv::Mat& bgr) {
  if (to.ends_with('/')) {
    const std::string file = std::to_string(header.src) + "_" + std::to_string(header.seq) + ".png";
    const auto is_free = [](const std::string& path) {
      std::error_code unknown;  // writing reports errors
      return !fs::exists(path, unknown);
    };
    write({hc::free_name(fs::path(to) / file, ".png", is_free), bgr});
  } else if (!to.empty()) {
    unsaved_ = {to, bgr.clone()};
    if (!is_fresh_) pause_.restart(std::chrono::nanoseconds(0));
  }
}

void Saver::end_pause() {
  is_fresh_ = !unsaved_.bgr.empty();
  save_latest();
  if (is_fresh_) pause_.restart();
}

void Saver::save_latest() {
  if (!unsaved_.bgr.empty()) write(unsaved_);
  unsaved_ = {};
}

void Saver::write(const Picture& picture) {
  auto saved = hc::vision::save_image(picture.path, picture.bgr);
  if (saved) last_ = picture.path;
  if (!saved && !std::exchange(has_failed_, true))  // continue: a later image may succeed
    module_.log("not all images saved: " + saved.error().detail, hc::Level::Error);
}
