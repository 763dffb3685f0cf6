// SPDX-License-Identifier: Apache-2.0
// nets_compute NAME [HEIGHT WIDTH] <INPUTS >OUTPUTS: computes a network of share/hypercolumn/nets
// for images of f32, one after the other, and writes all its outputs for each.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include <nets/network.h>
#include <nets/weights.h>

int main(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "";
  std::optional<std::array<int, 2>> size;
  if (argc > 3) size = {std::atoi(argv[2]), std::atoi(argv[3])};
  const auto network = hc::nets::Network::read(hc::nets::weights_path(name), size);
  if (!network) {
    std::fprintf(stderr, "nets_compute: %s\n", network.error().text().c_str());
    return 1;
  }
  const auto& shape = (*network)->input();
  cv::Mat image(shape[0], shape[1], CV_32FC(shape[2]));
  while (std::fread(image.data, image.elemSize(), image.total(), stdin) == image.total())
    for (const cv::Mat& output : (*network)->run(image))
      if (std::fwrite(output.data, sizeof(float), output.total(), stdout) != output.total())
        return 1;
  return 0;
}
