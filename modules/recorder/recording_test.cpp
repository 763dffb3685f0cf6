// SPDX-License-Identifier: Apache-2.0
#include "recording.h"

#include <filesystem>
#include <set>

#include <gtest/gtest.h>

namespace {

TEST(FreeName, HasANumberWhereTheNameIsTaken) {
  const std::set<std::string> taken = {"kept.mcap", "kept_2.mcap", "kept/", "runs/2026.11.24"};
  auto name = [&](const std::string& path) {
    return free_name(path, [&](const std::string& each) { return !taken.contains(each); });
  };
  EXPECT_EQ(name("new.mcap"), "new.mcap");
  EXPECT_EQ(name("new/"), "new/");
  EXPECT_EQ(name("kept.mcap"), "kept_3.mcap");
  EXPECT_EQ(name("kept/"), "kept_2");
  EXPECT_EQ(name("runs/2026.11.24"), "runs/2026.11.24_2");
}

TEST(FreeName, OfTheWorkingFolderIsBesideIt) {
  const auto here = std::filesystem::current_path();
  auto sibling = [](const std::string& path) {
    return free_name(path, [&](const std::string& each) { return each != path; });
  };
  EXPECT_EQ(sibling("."), here.string() + "_2");
  EXPECT_EQ(sibling("./"), here.string() + "_2");
  EXPECT_EQ(sibling("x/.."), here.string() + "_2");
  EXPECT_EQ(sibling(".."), here.parent_path().string() + "_2");
}

}  // namespace
