// SPDX-License-Identifier: Apache-2.0
#include "chrome_trace.h"

#include <gtest/gtest.h>

#include <map>

#include <nlohmann/json.hpp>

namespace tool {
namespace {

using What = hc::TraceEvent::What;

TEST(ChromeTrace, HasASliceForEachHandlerAndAnArrowForEachMessage) {
  const auto seen = hc::unix_time(1000);  // the message's time
  const auto at = [&](std::int64_t ns) { return seen + std::chrono::nanoseconds(ns); };
  Traced traced;
  traced.events["eye"] = {{What::Sent, "left", 1, 0, seen, at(100)}};
  traced.events["blob"] = {{What::Took, "image", 1, 0, seen, at(130)},
                           {What::Began, "image", 1, 0, seen, at(1135)},
                           {What::Ended, "image", 1, 0, seen, at(1190)}};
  const auto json = nlohmann::json::parse(to_chrome_trace(traced));
  std::map<std::string, int> kinds;
  for (const auto& event : json["traceEvents"]) ++kinds[event["ph"].get<std::string>()];
  EXPECT_EQ(kinds, (std::map<std::string, int>{
                       {"M", 2}, {"B", 1}, {"E", 1}, {"i", 2}, {"s", 1}, {"f", 1}}));
  for (const auto& event : json["traceEvents"]) {
    if (event["ph"] == "B") {
      EXPECT_EQ(event["ts"], 1.035);  // [µs] since the first event
    }
  }
}

TEST(ChromeTrace, OfNothingIsEmpty) {
  EXPECT_EQ(nlohmann::json::parse(to_chrome_trace({}))["traceEvents"].size(), 0U);
}

}  // namespace
}  // namespace tool
