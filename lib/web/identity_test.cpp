// SPDX-License-Identifier: Apache-2.0
#include <web/identity.h>

#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

namespace hc::web {

namespace {

namespace fs = std::filesystem;

TEST(Identity, is_made_once_and_kept_for_its_user_alone) {
  const fs::path folder = fs::path(testing::TempDir()) / ("identity_" + std::to_string(::getpid()));
  fs::remove_all(folder);
  const auto made = load_identity(folder / "deeper");
  ASSERT_TRUE(made);
  const auto print = fingerprint(made->certificate);
  ASSERT_TRUE(print);
  EXPECT_EQ(print->size(), 32U * 3 - 1);
  const auto again = load_identity(folder / "deeper");
  EXPECT_EQ(again->certificate, made->certificate);
  EXPECT_EQ(again->key, made->key);
  struct stat status {};
  ASSERT_EQ(::stat((folder / "deeper/page_key.pem").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
  std::ofstream(folder / "deeper/page_certificate.pem") << "nonsense";
  const auto broken = load_identity(folder / "deeper");
  ASSERT_FALSE(broken);
  EXPECT_EQ(broken.error().code, Code::Malformed);
  fs::remove_all(folder);
}

TEST(Identity, of_which_a_part_is_missing_or_another_says_what_to_do) {
  const fs::path folder = fs::path(testing::TempDir()) / ("parts_" + std::to_string(::getpid()));
  const auto made = load_identity(folder / "a"), other = load_identity(folder / "b");
  ASSERT_TRUE(made && other);
  const auto copy = fs::copy_options::overwrite_existing;
  fs::copy_file(folder / "b/page_key.pem", folder / "a/page_key.pem", copy);
  auto wrong = load_identity(folder / "a");
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().detail.find("; delete both to have new ones made"), std::string::npos);
  for (const char* part : {"page_key.pem", "page_certificate.pem"}) {
    fs::rename(folder / "b" / part, folder / "kept");
    wrong = load_identity(folder / "b");
    ASSERT_FALSE(wrong);
    EXPECT_NE(wrong.error().detail.find("; delete it to have new ones made"), std::string::npos);
    fs::rename(folder / "kept", folder / "b" / part);
  }
  EXPECT_EQ(load_identity(folder / "b")->key, other->key);
  fs::remove_all(folder);
}

}  // namespace

}  // namespace hc::web
