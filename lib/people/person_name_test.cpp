// SPDX-License-Identifier: Apache-2.0
#include <people/person_name.h>

#include <gtest/gtest.h>

#include <string>

namespace hc::people {
namespace {

TEST(PersonName, can_be_that_of_a_file) {
  for (const std::string name : {"Anna", "Zoë de la Cruz", "王小明", "a", "x.y"})
    EXPECT_TRUE(is_person_name(name)) << name;
  EXPECT_TRUE(is_person_name(std::string(64, 'a')));
  for (const std::string name : {"", ".", "..", ".hidden", "a/b", "a\nb", "a\tb", "a\x7f",
                                 "a\xc2\x9b"
                                 "2J",
                                 "a\u202e"})
    EXPECT_FALSE(is_person_name(name)) << name;
  EXPECT_FALSE(is_person_name(std::string(65, 'a')));
  EXPECT_FALSE(is_person_name(std::string("a\0b", 3)));
}

TEST(PersonName, is_utf8) {
  for (const std::string name : {"\xff", "Zo\xeb", "Zo\xc3", "\xc0\xaf", "\xed\xa0\x80"})
    EXPECT_FALSE(is_person_name(name));
}

TEST(PersonName, follows_a_number) {
  const auto named = numbered_name("12 Zoë de la Cruz");
  ASSERT_TRUE(named);
  EXPECT_EQ(named->number, 12);
  EXPECT_EQ(named->name, "Zoë de la Cruz");
  EXPECT_EQ(numbered_name("1 ")->name, "");
  EXPECT_EQ(numbered_name("1")->name, "");
  for (const auto* text : {"", " Ann", "Ann", "0 Ann", "-1 Ann", "1.5 Ann", "99999999999 Ann"})
    EXPECT_FALSE(numbered_name(text)) << text;
}

}  // namespace
}  // namespace hc::people
