// SPDX-License-Identifier: Apache-2.0
// Shows pictures in a window and keeps them as PNG files.
#include <filesystem>
#include <map>

#include <hc/adapter/opencv.h>
#include <hc/node/module.h>
#include <vision/picture.h>
#include <opencv2/highgui.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace {

namespace fs = std::filesystem;

bool has_display() {
  return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

/// Writes a picture so that whoever looks finds a whole one, the last or this.
void write_whole(const fs::path& path, const cv::Mat& bgr) {
  if (path.has_parent_path()) fs::create_directories(path.parent_path());
  fs::path unfinished = path;
  unfinished.replace_extension(".part.png");
  if (!cv::imwrite(unfinished.string(), bgr))
    throw hc::ModuleError(path.string() + ": cannot be written");
  fs::rename(unfinished, path);
}

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"view", "Shows pictures in a window and keeps them as PNG files."};
  auto image =
      module.input("image",
                   hc::any_of(hc::rgb_image<std::uint8_t>(), hc::intensity_image<std::uint8_t>(),
                              hc::intensity_image<std::uint16_t>(), hc::intensity_image<float>()),
                   "picture; anything but u8 is shown in colours, blue for small");
  auto save = module.parameter("save", "", "",
                               "PNG file for the latest picture, or folder/ for all as SRC_SEQ.png",
                               {.positional = true});
  auto window =
      module.parameter("window", "auto", "", "show a window", {.choices = {"auto", "yes", "no"}});
  auto least = module.parameter("least", 0.0, "", "value that is bluest; both 0: from the picture");
  auto most = module.parameter("most", 0.0, "", "value that is reddest; both 0: from the picture");

  bool shows = false;
  module.on_start([&] {
    shows = *window == "yes" || (*window == "auto" && has_display() && save->empty());
    if (shows && !has_display()) throw hc::ModuleError("window: there is no display");
    if (!shows && save->empty())
      throw hc::ModuleError("no display for a window and no file to save to: give --save");
  });

  module.on(image, [&](const hc::Message& picture) {
    const hc::Header& header = picture.header;
    if (header.empty()) return;
    cv::Mat mat = hc::value_or_end(hc::as_mat(picture)), bgr;
    if (mat.depth() != CV_8U)
      cv::cvtColor(hc::vision::colour_coded(mat, *least, *most), bgr, cv::COLOR_RGB2BGR);
    else if (mat.channels() == 3)
      cv::cvtColor(mat, bgr, cv::COLOR_RGB2BGR);
    else
      bgr = mat;
    if (!save->empty()) {
      bool all = save->ends_with('/');
      std::string file = std::to_string(header.src) + "_" + std::to_string(header.seq) + ".png";
      write_whole(all ? fs::path(*save) / file : fs::path(*save), bgr);
    }
    if (shows) {
      cv::imshow("hypercolumn " + std::to_string(header.src), bgr);
      cv::pollKey();
    }
  });
  return module.run(argc, argv);
}
