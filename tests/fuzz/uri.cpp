// SPDX-License-Identifier: Apache-2.0
// Any text: what is a URI is the same URI when it is written and read again.
#include <hc/base/uri.h>

int fuzz_uri(const std::uint8_t* data, std::size_t size) {
  std::string_view text{reinterpret_cast<const char*>(data), size};
  static_cast<void>(hc::parse_host_port(text));
  auto uri = hc::parse_uri(text);
  if (!uri) return 0;
  if (uri->text().size() > 4096)
    return 0;  // `file:` was added to a path that was as long as can be
  auto again = hc::parse_uri(uri->text());
  HC_CHECK(again && again->scheme == uri->scheme && again->rest == uri->rest, text);
  HC_CHECK(again->options == uri->options, text);
  return 0;
}
