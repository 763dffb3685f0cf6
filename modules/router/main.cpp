// SPDX-License-Identifier: Apache-2.0
// Sends each message where its address leads: the routes stand in the command line (--route), which
// `hc run` writes.
#include "router.h"

#include <memory>

#include <hc/module/module.h>

int main(int argc, char** argv) {
  hc::Module module{"router", "Sends each message to the links that its address leads to."};
  auto in = module.input("in", hc::anything(), "messages with an address (dst)");
  auto out = module.output("out", hc::anything(), "the same, each on the links of its address");
  auto told = module.output(
      "counts", hc::table<std::int64_t>(),
      "1 x 5 each second: messages passed; dropped for ttl, as seen before, without a route, "
      "without an address");
  auto remember =
      module.parameter("remember", 1.0, "s", "how long a message is known that comes once more",
                       {.min = 0, .max = 3600, .fixed = true});
  module.route_outputs();

  std::unique_ptr<Router> router;
  module.on_start([&] {
    auto time = std::chrono::duration<double>(*remember);
    router = std::make_unique<Router>(std::chrono::duration_cast<std::chrono::nanoseconds>(time));
  });
  module.on_raw(in, [&](const hc::Message& message) {
    hc::Message copy = message;
    if (router->admit(copy.header, module.monotonic()))
      router->sent(copy.header, out.forward(copy));
  });
  module.every(std::chrono::seconds(1), [&] {
    const RouterCounts& counts = router->counts();
    auto table =
        hc::table({counts.passed, counts.ttl, counts.seen, counts.no_route, counts.no_address});
    table.header.time = module.now();
    told.send(table);
  });

  int status = module.run(argc, argv);
  if (router != nullptr) module.log(router->counts().text());
  return status;
}
