// SPDX-License-Identifier: Apache-2.0
#include <hc/module/module.h>
#include <transports/all.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"twice", "Doubles tables."};
  auto in = module.input("in", hc::table(), "numbers");
  auto out = module.output("out", hc::table(), "twice the numbers");
  module.on(in, [&](const auto& table) {
    auto draft = out.loan(table.header.height, table.header.width);
    auto result = draft.matrix().numbers();
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = 2 * table.matrix().numbers()[i];
    out.send(std::move(draft));
  });
  return module.run(argc, argv);
}
