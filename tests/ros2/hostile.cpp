// SPDX-License-Identifier: Apache-2.0
// hostile_peer: sends what is no message on /peer/TYPE, of each type: random bytes, lengths that
// are not kept, none at all, other encodings, too many. Until its standard input ends.

#include <poll.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "names.h"
#include "participant.h"

int main() {
  const std::function<void(std::string_view)> log = [](std::string_view) {};
  auto participant = Participant::open(
      {.domain = static_cast<std::uint32_t>(std::atoi(std::getenv("ROS_DOMAIN_ID")))}, log);
  if (!participant) return 1;
  std::vector<Writer> writers;
  for (const auto& schema : hc::ros::schemas()) {
    if (hash_of(schema.type).empty()) continue;
    auto writer =
        (*participant)
            ->write("/peer/" + schema.name.substr(schema.name.rfind('/') + 1), schema.type, {});
    if (!writer) return 1;
    writers.push_back(std::move(*writer));
  }
  std::mt19937 random(3);
  constexpr std::size_t kSizes[] = {0, 1, 3, 4, 5, 20, 100, 5000, 3'000'000};
  pollfd end = {STDIN_FILENO, POLLIN, 0};
  for (std::size_t round = 0; ::poll(&end, 1, 20) == 0; ++round) {
    std::vector<std::byte> bytes(kSizes[round % std::size(kSizes)]);
    const bool is_promising = round / std::size(kSizes) % 2 == 0;
    for (auto& each : bytes)
      each = is_promising ? std::byte{0xFF} : static_cast<std::byte>(random());
    if (bytes.size() > 4 && round % 4 != 3) bytes[0] = std::byte{0}, bytes[1] = std::byte{1};
    for (auto& writer : writers) static_cast<void>(writer.write({bytes, {}, {}}));
  }
  return 0;
}
