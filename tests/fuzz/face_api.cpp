// SPDX-License-Identifier: Apache-2.0
// Any manifest, and behind its first 0 any weights: the layers of the network, or one clear error.
#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>

#include <hc/base/check.h>
#include <nets/face_api.h>
#include <nets/shapes.h>

int fuzz_face_api(const std::uint8_t* data, std::size_t size) {
  const auto* end = std::find(data, data + size, std::uint8_t{0});
  const std::string_view manifest(reinterpret_cast<const char*>(data),
                                  static_cast<std::size_t>(end - data));
  const auto weights = std::span(end, data + size).subspan(end < data + size ? 1 : 0);
  const auto layers = hc::nets::read_face_recognition(manifest, std::as_bytes(weights));
  if (layers)
    HC_CHECK(hc::nets::check_shapes(*layers).has_value());
  else
    HC_CHECK(!layers.error().detail.empty());
  return 0;
}
