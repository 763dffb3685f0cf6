// SPDX-License-Identifier: Apache-2.0
// What this module is for, in a line or two. Hypercolumn's doc/modules.md explains the API.
#include <algorithm>

#include <hc/module/module.h>
#include <transports/all.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"@NAME@", "Multiplies numbers by a factor."};
  auto numbers = module.input("numbers", hc::table(), "any numbers");
  auto product = module.output("product", hc::table(), "the numbers, multiplied");
  auto factor = module.parameter("factor", 2.0, "", "factor of each number");

  module.on(numbers, [&](const auto& message) {
    auto draft = product.loan(message.header.height, message.header.width);
    std::ranges::transform(message.numbers(), draft.numbers().begin(),
                           [&](double number) { return *factor * number; });
    product.send(std::move(draft));
  });
  return module.run(argc, argv);
}
