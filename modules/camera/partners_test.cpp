// SPDX-License-Identifier: Apache-2.0
#include "partners.h"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace {

using FilePairs = std::vector<std::pair<std::string, std::string>>;

FilePairs file_pairs(const Partners& partners) {
  FilePairs pairs;
  for (std::size_t i = 0; i < partners.left.size(); ++i)
    pairs.emplace_back(partners.left[i].string(), partners.right[i].string());
  return pairs;
}

TEST(Partners, the_same_names) {
  const auto found = partners_of({"l/1.png", "l/2.png", "l/10.png"}, {"r/2.jpg", "r/10.png"});
  EXPECT_EQ(file_pairs(found), (FilePairs{{"l/2.png", "r/2.jpg"}, {"l/10.png", "r/10.png"}}));
  EXPECT_EQ(found.alone, Paths{"l/1.png"});
}

TEST(Partners, the_same_numbers) {
  const auto found = partners_of({"l/left01_640x480.png", "l/left02_640x480.png"},
                                 {"r/right2_640x480.png", "r/right3_640x480.png"});
  EXPECT_EQ(file_pairs(found), (FilePairs{{"l/left02_640x480.png", "r/right2_640x480.png"}}));
  EXPECT_EQ(found.alone, (Paths{"l/left01_640x480.png", "r/right3_640x480.png"}));
}

TEST(Partners, the_same_last_number) {
  // As hc view --save writes them, with the address before the number.
  const auto found =
      partners_of({"l/1_0.png", "l/1_1.png", "l/1_2.png"}, {"r/2_0.png", "r/2_2.png"});
  EXPECT_EQ(file_pairs(found), (FilePairs{{"l/1_0.png", "r/2_0.png"}, {"l/1_2.png", "r/2_2.png"}}));
  EXPECT_EQ(found.alone, Paths{"l/1_1.png"});
}

TEST(Partners, one_in_each_folder_needs_no_number) {
  EXPECT_EQ(file_pairs(partners_of({"l/aloeL.jpg"}, {"r/aloeR.jpg"})),
            (FilePairs{{"l/aloeL.jpg", "r/aloeR.jpg"}}));
}

TEST(Partners, nothing_tells_which_belong_together) {
  EXPECT_TRUE(partners_of({"l/a.png", "l/b.png"}, {"r/c.png", "r/d.png"}).left.empty());
  EXPECT_TRUE(partners_of({"l/1.png"}, {"r/2.png", "r/3.png"}).left.empty());
  EXPECT_TRUE(partners_of({}, {"r/1.png"}).left.empty());
  // The last number is the same in all.
  EXPECT_TRUE(partners_of({"l/a1_8.png", "l/a2_8.png"}, {"r/b3_8.png"}).left.empty());
}

TEST(Partners, leading_zeros_and_zero) {
  EXPECT_EQ(file_pairs(partners_of({"l/000.png", "l/001.png"}, {"r/r0.png", "r/r1.png"})),
            (FilePairs{{"l/000.png", "r/r0.png"}, {"l/001.png", "r/r1.png"}}));
}

}  // namespace
