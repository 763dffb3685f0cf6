// SPDX-License-Identifier: Apache-2.0
#include <graph/run/drain.h>

#include <algorithm>
#include <array>

namespace hc::internal {

Result<std::unique_ptr<Intake>> make_drain(Loop& loop, const std::string& reader_uri) {
  auto uri = parse_uri(reader_uri);
  if (!uri) return uri.error();
  constexpr std::array<std::string_view, 4> kWhoMay = {"same_user", "key", "peer", "interface"};
  std::erase_if(uri->options, [&](const auto& option) {
    return std::find(kWhoMay.begin(), kWhoMay.end(), option.first) == kWhoMay.end();
  });
  uri->options.emplace_back("reconnect", "86400");
  if (uri->scheme == "shm" || uri->scheme == "dds") uri->options.emplace_back("keep", "latest");
  return Intake::make(
      loop, uri->text(), [](const Message&) {}, {}, false);
}

}  // namespace hc::internal
