// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/coords.h>

#include <fstream>
#include <map>
#include <regex>
#include <string>

#include <gtest/gtest.h>

namespace {

/// Number and name of each coordinate system in the table of R44, whose rows are `| 7, 8 |
/// `left_image`, `right_image` | pixels |` and `| 20 … 24 | … |`.
std::map<int, std::string> table_of_specification() {
  std::ifstream file(HC_SOURCE_DIR "/spec/mtp-1.md");
  std::map<int, std::string> table;
  const std::regex row(R"(\| (\d+)[^|]*\| (`[a-z0-9_`, ]+`) \|.*)"), name("`([a-z0-9_]+)`");
  bool is_in_table = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("| coord |")) is_in_table = true;
    if (line.empty()) is_in_table = false;
    std::smatch match;
    if (!is_in_table || !std::regex_match(line, match, row)) continue;
    int number = std::stoi(match[1]);
    const std::string names = match[2];
    for (std::sregex_iterator each(names.begin(), names.end(), name), end; each != end; ++each)
      table[number++] = (*each)[1];
  }
  table.erase(0);  // 0 is no coordinate system
  return table;
}

TEST(Coords, AreThoseOfTheSpecification) {
  std::map<int, std::string> ours;
  for (const auto& each : hc::coords()) ours[each.number] = each.name;
  EXPECT_EQ(ours, table_of_specification());
}

TEST(Coords, AreFoundByNumberAndName) {
  EXPECT_EQ(hc::find_coord(hc::Coord::kGaze)->name, "gaze");
  EXPECT_EQ(hc::find_coord("left_eye")->number, hc::Coord::kLeftEye);
  EXPECT_TRUE(hc::find_coord("left_eye")->is_frame);
  EXPECT_FALSE(hc::find_coord("left_image")->is_frame);
  EXPECT_EQ(hc::find_coord(99), nullptr);
  EXPECT_EQ(hc::find_coord("nowhere"), nullptr);
}

TEST(Coords, HaveAText) {
  EXPECT_EQ(hc::coord_text(hc::Coord::kGaze), "gaze");
  EXPECT_EQ(hc::coord_text(hc::transform_coord(hc::Coord::kWorld, hc::Coord::kHead)),
            "world from head");
  EXPECT_EQ(hc::coord_text(123), "123");
  EXPECT_EQ(hc::coord_text(1'000'001), "1000001");
  EXPECT_EQ(hc::coord_and_number(hc::Coord::kLeftImage), "left_image (7)");
  EXPECT_EQ(hc::coord_and_number(123), "123");
}

}  // namespace
