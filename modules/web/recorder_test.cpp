// SPDX-License-Identifier: Apache-2.0
#include "recorder.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

class Recordings : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("recordings_" + std::to_string(::getpid()));
    fs::create_directories(folder_ / "one");
    std::ofstream(folder_ / "one/eyes.left.mtp") << std::string(700, 'a');
    std::ofstream(folder_ / "one/notes.txt") << "b";
    fs::create_directories(folder_ / "no recording");
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_F(Recordings, are_listed_with_their_streams) {
  const auto all = list_recordings(folder_);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].name, "one");
  EXPECT_EQ(all[0].bytes, 700U);
  EXPECT_EQ(all[0].streams, std::vector<std::string>{"eyes.left"});
  EXPECT_TRUE(list_recordings(folder_ / "nowhere").empty());
}

TEST_F(Recordings, an_archive_is_unpacked_by_tar) {
  const auto path = write_archive(folder_, "one");
  ASSERT_TRUE(path);
  fs::create_directories(folder_ / "out");
  const std::string command = "tar -C " + (folder_ / "out").string() + " -xf " + *path;
  ASSERT_EQ(std::system(command.c_str()), 0);
  std::ifstream file(folder_ / "out/one/eyes.left.mtp");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), std::string(700, 'a'));
  EXPECT_FALSE(write_archive(folder_, "two"));
}

TEST_F(Recordings, wrong_names_are_refused) {
  const hc::RunningGraph graph{"none", 1};
  const auto begin = [&](const std::string& name, const std::vector<std::string>& ports) {
    return Recorder::begin(graph, folder_, name, ports, [](hc::Severity, std::string_view) {});
  };
  for (const char* name : {"", "..", "a/b", "a b", "one"})
    EXPECT_FALSE(begin(name, {"eyes.left"})) << name;
  EXPECT_FALSE(begin("two", {}));
  EXPECT_FALSE(begin("two", {"eyes"}));
  EXPECT_FALSE(begin("two", {"../x.y"}));
  EXPECT_FALSE(begin("two", {"a.b", "a.b"}));
  EXPECT_FALSE(fs::exists(folder_ / "two"));
}

}  // namespace
