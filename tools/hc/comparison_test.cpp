// SPDX-License-Identifier: Apache-2.0
#include "comparison.h"

#include <gtest/gtest.h>

#include <vector>

#include <hc/mtp/matrix_view.h>
#include <hc/mtp/rows.h>

namespace tool {
namespace {

hc::Message number(std::chrono::nanoseconds time, double value, std::int32_t width = 1) {
  auto draft =
      hc::Draft::make({hc::MatrixType::Table, 1, hc::Scalar::F64, hc::Encoding::Text}, 1, width);
  for (auto& each : hc::view<double>(draft).numbers()) each = value;
  draft.header.time = hc::Time(time);
  return std::move(draft).finish();
}

NextMessage from(const std::vector<hc::Message>& messages) {
  return [&messages, at = std::size_t{0}](hc::Message& message) mutable {
    if (at == messages.size()) return false;
    message = messages[at++];
    return true;
  };
}

Comparison compare_all(const std::vector<hc::Message>& recorded,
                       const std::vector<hc::Message>& replayed, const Tolerance& tolerance = {},
                       std::int64_t last = 100) {
  return compare(from(recorded), from(replayed), tolerance, last);
}

using namespace std::chrono_literals;

TEST(Comparison, NamesTheFirstField) {
  auto one = number(1ns, 0.5), other = number(1ns, 0.5);
  EXPECT_EQ(difference(one, other, {}), "");
  other.header.src = 3, other.header.seq = 9;
  EXPECT_EQ(difference(one, other, {}), "");
  other.header.mode = 2;
  EXPECT_EQ(difference(one, other, {}), "mode: 0 recorded, 2 replayed");
  EXPECT_EQ(difference(one, number(1ns, 0.5, 2), {}), "width: 1 recorded, 2 replayed");
  EXPECT_EQ(difference(one, number(1ns, 0.75), {}),
            "row 0, column 0, component 0: 0.5 recorded, 0.75 replayed");
  EXPECT_EQ(difference(one, number(1ns, 0.75), {.number = 0.25}), "");
  const std::vector<std::string> hello = {"HELLO"}, hallo = {"HALLO"};
  EXPECT_EQ(difference(hc::make_rows(hello), hc::make_rows(hallo), {}),
            "text: \"HELLO\" recorded, \"HALLO\" replayed");
}

TEST(Comparison, CountsWhatDiffersIsMissingAndIsMore) {
  const std::vector<hc::Message> recorded = {number(1s, 1), number(2s, 2), number(3s, 3),
                                             number(9s, 4)};
  EXPECT_EQ(compare_all(recorded, recorded).text(), "4 messages, the same");
  const auto result =
      compare_all(recorded, {number(1s, 1), number(2s, 5), number(9s, 4), number(10s, 6)});
  EXPECT_EQ(result.same, 2U);
  EXPECT_EQ(
      result.text(),
      "4 messages, 1 differ, 1 missing, 1 more; first: seq 0, 1.000 s after the first: row 0, "
      "column 0, component 0: 2 recorded, 5 replayed");
  EXPECT_FALSE(result.is_same({}));
  EXPECT_TRUE(result.is_same({.share = 0.4}));
  EXPECT_FALSE(result.is_same({.share = 0.41}));
}

TEST(Comparison, TimesMayGoBackWithinASecond) {
  const std::vector<hc::Message> recorded = {number(2s, 1), number(2s - 5ns, 2), number(2s, 3)};
  const std::vector<hc::Message> replayed = {number(2s - 5ns, 2), number(2s, 3), number(2s, 1)};
  EXPECT_EQ(compare_all(recorded, replayed).text(), "3 messages, the same");
  EXPECT_EQ(compare_all(replayed, recorded).text(), "3 messages, the same");
}

TEST(Comparison, EqualMessagesOfOneTimeAreCounted) {
  const auto result = compare_all({number(1ns, 1), number(1ns, 1)}, {number(1ns, 1)});
  EXPECT_EQ(result.same, 1U);
  EXPECT_EQ(result.missing, 1U);
}

TEST(Comparison, MessagesOfOneTimeAreMatchedInAnyOrder) {
  const std::vector<hc::Message> recorded = {number(1s, 1), number(1s, 2)};
  EXPECT_EQ(compare_all(recorded, {number(1s, 2), number(1s, 1)}).same, 2U);
}

TEST(Comparison, OfTheEndNotAllHasToBeReplayed) {
  const std::vector<hc::Message> recorded = {number(1s, 1), number(2s, 2), number(3s, 3)};
  std::vector<hc::Message> numbered = recorded;
  for (std::size_t i = 0; i < numbered.size(); ++i)
    numbered[i].header.seq = static_cast<std::int64_t>(i);
  EXPECT_EQ(compare_all(numbered, {recorded[0]}, {}, 0).text(),
            "3 messages, the same, 2 after the last whole step");
  EXPECT_TRUE(compare_all(numbered, {recorded[0]}, {}, 0).is_same({}));
  EXPECT_EQ(compare_all(numbered, {recorded[0]}, {}, 1).missing, 1U);
  EXPECT_EQ(compare_all(numbered, recorded, {}, 0).text(), "3 messages, the same");
  EXPECT_EQ(compare_all(numbered, {}, {}, -1).text(), "3 messages, 3 after the last whole step");
  EXPECT_FALSE(compare_all(numbered, {}, {}, -1).is_same({}));
}

TEST(Comparison, NothingIsTheSameAsNothing) {
  EXPECT_TRUE(compare_all({}, {}).is_same({}));
  EXPECT_FALSE(compare_all({}, {number(1ns, 1)}).is_same({}));
  EXPECT_FALSE(compare_all({number(1ns, 1)}, {}).is_same({}));
}

TEST(Comparison, DoesNotOverflow) {
  constexpr auto kLatest = hc::Time::max().time_since_epoch();
  const std::vector<hc::Message> all = {number(1ns, 1), number(kLatest, 2)};
  EXPECT_EQ(compare_all(all, all).same, 2U);
}

}  // namespace
}  // namespace tool
