// SPDX-License-Identifier: Apache-2.0
#include <web/identity.h>

#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <hc/testing/files.h>
#include <hc/testing/must.h>

namespace hc::web {
namespace {

namespace fs = std::filesystem;

TEST(Identity, is_made_once_and_kept_for_its_user_alone) {
  const Folder folder;
  const auto made = must(load_identity(folder / "deeper"));
  EXPECT_EQ(fingerprint(made).size(), 32U * 3 - 1);
  EXPECT_EQ(*load_identity(folder / "deeper"), made);
  struct stat status {};
  ASSERT_EQ(::stat((folder / "deeper/page_key.pem").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST(Identity, is_the_same_for_all_that_start_at_once) {
  for (int round = 0; round < 10; ++round) {
    const Folder folder;
    std::vector<std::future<Result<std::string>>> all;
    while (all.size() < 8)
      all.push_back(std::async(std::launch::async, [&] { return load_identity(folder.path()); }));
    std::set<std::string> found;
    for (auto& each : all) found.insert(must(each.get()));
    EXPECT_EQ(found.size(), 1U);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1)
        << "nothing else is left";
  }
}

TEST(Identity, of_which_a_part_is_missing_or_another_says_what_to_do) {
  const Folder folder;
  const auto made = load_identity(folder / "a"), other = load_identity(folder / "b");
  ASSERT_TRUE(made && other);
  const auto key = [](const std::string& text) {
    return text.substr(0, text.find("-----BEGIN CE"));
  };
  const auto certificate = [&](const std::string& text) { return text.substr(key(text).size()); };
  for (const auto& text : {std::string("nonsense"), key(*made), certificate(*made),
                           key(*other) + certificate(*made)}) {
    std::ofstream(folder / "a/page_key.pem") << text;
    const auto wrong = load_identity(folder / "a");
    ASSERT_FALSE(wrong) << text;
    EXPECT_EQ(wrong.error().code, Code::Malformed);
    EXPECT_NE(wrong.error().detail.find("; delete the file to make new ones"), std::string::npos);
  }
}

}  // namespace
}  // namespace hc::web
