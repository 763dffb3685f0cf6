// SPDX-License-Identifier: Apache-2.0
// The smallest useful module: images in, numbers out. brightness.awk does the same on text.
#include <numeric>

#include <hc/module/module.h>
#include <transports/all.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"brightness", "Measures how bright images are."};
  auto image = module.input("image", hc::image(), "camera image");
  auto mean = module.output("mean", hc::table(), "mean of all its numbers, 0 … 255");

  module.on(image, [&](const hc::Image& image) {
    const auto pixels = image.pixels();
    if (pixels.empty()) return;
    const auto sum = std::accumulate(pixels.begin(), pixels.end(), std::uint64_t{0});
    mean.send(static_cast<double>(sum) / static_cast<double>(pixels.size()));
  });
  return module.run(argc, argv);
}
