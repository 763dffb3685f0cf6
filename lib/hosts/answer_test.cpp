// SPDX-License-Identifier: Apache-2.0
#include <hosts/answer.h>

#include <gtest/gtest.h>

#include <future>
#include <string>

#include <hc/os/event.h>
#include <hc/testing/must.h>

namespace hc::hosts {
namespace {

using namespace std::chrono_literals;

class AnswerTest : public ::testing::Test {
 protected:
  /// Asks on another thread while this one turns the loop.
  Result<std::string> ask(std::function<void(Give<std::string>)> begin, int stop = -1,
                          std::chrono::nanoseconds timeout = 1h) {
    auto answer = std::async(std::launch::async, [&, begin = std::move(begin)] {
      auto given = answer_of<std::string>(*loop_, stop, timeout, begin);
      loop_->post([this] { is_done_ = true; });
      return given;
    });
    while (!is_done_) HC_CHECK(loop_->turn());
    return answer.get();
  }

  std::unique_ptr<Loop> loop_ = std::move(*Loop::make());
  bool is_done_ = false;
};

TEST_F(AnswerTest, ComesAtOnceOrLater) {
  EXPECT_EQ(*ask([](const auto& give) { give(std::string("now")); }), "now");
  is_done_ = false;
  Loop::Handle timer;
  EXPECT_EQ(*ask([&](const auto& give) {
    timer = loop_->call_at({}, [give] { give(std::string("later")); });
  }),
            "later");
  is_done_ = false;
  EXPECT_EQ(ask([](const auto& give) {
              give(Error{Code::NotFound, "none"});
            })
                .error()
                .code,
            Code::NotFound);
}

TEST_F(AnswerTest, IsNotAwaitedForEver) {
  const auto stop = must(Event::make());
  Give<std::string> late;
  auto asked = [&](const auto& give) {
    late = give;
    stop.raise();
  };
  EXPECT_EQ(ask(asked, stop.descriptor()).error().code, Code::Stopped);
  late(std::string("too late"));
  is_done_ = false;
  EXPECT_EQ(ask([](const auto&) {}, -1, 1ms).error().code, Code::Closed);
}

}  // namespace
}  // namespace hc::hosts
