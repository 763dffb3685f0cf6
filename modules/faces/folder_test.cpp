// SPDX-License-Identifier: Apache-2.0
#include "folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace {

namespace fs = std::filesystem;
using hc::people::Embedding;

Embedding embedding(float first) {
  Embedding made = {};
  made[0] = first;
  return made;
}

class FolderTest : public testing::Test {
 protected:
  FolderTest() { fs::remove_all(path_); }
  ~FolderTest() override { fs::remove_all(path_); }

  Folder open() {
    return {path_, [this](std::string_view line) { said_.emplace_back(line); }};
  }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories(path_);
    std::ofstream(path_ + "/" + name) << text;
  }

  const std::string path_ = testing::TempDir() + "people_" +
                            testing::UnitTest::GetInstance()->current_test_info()->name();
  std::vector<std::string> said_;
};

TEST_F(FolderTest, keeps_people_for_the_next_start) {
  {
    Folder folder = open();
    EXPECT_FALSE(folder.read()) << "there is none yet";
    ASSERT_TRUE(folder.learn("Anna", {embedding(0.2F), embedding(0.4F)}));
    ASSERT_TRUE(folder.learn("Zoë de la Cruz", {embedding(-0.5F)}));
  }
  Folder folder = open();
  EXPECT_TRUE(folder.read());
  EXPECT_FALSE(folder.read()) << "nothing has changed";
  const auto names = folder.gallery().names();
  EXPECT_EQ(names.size(), 2U);
  const auto found = folder.gallery().find(embedding(0.3F), 0.01F);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->number, names.at("Anna"));
  EXPECT_EQ(fs::status(path_).permissions() & fs::perms::others_all, fs::perms::none);
  EXPECT_TRUE(said_.empty());
}

TEST_F(FolderTest, a_person_whose_file_is_deleted_is_forgotten) {
  Folder folder = open();
  ASSERT_TRUE(folder.learn("Anna", {embedding(0.2F)}));
  ASSERT_TRUE(folder.learn("Ben", {embedding(0.9F)}));
  const int anna = folder.gallery().names().at("Anna");
  fs::remove(path_ + "/Anna");
  EXPECT_TRUE(folder.read());
  EXPECT_FALSE(folder.gallery().names().contains("Anna"));
  ASSERT_TRUE(folder.learn("Cleo", {embedding(0.2F)}));
  EXPECT_NE(folder.gallery().names().at("Cleo"), anna) << "her number is not another's";
}

TEST_F(FolderTest, adds_views_and_drops_the_oldest) {
  Folder folder = open();
  ASSERT_TRUE(folder.learn("Anna", {embedding(0.2F)}));
  ASSERT_TRUE(folder.learn("Anna", {embedding(0.4F)}));
  EXPECT_TRUE(folder.gallery().find(embedding(0.3F), 0.01F));
  for (std::size_t i = 0; i < Folder::kMostViews; ++i)
    ASSERT_TRUE(folder.learn("Anna", {embedding(0.8F)}));
  EXPECT_TRUE(folder.gallery().find(embedding(0.8F), 0.01F));
}

TEST_F(FolderTest, files_that_are_no_people_are_named_and_ignored) {
  write("Text", "Anna is nice\n");
  write("Short", "MTP1 ");
  write("Empty", "");
  write(".hidden", "x");
  fs::create_directories(path_ + "/folder");
  Folder folder = open();
  ASSERT_TRUE(folder.learn("Anna", {embedding(0.2F)}));
  EXPECT_EQ(folder.gallery().names().size(), 1U);
  ASSERT_EQ(said_.size(), 3U);
  for (const auto& line : said_) {
    EXPECT_NE(line.find(path_), std::string::npos);
    EXPECT_NE(line.find(" is ignored: "), std::string::npos);
    EXPECT_EQ(line.find('\n'), std::string::npos);
  }
}

TEST_F(FolderTest, numbers_that_no_face_has_are_refused) {
  Embedding wild = embedding(0);
  wild[5] = 1e30F;
  {
    Folder folder = open();
    ASSERT_TRUE(folder.learn("Anna", {wild}));
    EXPECT_TRUE(folder.gallery().names().empty());
  }
  ASSERT_EQ(said_.size(), 1U);
}

TEST_F(FolderTest, a_file_that_is_no_persons_is_never_overwritten) {
  write("head.toml", "version = 1\n");
  Folder folder = open();
  const auto learned = folder.learn("head.toml", {embedding(0.2F)});
  ASSERT_FALSE(learned);
  EXPECT_NE(learned.error().detail.find("head.toml is not a person's"), std::string::npos);
  std::ifstream file(path_ + "/head.toml");
  std::string line;
  EXPECT_TRUE(std::getline(file, line) && line == "version = 1");
}

TEST_F(FolderTest, files_are_for_their_owner_alone) {
  fs::create_directories(path_);
  fs::permissions(path_, fs::perms::all);
  Folder folder = open();
  ASSERT_TRUE(folder.learn("Anna", {embedding(0.2F)}));
  const auto others = fs::perms::group_all | fs::perms::others_all;
  EXPECT_EQ(fs::status(path_ + "/Anna").permissions() & others, fs::perms::none);
  write("Anna.unfinished", "");  // as another user may have made it
  fs::permissions(path_ + "/Anna.unfinished", fs::perms::all);
  const auto learned = folder.learn("Anna", {embedding(0.3F)});
  ASSERT_FALSE(learned);
  EXPECT_NE(learned.error().detail.find("other users can read it"), std::string::npos);
  EXPECT_TRUE(folder.gallery().find(embedding(0.2F), 0.01F));
}

TEST_F(FolderTest, that_cannot_be_read_changes_nobody) {
  Folder folder = open();
  ASSERT_TRUE(folder.learn("Anna", {embedding(0.2F)}));
  for (int round = 1; round <= 2; ++round) {
    fs::rename(path_, path_ + " elsewhere");
    std::ofstream{path_} << "no folder";
    EXPECT_FALSE(folder.read());
    EXPECT_FALSE(folder.read());
    EXPECT_TRUE(folder.gallery().names().contains("Anna"));
    ASSERT_EQ(said_.size(), static_cast<std::size_t>(round)) << "once each time";
    EXPECT_NE(said_.back().find(path_ + " cannot be read"), std::string::npos) << said_.back();
    fs::remove(path_);
    fs::rename(path_ + " elsewhere", path_);
    EXPECT_FALSE(folder.read());
  }
}

TEST_F(FolderTest, names_cannot_lead_out_of_it) {
  Folder folder = open();
  for (const char* name :
       {"", "../Anna", "a/b", ".", "..", ".bashrc", "a\nb", "Anna.unfinished", "Zo\xeb"}) {
    const auto learned = folder.learn(name, {embedding(0)});
    ASSERT_FALSE(learned) << name;
    EXPECT_EQ(learned.error().code, hc::Code::Invalid);
  }
  EXPECT_FALSE(folder.learn(std::string(65, 'a'), {embedding(0)}));
  EXPECT_FALSE(fs::exists(path_));
}

TEST_F(FolderTest, nobody_is_learned_without_a_folder) {
  Folder folder("", [](std::string_view) {});
  EXPECT_FALSE(folder.read());
  const auto learned = folder.learn("Anna", {embedding(0)});
  ASSERT_FALSE(learned);
  EXPECT_NE(learned.error().detail.find("parameter people"), std::string::npos);
}

}  // namespace
