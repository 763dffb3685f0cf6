// SPDX-License-Identifier: Apache-2.0
// Passes messages from one graph to another, with the addresses and encoding of the other graph.
// One-way; limit its rate with `rate` on its links.
#include "gateway.h"

#include <hc/module/module.h>
#include <transports/all.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"gateway", "Passes messages from one graph to another, renumbered.", {.routes = true}};
  auto in = module.input("in", hc::anything(), "messages of this graph");
  auto out = module.output("out", hc::anything(),
                           "those that pass, encoded as asked where possible (u8 images as jpeg)");
  auto sent = module.output("counts", hc::table<std::int64_t>().of(1, 5),
                            "each second: messages passed; dropped for ttl, as not listed, "
                            "without a route, as damaged");
  auto numbers = module.parameter(
      "numbers", "", "", "map of src and dst, e.g. \"12=112 -2=-5\"; others stay", {.fixed = true});
  auto only = module.parameter("only", "", "", "dst that pass, e.g. \"12 13 -1\"; none: all",
                               {.fixed = true});
  auto only_from =
      module.parameter("only_from", "", "", "src that pass; none: all", {.fixed = true});

  GatewayRules rules;
  GatewayCounts counts;
  module.on_start([&] {
    rules.numbers = hc::value_or_end(parse_renumbering(*numbers));
    rules.only = hc::value_or_end(parse_addresses(*only));
    rules.only_from = hc::value_or_end(parse_addresses(*only_from));
  });
  module.on_raw(in, [&](const hc::Message& message) {
    hc::Message copy = message;
    if (!admit(copy.header, rules, counts)) return;
    auto encoded = out.encoding() ? in_encoding(copy, *out.encoding()) : hc::Result(copy);
    if (!encoded) {
      ++counts.damaged;
      return;
    }
    ++(out.forward(*encoded) > 0 ? counts.passed : counts.no_route);
  });
  module.every(std::chrono::seconds(1), [&] {
    sent.send(
        {counts.passed, counts.ttl, counts.unlisted, counts.no_route, counts.damaged}, module.now());
  });

  const int status = module.run(argc, argv);
  if (counts.total() > 0) module.log(counts.text());
  return status;
}
