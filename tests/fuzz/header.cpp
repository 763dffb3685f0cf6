// SPDX-License-Identifier: Apache-2.0
// Any line: what is a header comes back as its canonical line, and that reads as the same header.
#include <hc/base/check.h>
#include <hc/mtp/header.h>

int fuzz_header(const std::uint8_t* data, std::size_t size) {
  std::string_view line{reinterpret_cast<const char*>(data), size};
  if (size > hc::kMaxHeaderBytes || line.find('\n') != std::string_view::npos) return 0;
  auto header = hc::parse_header(line);
  if (!header) return 0;
  HC_CHECK(hc::check(*header), line);
  auto again = hc::parse_header(hc::text(*header));
  HC_CHECK(again && *again == *header, line);
  return 0;
}
