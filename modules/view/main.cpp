// SPDX-License-Identifier: Apache-2.0
// Shows images in a window and saves them as PNG files.
#include <csignal>
#include <filesystem>
#include <memory>
#include <system_error>
#include <thread>
#include <utility>

#include <client/running.h>
#include <hc/module/module.h>
#include <hc/os/new_file.h>
#include <hc/os/program.h>
#include <transports/all.h>
#include <vision/image.h>
#include <vision/messages.h>
#include <vision/stereo/display.h>
#include <vision/window.h>
#include <opencv2/imgproc.hpp>

namespace {

/// Images of both eyes at the same time.
struct Eyes {
  hc::Header header;
  cv::Mat left, right;
};

/// An image to save, (H, W, 3) u8 blue, green, red.
struct Picture {
  std::filesystem::path path;
  cv::Mat bgr;
};

bool is_right(const hc::Header& header) {
  return header.coord == hc::Coord::kRightImage || header.coord == hc::Coord::kRightRectified;
}

const char* unit_of(const hc::Header& header) {
  return header.coord == hc::Coord::kDepth       ? "m"
         : header.coord == hc::Coord::kDisparity ? "px"
                                                 : "";
}

std::vector<std::string> layouts() {
  std::vector<std::string> names = {"none"};
  for (const auto layout : hc::vision::stereo_layouts()) names.emplace_back(layout);
  return names;
}

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  namespace fs = std::filesystem;
  hc::Module module{"view", "Shows images in a window and saves them as PNG files.", {.finish_when_stopped = true}};
  auto image =
      module.input("image",
                   hc::any_of(hc::rgb_image(), hc::intensity_image(),
                              hc::intensity_image<std::uint16_t>(), hc::intensity_image<float>()),
                   "an image; other than u8 in colours, blue for small values");
  auto save = module.parameter("save", "", "",
                               "PNG file for the latest image, replaced once a second and at the "
                               "end, or folder/ for all as SRC_SEQ.png",
                               {.positional = true});
  auto window = module.parameter("window", "auto", "", "show a window",
                                 {.choices = {"auto", "yes", "no"}, .fixed = true});
  auto monitor = module.parameter("monitor", -1, "", "monitor for full screen, from 0; -1: windows",
                                  {.min = -1, .max = 15, .fixed = true});
  auto stay = module.parameter("stay", true, "",
                               "keep windows after the last image, until a key is pressed");
  auto stereo = module.parameter("stereo", "none", "",
                                 "how the images of both eyes (by coordinate system) become one",
                                 {.choices = layouts()});
  auto relief = module.parameter("relief", false, "", "shade depth as a relief");
  auto legend = module.parameter("legend", true, "", "a scale beside images in colours");
  auto min =
      module.parameter("min", 0.0, "", "lower end of the colour scale; both 0: from the image");
  auto max =
      module.parameter("max", 0.0, "", "upper end of the colour scale; both 0: from the image");
  auto count =
      module.parameter("count", 0, "", "end after this number of images, 0: never", {.min = 0});

  std::unique_ptr<hc::vision::Display> display;
  int seen = 0;
  Eyes eyes;
  fs::path last;    // saved
  Picture unsaved;  // the latest, while the file has an older one
  bool has_failed = false;
  bool is_fresh = false;  // the file was replaced less than a pause ago
  module.on_start([&] {
    if (*min > *max) throw hc::ModuleError("min is above max");
    if (*window == "yes" || (*window == "auto" && save->empty())) {
      auto opened = hc::vision::Display::open(static_cast<int>(*monitor));
      if (opened)
        display = std::move(*opened);
      else if (*window == "yes")
        throw hc::ModuleError("window: " + opened.error().detail);
    }
    if (!display && save->empty() && *window != "no")
      throw hc::ModuleError("no display for a window and no file to save to: give --save");
  });

  /// In blue, green, red.
  auto visible = [&](const hc::Header& header, const cv::Mat& values) {
    cv::Mat bgr;
    if (values.depth() == CV_8U) {
      if (values.channels() == 1) return values;
      cv::cvtColor(values, bgr, cv::COLOR_RGB2BGR);
      return bgr;
    }
    hc::vision::Span span{*min, *max};
    if (span.least == 0 && span.most == 0) span = hc::vision::span_of(values);
    cv::cvtColor(hc::vision::colour_coded(values, span.least, span.most), bgr, cv::COLOR_RGB2BGR);
    if (*relief && values.type() == CV_32F) hc::vision::shade(bgr, values);
    if (!*legend) return bgr;
    return hc::vision::with_legend(bgr, span.least, span.most, unit_of(header));
  };
  auto is_free = [](const std::string& path) {
    std::error_code unknown;  // writing reports errors
    return !fs::exists(path, unknown);
  };
  auto write = [&](const Picture& picture) {
    auto saved = hc::vision::save_image(picture.path, picture.bgr);
    if (saved) last = picture.path;
    if (!saved && !std::exchange(has_failed, true))  // continue: a later image may succeed
      module.log("not all images saved: " + saved.error().detail, hc::Level::Error);
  };
  // Compressing an image takes longer than computing most.
  auto write_latest = [&] {
    if (!unsaved.bgr.empty()) write(unsaved);
    unsaved = {};
  };
  hc::Timeout pause = module.after(std::chrono::seconds(1), [&] {
    is_fresh = !unsaved.bgr.empty();
    write_latest();
    if (is_fresh) pause.restart();
  });
  auto show = [&](const hc::Header& header, const cv::Mat& bgr) {
    if (save->ends_with('/')) {
      const std::string file =
          std::to_string(header.src) + "_" + std::to_string(header.seq) + ".png";
      write({hc::free_name(fs::path(*save) / file, ".png", is_free), bgr});
    } else if (!save->empty()) {
      unsaved = {*save, bgr.clone()};
      if (!is_fresh) pause.restart(std::chrono::nanoseconds(0));
    }
    if (display) {
      display->show("hypercolumn " + std::to_string(header.src), bgr);
      display->any_open();
    }
    if (++seen == *count) std::raise(SIGTERM);
  };
  module.on(image, [&](const hc::Message& message) {
    const hc::Header& header = message.header;
    if (header.empty() || (*count > 0 && seen == *count)) return;
    const cv::Mat bgr = visible(header, hc::value_or_drop(hc::as_mat(message)));
    if (*stereo == "none") return show(header, bgr);
    if (header.time != eyes.header.time) eyes = {header, {}, {}};
    (is_right(header) ? eyes.right : eyes.left) = bgr.clone();
    if (eyes.left.empty() || eyes.right.empty()) return;
    if (eyes.left.size() != eyes.right.size() || eyes.left.type() != eyes.right.type())
      return module.log_once("stereo", "the images of both eyes have different sizes or types");
    // Interleaved rows must not be scaled afterwards, so scale before.
    if (display && *stereo == "rows" && !display->monitor_size().empty())
      for (cv::Mat* eye : {&eyes.left, &eyes.right})
        cv::resize(*eye, *eye, display->monitor_size());
    show(eyes.header, hc::vision::join_eyes(eyes.left, eyes.right, *stereo));
    eyes = {};
  });
  module.on_end([&] {
    write_latest();
    constexpr std::chrono::milliseconds kPause{20};  // between checks for a signal
    while (display && *stay && !hc::stop_requested() && display->any_open())
      std::this_thread::sleep_for(kPause);
  });
  const int status = module.run(argc, argv);
  if (!last.empty()) module.log("image saved to " + fs::absolute(last).string(), hc::Level::Result);
  return status == 0 && has_failed && !hc::own_graph() ? 1 : status;
}
