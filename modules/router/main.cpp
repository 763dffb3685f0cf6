// SPDX-License-Identifier: Apache-2.0
// Forwards each message by its address. `hc run` passes the routes on the command line (--route).
#include "router.h"

#include <memory>

#include <hc/module/module.h>
#include <transports/all.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"router", "Forwards each message to the links of its address.", {.routes = true}};
  auto in = module.input("in", hc::anything(), "messages with an address (dst)");
  auto out = module.output("out", hc::anything(), "the same, on the links of its address");
  auto counts = module.output(
      "counts", hc::table<std::int64_t>().of(1, 5),
      "each second: messages passed; dropped for ttl, as duplicates, without a route, "
      "without an address");
  auto remember =
      module.parameter("remember", 1.0, "s", "how long a duplicate of a message is recognised",
                       {.min = 0, .max = 3600, .fixed = true});

  std::unique_ptr<Router> router;
  module.on_start([&] { router = std::make_unique<Router>(hc::duration(*remember)); });
  module.on_raw(in, [&](const hc::Message& message) {
    hc::Message copy = message;
    if (router->admit(copy.header, module.monotonic()))
      router->sent(copy.header, out.forward(copy));
  });
  module.every(std::chrono::seconds(1), [&] {
    const RouterCounts& n = router->counts();
    counts.send({n.passed, n.ttl, n.seen, n.no_route, n.no_address}, module.now());
  });

  const int status = module.run(argc, argv);
  if (router != nullptr) module.log(router->counts().text());
  return status;
}
