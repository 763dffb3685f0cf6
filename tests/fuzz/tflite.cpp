// SPDX-License-Identifier: Apache-2.0
// Any file of TensorFlow Lite: layers that can be computed, or one clear error.
#include <array>
#include <cstdint>
#include <span>

#include <hc/base/check.h>
#include <nets/network.h>
#include <nets/shapes.h>
#include <nets/tflite.h>

int fuzz_tflite(const std::uint8_t* data, std::size_t size) {
  const auto layers = hc::nets::read_tflite(std::as_bytes(std::span(data, size)));
  const auto checked = layers ? hc::nets::check_shapes(*layers) : layers.error();
  if (!checked) {
    HC_CHECK(!checked.error().detail.empty());
    return 0;
  }
  // What is too large or unsupported for another size is refused, too.
  const auto& image = layers->tensors[static_cast<std::size_t>(layers->input)].shape;
  for (const auto& [height, width] :
       {std::array{image[1], image[2] / 3 * 4}, {2 * (image[1] % 65536), image[2]}})
    if (const auto other = hc::nets::resized(*layers, height, width))
      HC_CHECK(hc::nets::check_shapes(*other).has_value());
  long long numbers = 0;
  for (const auto& tensor : layers->tensors) numbers += hc::nets::size_of(tensor.shape);
  if (numbers > 1 << 16) return 0;  // it may take long to compute
  const auto network = hc::nets::Network::make(*layers);
  if (!network) return 0;
  const auto& input = (*network)->input();
  const auto made = (*network)->run(cv::Mat::ones(input[0], input[1], CV_32FC(input[2])));
  for (std::size_t i = 0; i < made.size(); ++i) {
    const auto& shape = layers->tensors[static_cast<std::size_t>(layers->outputs[i])].shape;
    HC_CHECK(static_cast<long long>(made[i].total()) == hc::nets::size_of(shape), i);
  }
  return 0;
}
