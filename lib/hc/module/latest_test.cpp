// SPDX-License-Identifier: Apache-2.0
// What a module drops when it is slower than its links: whole sets, and nothing of the newest one.
#include <unistd.h>

#include <future>

#include <hc/module/running_module_test.h>

namespace hc {
namespace {

Message numbered(std::int64_t time) {
  Message message = table().message({static_cast<double>(time)});
  message.header.time = unix_time(time);
  return message;
}

/// A module that takes pairs over shared memory, and is slow: while it handles the first pair, all
/// the others come, and of the last one only the left half.
class SlowPairs : public RunningModule {
 protected:
  std::vector<std::int64_t> handled(const std::string& keep, std::int64_t pairs) {
    const std::string name = "shm:pairs-" + keep + "-" + std::to_string(::getpid());
    auto left_sink = sink_of(name + "-left"), right_sink = sink_of(name + "-right");
    Module module{"pair", "Pairs."};
    auto left = module.input("left", table(), "");
    auto right = module.input("right", table(), "");
    std::vector<std::int64_t> times;
    std::promise<void> sent;
    module.on(together(left, right), [&](const auto& l, const auto& r) {
      EXPECT_EQ(l.header.time, r.header.time);
      times.push_back(unix_nanoseconds(l.header.time));
      if (times.size() > 1) return;
      sent.get_future().wait();
      for (std::int64_t time = 2; time <= pairs; ++time) {
        EXPECT_TRUE(left_sink->send(numbered(time)));
        EXPECT_TRUE(right_sink->send(numbered(time)));
      }
      EXPECT_TRUE(left_sink->send(numbered(pairs + 1)));
      EXPECT_TRUE(left_sink->close());
      EXPECT_TRUE(right_sink->close());
    });
    start(module, {"--in=left=" + name + "-left?wait=60&keep=" + keep,
                   "--in=right=" + name + "-right?wait=60&keep=" + keep});
    EXPECT_TRUE(left_sink->send(numbered(1)));
    EXPECT_TRUE(right_sink->send(numbered(1)));
    sent.set_value();
    EXPECT_EQ(join(), 0);
    return times;
  }
};

TEST_F(SlowPairs, TheNewestCompleteOneIsHandled) {
  EXPECT_EQ(handled("latest", 3), (std::vector<std::int64_t>{1, 3}));
  EXPECT_EQ(handled("latest", 20), (std::vector<std::int64_t>{1, 20}));
}

TEST_F(SlowPairs, WithKeepAllEachIsHandled) {
  EXPECT_EQ(handled("all", 5), (std::vector<std::int64_t>{1, 2, 3, 4, 5}));
}

}  // namespace
}  // namespace hc
