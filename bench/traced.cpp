// SPDX-License-Identifier: Apache-2.0
// What the trace of a module costs: messages that a module takes, handles and sends on within one
// process, while its output `trace` is linked and while it is not; the ratio of both.
//
//     build/bench/traced [ROUNDS]    default 5
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include <hc/module/module.h>

#include "measure.h"

namespace {

using bench::must;
using Clock = std::chrono::steady_clock;

constexpr int kMessages = 200'000;

/// Takes all that comes.
std::thread drain(const std::string& uri) {
  auto source = must(hc::open_source(must(hc::parse_uri(uri))));
  return std::thread([source = std::move(source)] {
    hc::Message message;
    while (must(hc::receive(*source, message))) {
    }
  });
}

/// Seconds that a module takes for the messages.
double run(bool is_traced) {
  static int number = 0;
  const std::string name = "inproc:traced-" + std::to_string(++number) + "-";
  hc::Module module{"double", "Doubles."};
  auto in = module.input("in", hc::table(), "");
  auto out = module.output("out", hc::table(), "");
  module.on(in, [&](const auto& message) { out.send(2 * message.numbers()[0]); });
  std::vector<std::string> words = {"double", "--in=" + name + "in", "--out=out=" + name + "out"};
  std::vector<std::thread> readers;
  readers.push_back(drain(name + "out"));
  if (is_traced) {
    words.push_back("--out=trace=" + name + "trace");
    readers.push_back(drain(name + "trace"));
  }
  auto sink = must(hc::open_sink(must(hc::parse_uri(name + "in"))));
  std::thread sender([&] {
    for (int i = 0; i < kMessages; ++i)
      if (!sink->send(hc::table().message({1.0 * i}))) std::_Exit(1);
    static_cast<void>(sink->close());
  });
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  const auto begin = Clock::now();
  if (module.run(static_cast<int>(arguments.size()), arguments.data()) != 0) std::_Exit(1);
  const std::chrono::duration<double> seconds = Clock::now() - begin;
  sender.join();
  for (auto& reader : readers) reader.join();
  return seconds.count();
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 5;
  std::vector<double> ratios;
  for (int round = 0; round < rounds; ++round) {
    const double off = run(false), on = run(true);
    ratios.push_back(on / off);
    std::printf("not traced %8.0f messages/s   traced %8.0f   ratio of times %.2f\n",
                kMessages / off, kMessages / on, ratios.back());
  }
  if (!ratios.empty()) std::printf("median ratio %.2f\n", bench::median(ratios));
}
