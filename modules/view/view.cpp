// SPDX-License-Identifier: Apache-2.0
#include "view.h"

#include <chrono>
#include <csignal>
#include <cstddef>
#include <filesystem>
#include <thread>
#include <utility>

#include <client/running.h>
#include <hc/os/program.h>
#include <vision/image.h>
#include <vision/messages.h>
#include <vision/stereo/display.h>
#include <opencv2/imgproc.hpp>

namespace {

const char* unit_of(const hc::Header& header) {
  if (header.coord == hc::Coord::kDisparity) return "px";
  return header.coord == hc::Coord::kDepth || header.coord == hc::Coord::kRightDepth ? "m" : "";
}

std::string size_of(const hc::Header& header) {
  return std::to_string(header.width) + " x " + std::to_string(header.height);
}

/// An image u8 in blue, green, red, or grey.
cv::Mat bgr_of(const hc::Message& message) {
  const cv::Mat rgb = hc::value_or_drop(hc::as_mat(message));
  if (rgb.channels() == 1) return rgb;
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  return bgr;
}

}  // namespace

std::vector<std::string> ViewParameters::layouts() {
  std::vector<std::string> names = {"none"};
  for (const auto layout : hc::vision::stereo_layouts()) names.emplace_back(layout);
  return names;
}

std::vector<std::string> ViewParameters::codings() {
  std::vector<std::string> names;
  for (const auto coding : hc::vision::depth_codings()) names.emplace_back(coding);
  return names;
}

ImageView::ImageView(hc::Module& module) : module_(module) {
  module.on_start([this] { start(); });
  module.on(image_, [this](const hc::Message& message) { take(message); });
  module.on_end([this] { end(); });
}

void ImageView::start() {
  const auto &window = *parameters_.window, &save = *parameters_.save;
  std::string why = "no display";
  if (*parameters_.min > *parameters_.max) hc::refuse(parameters_.min, "it is above max");
  if (!save.empty() && !Saver::is_place(save))
    hc::refuse(parameters_.save, save + " is neither a .png nor a folder/");
  if (window == "yes" || (window == "auto" && save.empty())) {
    auto opened = hc::vision::Display::open(static_cast<int>(*parameters_.monitor));
    if (opened)
      display_ = std::move(*opened);
    else if (why = opened.error().detail; window == "yes")
      throw hc::ModuleError("window: " + why);
  }
  if (!display_ && save.empty() && window != "no")
    throw hc::ModuleError("window: " + why + "; to save images instead, give --save");
}

void ImageView::take(const hc::Message& message) {
  const hc::Header& header = message.header;
  const auto count = *parameters_.count;
  if (header.empty() || (count > 0 && seen_ == count)) return;
  const bool is_pair = *parameters_.stereo != "none", is_fog = *parameters_.coding == "fog";
  if (eyes_ == nullptr || !eyes_->is(is_pair, is_fog))
    eyes_ = std::make_unique<EyeSets>(is_pair, is_fog, [this](auto set) { take_set(set); });
  if (eyes_->is_whole(header)) return show(header, visible({&message, 1}, {}).front());
  eyes_->push(message);
  log_missing(false);
}

void ImageView::take_set(std::span<const hc::Message> set) {
  const bool is_fog = *parameters_.coding == "fog";
  const std::size_t depths = is_fog ? set.size() / 2 : 0;
  const auto shown = set.subspan(depths), images = set.first(depths);
  const auto first = size_of(set.front().header);
  for (const hc::Message& each : set)
    if (const auto size = size_of(each.header); size != first)
      return module_.log_once("different sizes",
                              "not shown, since the images of both eyes and their depths must have "
                              "one size: " +
                                  first + " and " + size);
  auto eyes = visible(shown, images);
  if (const cv::Mat joined = join(eyes); !joined.empty()) show(shown.front().header, joined);
}

cv::Mat ImageView::join(std::span<cv::Mat> eyes) {
  const auto& layout = *parameters_.stereo;
  if (eyes.size() == 1) return eyes.front();
  if (eyes[0].type() != eyes[1].type()) {
    module_.log_once("different types", "one eye's image is grey, the other's in colours");
    return {};
  }
  // Interleaved rows must not be scaled afterwards, so scale before.
  if (display_ && layout == "rows" && !display_->monitor_size().empty())
    for (cv::Mat& eye : eyes) cv::resize(eye, eye, display_->monitor_size());
  return hc::vision::join_eyes(eyes[0], eyes[1], layout);
}

void ImageView::log_missing(bool is_end) {
  const auto names = eyes_ == nullptr ? "" : eyes_->missing(is_end);
  if (!names.empty())
    module_.log_once("incomplete",
                     "not shown, since there is no " + names + ": link it to the input image");
}

void ImageView::show(const hc::Header& header, const cv::Mat& bgr) {
  saver_.save(*parameters_.save, header, bgr);
  if (display_) {
    display_->show("hypercolumn " + std::to_string(header.src), bgr);
    display_->any_open();
  }
  if (++seen_ == *parameters_.count) std::raise(SIGTERM);
}

std::vector<cv::Mat> ImageView::visible(std::span<const hc::Message> shown,
                                        std::span<const hc::Message> images) const {
  std::vector<cv::Mat> found;
  cv::Mat measured;  // by both eyes: a common scale gives a point one colour
  for (const hc::Message& each : shown) {
    found.push_back(hc::value_or_drop(hc::as_mat(each)));
    if (found.back().depth() == CV_8U) continue;
    found.back().convertTo(found.back(), CV_32F);
    measured.push_back(found.back());
  }
  hc::vision::Span span{*parameters_.min, *parameters_.max};
  if (span.least == 0 && span.most == 0 && !measured.empty()) span = hc::vision::span_of(measured);
  const std::string coding =
      images.empty() && *parameters_.coding == "fog" ? "colours" : *parameters_.coding;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i].depth() == CV_8U) {
      found[i] = bgr_of(shown[i]);
      continue;
    }
    cv::Mat image = images.empty() ? cv::Mat() : bgr_of(images[i]);
    if (!image.empty() && image.channels() == 1) cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
    found[i] = hc::vision::coded(found[i], image, coding, span);
    if (*parameters_.legend)
      found[i] = hc::vision::with_legend(found[i], coding, span, unit_of(shown[i].header));
  }
  return found;
}

void ImageView::end() {
  log_missing(true);
  saver_.save_latest();
  constexpr std::chrono::milliseconds kPause{20};  // between checks for a signal
  while (display_ && *parameters_.stay && !hc::stop_requested() && display_->any_open())
    std::this_thread::sleep_for(kPause);
}

int ImageView::finish(int status) const {
  if (const auto& last = saver_.last(); !last.empty())
    module_.log("image saved to " + std::filesystem::absolute(last).string(), hc::Level::Result);
  return status == 0 && saver_.has_failed() && !hc::own_graph() ? 1 : status;
}
