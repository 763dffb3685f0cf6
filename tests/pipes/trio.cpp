// SPDX-License-Identifier: Apache-2.0
// A module for together_test.py: three inputs of different kinds, taken together.
#include <hc/module/module.h>

int main(int argc, char** argv) {
  hc::Module module{"trio", "Sends the times of three inputs that are taken together."};
  auto place = module.input("place", hc::position(), "a position");
  auto score = module.input("score", hc::table(), "a table");
  auto words = module.input("words", hc::string(), "a text");
  auto times = module.output("times", hc::table<std::int64_t>(), "times of a set [ns]");
  module.on(hc::together(place, score, words), [&](const auto& a, const auto& b, const auto& c) {
    using hc::unix_nanoseconds;
    times.send({unix_nanoseconds(a.header.time), unix_nanoseconds(b.header.time),
                unix_nanoseconds(c.header.time)});
  });
  return module.run(argc, argv);
}
