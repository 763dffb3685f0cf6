// SPDX-License-Identifier: Apache-2.0
#pragma once
// Saves images as PNG files: all into a folder, or the latest into one file, once a second.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include <hc/module/module.h>
#include <opencv2/core.hpp>

class Saver {
 public:
  /// @param module  must outlive it.
  explicit Saver(hc::Module& module) : module_(module) {}

  /// Saves an image, u8: (H, W, 3) blue, green, red, or (H, W) grey.
  /// @param to  a place, or "": nothing is saved. Another name is logged once as a failure.
  void save(const std::string& to, const hc::Header& header, const cv::Mat& bgr);
  /// Whether a name is FILE.png or folder/; another file may be a recording, and stays as it is.
  [[nodiscard]] static bool is_place(std::string_view name) {
    return name.ends_with('/') || name.ends_with(".png");
  }
  /// Saves the latest image that is not in the file yet.
  void save_latest();

  /// Whether an image could not be saved.
  [[nodiscard]] bool has_failed() const { return has_failed_; }
  /// Where the last image was saved; empty: none was.
  [[nodiscard]] const std::filesystem::path& last() const { return last_; }

 private:
  struct Picture {
    std::filesystem::path path;
    cv::Mat bgr;
  };
  std::filesystem::path free_place(const std::string& folder, const hc::Header& header);
  void write(const Picture& picture);
  void fail(const std::string& why);
  void end_pause();

  hc::Module& module_;
  std::map<std::int32_t, int> runs_;  // of each source, in a folder
  std::filesystem::path last_;
  Picture unsaved_;  // the latest, while the file has an older one
  bool has_failed_ = false;
  bool is_fresh_ = false;  // the file was replaced less than a pause ago
  // Compressing an image takes longer than computing most.
  hc::Timeout pause_ = module_.after(std::chrono::seconds(1), [this] { end_pause(); });
};
