// SPDX-License-Identifier: Apache-2.0
// A pan-tilt unit without hardware: it answers on a pseudo-terminal as a real one does on a serial
// line, moves in real time, and fails as one wishes.
#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <drivers/pan_tilt/unit.h>
#include <hc/module/module.h>

#include "terminal.h"
#include "wire.h"

namespace {

constexpr std::int32_t kGaze = 13;
constexpr double kStep =
    hc::pan_tilt::kArcsecondsPerPosition / 3600 * std::numbers::pi / 180;  // [rad/position]

/// A descriptor that can be read from a time on.
class Alarm {
 public:
  Alarm() : number_(timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)) {
    HC_CHECK(number_ >= 0);
  }
  Alarm(const Alarm&) = delete;
  Alarm& operator=(const Alarm&) = delete;
  ~Alarm() { ::close(number_); }
  [[nodiscard]] int descriptor() const { return number_; }
  /// @param in  [s]; none: never.
  void set(std::optional<double> in) {
    itimerspec when = {};
    if (in) {
      const auto nanoseconds =
          static_cast<std::int64_t>(std::clamp(*in, 1e-9, 1e6) * 1e9);  // 0 would be never
      when.it_value = {nanoseconds / 1'000'000'000, nanoseconds % 1'000'000'000};
    }
    timerfd_settime(number_, 0, &when, nullptr);
  }

 private:
  int number_;
};

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"fake_pan_tilt", "A simulated pan-tilt unit on a pseudo-terminal."};
  auto motion = module.output("motion", hc::rotation<double>().in(kGaze),
                              "truth: 0, tilt, pan as they are [rad]");
  auto device = module.output("device", hc::string(),
                              "what to open; empty while unplugged; each second and on change");
  auto received =
      module.output("received", hc::string(), "what has come on its line, in pieces as it came");
  auto pan = module.parameter("pan", 0.0, "rad", "where it stands at the start",
                              {.min = -3.2, .max = 3.2, .fixed = true});
  auto tilt =
      module.parameter("tilt", 0.0, "rad", "the same", {.min = -3.2, .max = 3.2, .fixed = true});
  auto seed =
      module.parameter("seed", 1, "", "of the garbage", {.min = 0, .max = 1e9, .fixed = true});
  auto rate = module.parameter("rate", 200.0, "Hz", "of motion", {.min = 0, .max = 10000});
  auto answer_delay =
      module.parameter("answer_delay", 0.0, "s", "of each answer", {.min = 0, .max = 60});
  auto silent = module.parameter("silent", false, "", "obeys, but answers nothing");
  auto garbage = module.parameter("garbage", 0.0, "", "share of its bytes that are spoilt",
                                  {.min = 0, .max = 1});
  auto unplugged =
      module.parameter("unplugged", false, "", "the line is gone; afterwards there is a new one");
  auto bytes_per_second = module.parameter("bytes_per_second", 0.0, "1/s",
                                           "of the line, each way; 960 is 9600 baud, 0: unbounded",
                                           {.min = 0, .max = 1e9});

  const hc::SystemClock clock;
  const auto start = clock.monotonic();
  auto seconds = [&] { return std::chrono::duration<double>(clock.monotonic() - start).count(); };
  std::optional<hc::pan_tilt::Unit> unit;
  std::optional<Terminal> terminal;
  std::optional<Wire> to_unit, from_unit;
  Alarm alarm;

  auto tell_device = [&] {
    auto text = hc::string(terminal ? terminal->path() : "");
    text.header.time = module.now();
    device.send(text);
  };
  auto plug = [&] {
    if (*unplugged)
      terminal.reset();
    else
      terminal = hc::value_or_end(Terminal::open());
    to_unit->clear();
    from_unit->clear();
    tell_device();
  };
  /// All that is due: bytes reach the unit, and its answers the line.
  auto serve = [&] {
    if (*unplugged == terminal.has_value()) plug();
    const double now = seconds();
    if (terminal) to_unit->put(now, terminal->read(), {0, *bytes_per_second, 0});
    const std::string heard = to_unit->take(now);
    if (!heard.empty() && received.linked()) {
      auto text = hc::string(heard);
      text.header.time = module.now();
      received.send(text);
    }
    std::string said = unit->take(now, heard) + unit->pass(now);
    if (!*silent) from_unit->put(now, said, {*answer_delay, *bytes_per_second, *garbage});
    if (terminal) terminal->write(from_unit->take(now));
    std::optional<double> next;
    for (auto due : {to_unit->next(), from_unit->next(), unit->next()})
      if (due) next = std::min(next.value_or(*due), *due);
    alarm.set(next ? std::optional(*next - now) : std::nullopt);
  };

  module.on_start([&] {
    unit.emplace(*pan / kStep, -*tilt / kStep);
    to_unit.emplace(static_cast<std::uint64_t>(*seed));
    from_unit.emplace(static_cast<std::uint64_t>(*seed));
    plug();
  });
  module.on_readable([&] { return terminal ? terminal->descriptor() : -1; }, serve);
  module.on_readable([&] { return alarm.descriptor(); },
                     [&] {
                       std::uint64_t times = 0;
                       if (::read(alarm.descriptor(), &times, sizeof times) > 0) serve();
                     });
  module.every(rate, [&] {
    const double now = seconds();
    auto draft = motion.loan(1, 1);
    draft.header.time = module.now();
    const double row[] = {0, -unit->tilt(now) * kStep, unit->pan(now) * kStep};
    std::copy(std::begin(row), std::end(row), draft.matrix().numbers().begin());
    motion.send(std::move(draft));
  });
  module.every(std::chrono::seconds(1), tell_device);
  return module.run(argc, argv);
}
