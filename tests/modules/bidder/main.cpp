// SPDX-License-Identifier: Apache-2.0
// A task for demonstrations: bids for the focus as a script says, and commands while it bids,
// whoever has the focus. What keeps it from acting out of focus is the actor's exclusive input.
#include "bidder.h"

#include <hc/module/module.h>
#include <transports/all.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"bidder", "Bids for the focus as a script says, and commands."};
  auto bid = module.output("bid", hc::table(), "1 x 1: salience; 0 withdraws");
  auto command =
      module.output("command", hc::table(), "1 x 1: the salience, while it is not 0");
  auto text = module.parameter("script", "0:0.5", "",
                               "SECONDS:SALIENCE …, at the end SECONDS:end or SECONDS:again",
                               {.positional = true, .fixed = true});
  auto rate =
      module.parameter("rate", 20.0, "Hz", "bids and commands a second", {.min = 0.1, .max = 1e5});
  auto ttl = module.parameter("ttl", 8, "", "routers that a command may pass, and one",
                              {.min = 0, .max = 255});

  hc::SystemClock clock;
  Script script;
  hc::MonotonicTime started{};
  module.on_start([&] {
    script = hc::value_or_end(Script::parse(*text));
    started = clock.monotonic();
  });
  module.generate([&] {
    module.keep_rate(*rate);
    std::chrono::duration<double> passed = clock.monotonic() - started;
    auto salience = script.at(passed.count());
    if (!salience) return module.stop();
    auto message = hc::table().message({*salience});
    message.header.time = module.now();
    bid.send(message);
    if (*salience == 0) return;
    message.header.ttl = static_cast<std::uint8_t>(*ttl);
    command.send(message);
  });
  return module.run(argc, argv);
}
