// SPDX-License-Identifier: Apache-2.0
#include "saver.h"

#include <string>
#include <system_error>
#include <utility>

#include <vision/window.h>

namespace fs = std::filesystem;

void Saver::save(const std::string& to, const hc::Header& header, const cv::Mat& bgr) {
  if (!to.empty() && !is_place(to)) {
    fail(to + " is neither a .png nor a folder/");
  } else if (to.ends_with('/')) {
    write({free_place(to, header), bgr});
  } else if (!to.empty()) {
    unsaved_ = {to, bgr.clone()};
    if (!is_fresh_) pause_.restart(std::chrono::nanoseconds(0));
  }
}

/// SRC_SEQ.png. Where there is one, because the source has started again, the images from now on
/// are SRCrun2_SEQ.png: in the natural order, those of a run follow each other.
fs::path Saver::free_place(const std::string& folder, const hc::Header& header) {
  int& run = runs_.try_emplace(header.src, 1).first->second;
  for (;; ++run) {
    const std::string source =
        std::to_string(header.src) + (run == 1 ? "" : "run" + std::to_string(run));
    auto place = fs::path(folder) / (source + "_" + std::to_string(header.seq) + ".png");
    std::error_code unknown;  // writing reports errors
    if (!fs::exists(place, unknown)) return place;
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
  if (!saved) fail(saved.error().detail);  // and continue: a later image may succeed
}

void Saver::fail(const std::string& why) {
  if (!std::exchange(has_failed_, true))
    module_.log("not all images saved: " + why, hc::Level::Error);
}
