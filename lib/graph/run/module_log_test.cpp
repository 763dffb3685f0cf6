// SPDX-License-Identifier: Apache-2.0
#include <graph/run/module_log.h>

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace hc::internal {
namespace {

using namespace std::chrono_literals;

struct ModuleLogTest : ::testing::Test {
  std::vector<std::string> taken;
  ModuleLog log{"ball", [this](Level, const std::string& text) { taken.push_back(text); }};
};

TEST_F(ModuleLogTest, TakesTheNameOffItsLines) {
  log.add("ball: found\nball", 1s);
  EXPECT_EQ(taken, std::vector<std::string>{"found"});
  log.finish(1s);
  EXPECT_EQ(taken.back(), "ball");
}

TEST_F(ModuleLogTest, KeepsResultsWhenLinesAreDropped) {
  std::string flood;
  for (std::size_t i = 0; i <= LogLimit::kMostLines; ++i) flood += "x\n";
  EXPECT_FALSE(log.add(flood, 1s)) << "more than the limit";
  taken.clear();
  log.add(Level::Info, "dropped", 1s);
  for (int i = 0; i <= ModuleLog::kMostResults; ++i) log.add(Level::Result, "kept", 1s);
  EXPECT_EQ(taken, std::vector<std::string>(ModuleLog::kMostResults, "kept"));
  EXPECT_EQ(log.take_remark(2s).substr(0, 16), "3 lines dropped ");
}

TEST_F(ModuleLogTest, HasTheLastLineInTheStateButNoNotice) {
  log.add(Level::Warning, "no ball", 1s);
  log.add(Level::Notice, "open the page", 2s);
  ModuleState state;
  log.describe(state, 4s);
  EXPECT_EQ(state.last_line, "no ball");
  EXPECT_EQ(state.last_level, Level::Warning);
  EXPECT_EQ(state.last_line_age, 3);
}

}  // namespace
}  // namespace hc::internal
