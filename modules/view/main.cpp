// SPDX-License-Identifier: Apache-2.0
// Shows images in a window and saves them as PNG files.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <set>

#include <hc/module/module.h>
#include <hc/os/program.h>
#include <vision/image.h>
#include <vision/messages.h>
#include <vision/window.h>
#include <opencv2/highgui.hpp>

int main(int argc, char** argv) {
  namespace fs = std::filesystem;
  hc::Module module{"view", "Shows images in a window and saves them as PNG files."};
  auto image =
      module.input("image",
                   hc::any_of(hc::rgb_image<std::uint8_t>(), hc::intensity_image<std::uint8_t>(),
                              hc::intensity_image<std::uint16_t>(), hc::intensity_image<float>()),
                   "an image; other than u8 in colours, blue for small values");
  auto save = module.parameter("save", "", "",
                               "PNG file for the latest image, or folder/ for all as SRC_SEQ.png",
                               {.positional = true});
  auto window = module.parameter("window", "auto", "", "show a window",
                                 {.choices = {"auto", "yes", "no"}, .fixed = true});
  auto stay = module.parameter("stay", true, "",
                               "keep windows after the last image, until a key is pressed");
  auto min =
      module.parameter("min", 0.0, "", "lower end of the colour scale; both 0: from the image");
  auto max =
      module.parameter("max", 0.0, "", "upper end of the colour scale; both 0: from the image");

  auto count = module.parameter("count", 0, "", "end after so many images, 0: never", {.min = 0});

  bool shows = false;
  int seen = 0;
  std::set<std::string> windows;
  fs::path last;  // that was saved
  module.on_start([&] {
    if (*min > *max) throw hc::ModuleError("min is above max");
    bool wants_window = *window == "yes" || (*window == "auto" && save->empty());
    shows = wants_window && hc::vision::has_display();
    if (*window == "yes" && !shows) throw hc::ModuleError("window: there is no display");
    if (!shows && save->empty())
      throw hc::ModuleError("no display for a window and no file to save to: give --save");
  });

  module.on(image, [&](const hc::Message& message) {
    const hc::Header& header = message.header;
    if (header.empty() || (*count > 0 && seen == *count)) return;
    const cv::Mat bgr = hc::vision::displayable(hc::value_or_end(hc::as_mat(message)), *min, *max);
    if (!save->empty()) {
      bool all = save->ends_with('/');
      std::string file = std::to_string(header.src) + "_" + std::to_string(header.seq) + ".png";
      last = all ? fs::path(*save) / file : fs::path(*save);
      if (auto saved = hc::vision::save_image(last, bgr); !saved)
        throw hc::ModuleError(saved.error());
    }
    if (shows) {
      std::string title = "hypercolumn " + std::to_string(header.src);
      cv::imshow(title, bgr);
      cv::pollKey();
      windows.insert(title);
    }
    if (++seen == *count) std::raise(SIGTERM);  // as anybody else would end it
  });
  module.on_end([&] {
    auto is_open = [](const std::string& title) {
      return cv::getWindowProperty(title, cv::WND_PROP_VISIBLE) >= 1;
    };
    constexpr int kPause = 50;  // [ms] between looks for a signal
    while (*stay && !hc::stop_requested() && std::any_of(windows.begin(), windows.end(), is_open))
      if (cv::waitKey(kPause) >= 0) break;
  });
  const int status = module.run(argc, argv);
  if (!last.empty()) module.log("result: image saved to " + fs::absolute(last).string());
  return status;
}
