// SPDX-License-Identifier: Apache-2.0
// A module for clocks_test.py: says beside the times of messages what the kernel's clock says,
// which all hosts of a test have in common, whatever clock they are given.
#include <sys/syscall.h>
#include <unistd.h>

#include <ctime>

#include <hc/module/module.h>
#include <transports/all.h>

namespace {

constexpr std::chrono::microseconds kSameMoment{100};

/// The wall clock past all libraries.
hc::Time true_now() {
  timespec time{};
  ::syscall(SYS_clock_gettime, CLOCK_REALTIME, &time);
  return hc::Time(std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec));
}

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{
      "moments", "Sends the time, as it is and as its host has it.", {.keep_running = true}};
  auto in = module.input("in", hc::table<std::int64_t>(), "moments of another");
  auto moment = module.output("moment", hc::table<std::int64_t>(), "true time [ns]");
  auto pose =
      module.output("pose", hc::transformation(), "moved along x by 1 m a second since `start`");
  auto ways = module.output("ways", hc::table<std::int64_t>(),
                            "how long a moment took to come: in truth, and by the clocks [ns]");
  auto start = module.parameter("start", 0.0, "s", "when the true time began");
  // The true time and the module's; false where something has come in between them.
  struct Both {
    hc::Time truth, stamp;
    std::chrono::nanoseconds width;
    explicit operator bool() const { return width < kSameMoment; }
  };
  auto look = [&] {
    const auto before = true_now(), stamp = module.now(), after = true_now();
    return Both{before + (after - before) / 2, stamp, after - before};
  };
  module.on(in, [&](const auto& message) {
    if (const auto now = look())
      ways.send({(now.truth - hc::unix_time(message.numbers()[0])).count(),
                 (now.stamp - message.header.time).count()});
  });
  module.every(std::chrono::milliseconds(20), [&] {
    const auto now = look();
    if (!now) return;
    moment.send(hc::unix_nanoseconds(now.truth), now.stamp);
    auto draft = pose.loan(4, 4);
    const auto T = draft.matrix();
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) T.at(i, j) = i == j ? 1 : 0;
    T.at(0, 3) = hc::seconds(now.truth - hc::Time(hc::duration(*start)));
    draft.header.time = now.stamp;
    pose.send(std::move(draft));
  });
  return module.run(argc, argv);
}
