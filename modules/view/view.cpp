// SPDX-License-Identifier: Apache-2.0
#include "view.h"

#include <chrono>
#include <csignal>
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

bool is_right(const hc::Header& header) {
  return header.coord == hc::Coord::kRightImage || header.coord == hc::Coord::kRightRectified;
}

const char* unit_of(const hc::Header& header) {
  return header.coord == hc::Coord::kDepth       ? "m"
         : header.coord == hc::Coord::kDisparity ? "px"
                                                 : "";
}

}  // namespace

std::vector<std::string> ViewParameters::layouts() {
  std::vector<std::string> names = {"none"};
  for (const auto layout : hc::vision::stereo_layouts()) names.emplace_back(layout);
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
  if (*parameters_.min > *parameters_.max) throw hc::ModuleError("min is above max");
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
  const cv::Mat bgr = visible(header, hc::value_or_drop(hc::as_mat(message)));
  if (*parameters_.stereo == "none")
    show(header, bgr);
  else
    join(header, bgr);
}

void ImageView::join(const hc::Header& header, const cv::Mat& bgr) {
  const auto& layout = *parameters_.stereo;
  auto& [first, left, right] = eyes_;
  if (header.time != first.time) eyes_ = {header, {}, {}};
  (is_right(header) ? right : left) = bgr.clone();
  if (left.empty() || right.empty()) return;
  if (left.size() != right.size() || left.type() != right.type())
    return module_.log_once("stereo", "the images of both eyes have different sizes or types");
  // Interleaved rows must not be scaled afterwards, so scale before.
  if (display_ && layout == "rows" && !display_->monitor_size().empty())
    for (cv::Mat* eye : {&left, &right}) cv::resize(*eye, *eye, display_->monitor_size());
  show(first, hc::vision::join_eyes(left, right, layout));
  eyes_ = {};
}

void ImageView::show(const hc::Header& header, const cv::Mat& bgr) {
  saver_.save(*parameters_.save, header, bgr);
  if (display_) {
    display_->show("hypercolumn " + std::to_string(header.src), bgr);
    display_->any_open();
  }
  if (++seen_ == *parameters_.count) std::raise(SIGTERM);
}

cv::Mat ImageView::visible(const hc::Header& header, const cv::Mat& values) const {
  cv::Mat bgr;
  if (values.depth() == CV_8U) {
    if (values.channels() == 1) return values;
    cv::cvtColor(values, bgr, cv::COLOR_RGB2BGR);
    return bgr;
  }
  hc::vision::Span span{*parameters_.min, *parameters_.max};
  if (span.least == 0 && span.most == 0) span = hc::vision::span_of(values);
  cv::cvtColor(hc::vision::colour_coded(values, span.least, span.most), bgr, cv::COLOR_RGB2BGR);
  if (*parameters_.relief && values.type() == CV_32F) hc::vision::shade(bgr, values);
  if (!*parameters_.legend) return bgr;
  return hc::vision::with_legend(bgr, span.least, span.most, unit_of(header));
}

void ImageView::end() {
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
