// SPDX-License-Identifier: Apache-2.0
#include <hc/link/link.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

TEST(Open, ASchemeThatThereIsNotIsRefusedByName) {
  auto source = open_source(*parse_uri("pigeon:home"));
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, Code::Unsupported);
  EXPECT_EQ(
      source.error().detail,
      "no transport \"pigeon\"; there are -, file, tcp, tcp-listen, unix, unix-listen, inproc, "
      "shm");
  EXPECT_FALSE(open_sink(*parse_uri("pigeon:home")));
}

TEST(Open, OptionsAreChecked) {
  EXPECT_EQ(open_source(*parse_uri("tcp:localhost:1?weight=3")).error().detail,
            "tcp has no option \"weight\" here, only \"wait\", \"reconnect\"");
  EXPECT_EQ(open_source(*parse_uri("-?wait=3")).error().detail, "- has no option \"wait\" here");
  EXPECT_EQ(open_source(*parse_uri("-?keep=latest")).error().code, Code::Unsupported);
  EXPECT_EQ(open_sink(*parse_uri("-?wait=3")).error().detail,
            "- has no option \"wait\" here, only \"keep\", \"rate\", \"burst\", \"byte_rate\", "
            "\"byte_burst\", \"memory\"");
  EXPECT_EQ(open_sink(*parse_uri("-?keep=some")).error().code, Code::Usage);
  EXPECT_EQ(open_source(*parse_uri("tcp:localhost:1?wait=x")).error().code, Code::Usage);
  EXPECT_EQ(open_sink(*parse_uri("unix-listen:@x?readers=-1")).error().code, Code::Usage);
}

TEST(Wait, GivesTheNumberOfDescriptorsWhenTimeIsUp) {
  EXPECT_EQ(*wait_readable({}, -1, std::chrono::milliseconds(1)), 0U);
}

}  // namespace
}  // namespace hc
