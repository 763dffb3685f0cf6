// SPDX-License-Identifier: Apache-2.0
// What this module is for, in a line or two. Hypercolumn's doc/modules.md tells how one is written.
#include <hc/module/module.h>

int main(int argc, char** argv) {
  hc::Module module{"@NAME@", "Multiplies numbers by a factor."};
  auto numbers = module.input("numbers", hc::table<double>(), "any numbers");
  auto product = module.output("product", hc::table<double>(), "the numbers times the factor");
  auto factor = module.parameter("factor", 2.0, "", "what each number is multiplied by");

  module.on(numbers, [&](const auto& message) {
    auto draft = product.loan(message.header.width, message.header.height);
    auto from = message.matrix().numbers();
    auto to = draft.matrix().numbers();
    for (std::size_t i = 0; i < from.size(); ++i) to[i] = *factor * from[i];
    product.send(std::move(draft));
  });
  return module.run(argc, argv);
}
