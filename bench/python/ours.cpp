// SPDX-License-Identifier: Apache-2.0
// What surrounds a module in Python in the measurements of scripts/bench_python: a source, a
// sink, and a module in C++ in its place.
#include <algorithm>
#include <cstring>
#include <numeric>
#include <string>

#include <hc/module/module.h>

namespace {

constexpr std::int64_t kWarm = 10;  // a part of so many is not measured

/// Messages a second, but for the first ones.
class Meter {
 public:
  void count(hc::Time time, std::int64_t all) {
    if (++counted_ == all / kWarm) begin_ = time;
    if (counted_ == all)
      rate_ = static_cast<double>(all - all / kWarm) / hc::seconds(time - begin_);
  }
  [[nodiscard]] std::string text() const { return std::to_string(rate_); }

 private:
  std::int64_t counted_ = 0;
  hc::Time begin_;
  double rate_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"flow", "Sends images or numbers, passes them on inverted, or counts them."};
  auto role = module.parameter("role", "source", "", "what it does",
                               {.choices = {"source", "numbers", "middle", "sink", "counter"}});
  auto bytes = module.parameter("bytes", 1440000, "byte", "of an image");
  auto count = module.parameter("count", 1000, "", "messages");
  auto rate = module.parameter("rate", 0.0, "Hz", "of messages; 0: as fast as they are taken");
  auto image = module.input("image", hc::intensity_image(), "an image");
  auto number = module.input("number", hc::table(), "numbers");
  auto made = module.output("made", hc::intensity_image(), "an image");
  auto numbers = module.output("numbers", hc::table(), "numbers");
  std::int64_t sent = 0;
  Meter meter;

  module.on(image, [&](const auto& message) {
    const auto pixels = message.numbers();
    if (*role == "middle") {
      auto draft = made.loan(message.header.height, message.header.width);
      std::transform(pixels.begin(), pixels.end(), draft.numbers().begin(),
                     [](std::uint8_t each) { return static_cast<std::uint8_t>(~each); });
      return made.send(std::move(draft));
    }
    const auto sum = std::accumulate(pixels.begin(), pixels.end(), std::uint64_t{0});
    if (sum !=
        static_cast<std::uint8_t>(~hc::unix_nanoseconds(message.header.time)) * pixels.size())
      throw hc::ModuleError("a wrong image");
    meter.count(module.now(), *count);
  });
  module.on(number, [&](const auto& message) {
    if (message.numbers().size() != 3) throw hc::ModuleError("wrong numbers");
    meter.count(module.now(), *count);
  });
  module.on_end([&] {
    if (*role == "sink" || *role == "counter") module.log(meter.text(), hc::Level::Result);
  });
  if (argc > 1 && std::any_of(argv, argv + argc, [](const char* word) {
        return std::strstr(word, "role=source") != nullptr ||
               std::strstr(word, "role=numbers") != nullptr;
      }))
    module.generate([&] {
      if (*rate > 0) module.keep_rate(*rate);
      ++sent;
      if (*role == "numbers") {
        numbers.send({1.0, 2.0, static_cast<double>(sent)}, module.now());
      } else {
        auto draft = made.loan(1, static_cast<std::int32_t>(*bytes));
        // With a rate it is the way that is measured, by the time when it begins.
        std::ranges::fill(draft.numbers(), static_cast<std::uint8_t>(sent));
        draft.header.time = *rate > 0 ? module.now() : hc::unix_time(sent);
        made.send(std::move(draft));
      }
      if (sent >= *count) module.stop();
    });
  return module.run(argc, argv);
}
