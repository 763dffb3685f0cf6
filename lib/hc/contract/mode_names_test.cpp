// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/mode_names.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

TEST(ModeNames, are_read_by_number_as_they_are_written) {
  EXPECT_EQ(mode_names_text({{"track", 4}, {"read", 5}}), "read=5,track=4");
  const auto names = parse_mode_names("read=5,track=4");
  ASSERT_TRUE(names) << names.error().detail;
  EXPECT_EQ(*names, (std::map<std::int32_t, std::string>{{4, "track"}, {5, "read"}}));
  EXPECT_TRUE(parse_mode_names(mode_names_text({}))->empty());
}

TEST(ModeNames, what_is_no_name_with_a_number_is_refused) {
  for (const char* wrong : {"track", "=4", "track=", "track=0", "track=-1", "track=4x", ",",
                            "track=4 read=5", "track=99999999999", "read=5,", "read=5,track=5"})
    EXPECT_EQ(parse_mode_names(wrong).error().code, Code::Invalid) << wrong;
  EXPECT_EQ(parse_mode_names("read=5,track").error().detail,
            "mode_names: \"track\" is not NAME=NUMBER with a unique number, as in read=5,track=4");
}

}  // namespace
}  // namespace hc
