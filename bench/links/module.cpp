// SPDX-License-Identifier: Apache-2.0
// What a link costs a module in a graph: two of these send a message to and fro, as modules do.
#include <sched.h>

#include <array>
#include <optional>
#include <string>

#include <hc/module/module.h>

#include "harness.h"

namespace {

constexpr std::int32_t kHeaderBytes = 54;  // of a small message; with the line feed at its end
constexpr std::size_t kPorts = 4;

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"turn", "Answers messages; or asks first, and measures how long answers take."};
  auto asks = module.parameter("asks", false, "", "whether to send first, and to measure");
  auto bytes = module.parameter("bytes", 96, "byte", "of each message");
  auto seconds = module.parameter("seconds", 0.25, "s", "how long to measure");
  auto processor = module.parameter("processor", -1, "", "to run on; -1: any");
  auto ports = module.parameter("ports", 1, "", "that are linked, and used in turn");
  auto rate = module.parameter("rate", 0.0, "Hz", "of a timer that does nothing");
  using Kind = decltype(hc::intensity_image());
  std::vector<hc::Input<Kind>> inputs;
  std::vector<hc::Output<Kind>> outputs;
  for (std::size_t i = 0; i < kPorts; ++i) {
    const auto number = std::to_string(i);
    inputs.push_back(module.input("in" + number, hc::intensity_image(), "messages"));
    outputs.push_back(
        module.output("out" + number, hc::intensity_image(), "messages"));
  }
  std::optional<hc::MessageOf<Kind>> own;
  std::optional<bench::Rounds> rounds;
  std::size_t next = 0;
  auto send = [&] {
    outputs[next].send(*own);
    next = (next + 1) % static_cast<std::size_t>(*ports);
  };
  module.on_start([&] {
    if (*processor >= 0) {
      cpu_set_t set;
      CPU_ZERO(&set);
      CPU_SET(static_cast<std::size_t>(*processor), &set);
      bench::require(::sched_setaffinity(0, sizeof set, &set), "sched_setaffinity");
    }
    bench::Setup setup;
    setup.bytes = static_cast<std::size_t>(*bytes);
    setup.seconds = *seconds;
    const auto width = static_cast<std::int32_t>(*bytes) - (setup.is_small() ? kHeaderBytes : 0);
    if (setup.is_small())
      own = hc::intensity_image().message(std::vector<std::uint8_t>(setup.bytes - kHeaderBytes));
    else
      own = {outputs[0].loan(1, width).finish()};
    own->header.time = module.now();
    if (!*asks) return;
    rounds.emplace(setup);
    send();
  });
  for (const auto& input : inputs)
    module.on(input, [&](const auto&) {
      if (!rounds) return send();
      if (rounds->next()) return send();
      module.log(rounds->json(), hc::Level::Result);
    });
  module.every(rate, [] {});
  return module.run(argc, argv);
}
