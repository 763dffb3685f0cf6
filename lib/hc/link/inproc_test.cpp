// SPDX-License-Identifier: Apache-2.0
#include <hc/testing/link_conformance.h>

namespace hc::testing {
namespace {

std::pair<std::string, std::string> make() {
  static int number = 0;
  std::string uri = "inproc:test" + std::to_string(number++);
  return {uri, uri};
}

INSTANTIATE_TEST_SUITE_P(Inproc, LinkConformance,
                         ::testing::Values(Transport{"inproc", make, false, true}));

TEST(Inproc, AnEndHasOneUser) {
  auto first = source_of("inproc:one");
  EXPECT_FALSE(open_source(*parse_uri("inproc:one")));
  auto sink = sink_of("inproc:one");
  EXPECT_FALSE(open_sink(*parse_uri("inproc:one")));
  first.reset();
  sink.reset();
  EXPECT_TRUE(open_source(*parse_uri("inproc:one")));
}

TEST(Inproc, ElementsAreShared) {
  auto source = source_of("inproc:shared");
  auto sink = sink_of("inproc:shared");
  Message sent = numbered(1, 100), got;
  ASSERT_TRUE(sink->send(sent));
  EXPECT_EQ(next(*source).elements.data(), sent.elements.data());
}

}  // namespace
}  // namespace hc::testing
