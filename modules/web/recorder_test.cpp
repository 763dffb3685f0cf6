// SPDX-License-Identifier: Apache-2.0
#include "recorder.h"

#include <sys/stat.h>

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

/// What the parts of a reply are, one after the other.
std::string bytes_of(const std::vector<web::Part>& parts) {
  std::string all;
  for (const auto& part : parts) {
    if (part.bytes) all += *part.bytes;
    if (part.size == 0) continue;
    std::ifstream file(part.file, std::ios::binary);
    all += std::string(std::istreambuf_iterator<char>(file), {}).substr(0, part.size);
  }
  return all;
}

TEST_F(Recordings, an_archive_is_unpacked_by_tar) {
  // One name fills its place in a head, the next is too long for it.
  const std::string full = std::string(95, 'm') + ".p", longer = "m." + std::string(200, 'p');
  for (const auto& port : {full, longer}) std::ofstream(folder_ / ("one/" + port + ".mtp")) << port;
  std::ofstream(folder_ / "one/a.empty.mtp");
  const auto parts = archive_of(folder_, "one");
  ASSERT_TRUE(parts);
  std::ofstream(folder_ / "one.tar", std::ios::binary) << bytes_of(*parts);
  fs::create_directories(folder_ / "out");
  const std::string command =
      "tar -C " + (folder_ / "out").string() + " -xf " + (folder_ / "one.tar").string();
  ASSERT_EQ(std::system(command.c_str()), 0);
  auto unpacked = [&](const std::string& port) {
    std::ifstream file(folder_ / ("out/one/" + port + ".mtp"));
    EXPECT_TRUE(file.is_open()) << port;
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  EXPECT_EQ(unpacked("eyes.left"), std::string(700, 'a'));
  EXPECT_EQ(unpacked("a.empty"), "");
  for (const auto& port : {full, longer}) EXPECT_EQ(unpacked(port), port);
  EXPECT_FALSE(archive_of(folder_, "two"));
}

TEST_F(Recordings, what_is_no_file_is_left_out) {
  fs::create_symlink("nowhere", folder_ / "one/dangling.link.mtp");
  fs::create_symlink("loop.link.mtp", folder_ / "one/loop.link.mtp");
  fs::create_directories(folder_ / "one/a.folder.mtp");
  ASSERT_EQ(::mkfifo((folder_ / "one/a.fifo.mtp").c_str(), 0600), 0);
  fs::create_symlink("nowhere", folder_ / "dangling");
  const auto all = list_recordings(folder_);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].streams, std::vector<std::string>{"eyes.left"});
  EXPECT_EQ(archive_of(folder_, "one")->size(), 2U);
  for (const char* port : {"dangling.link", "loop.link", "a.folder", "a.fifo", "a.nothing"})
    EXPECT_FALSE(recorded_file(folder_, "one", port)) << port;
}

TEST_F(Recordings, wrong_names_are_refused) {
  const hc::RunningGraph graph{"none", 1};
  const auto begin = [&](const std::string& name, const std::vector<std::string>& ports) {
    return Recorder::begin(graph, folder_, name, ports, [](hc::Level, std::string_view) {});
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
