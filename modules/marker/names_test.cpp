// SPDX-License-Identifier: Apache-2.0
#include "names.h"

#include <gtest/gtest.h>

namespace {

using hc::vision::MarkerKind;

TEST(Names, AreReadAndFound) {
  auto names =
      read_names(" aruco:23=101, apriltag:7=102  colour:300=103 colour:330=104", 1, 999, true);
  ASSERT_TRUE(names) << names.error().text();
  ASSERT_EQ(names->size(), 4);
  EXPECT_EQ(find_name(*names, MarkerKind::Aruco, 23)->value, 101);
  EXPECT_EQ(find_name(*names, MarkerKind::AprilTag, 7)->value, 102);
  EXPECT_FALSE(find_name(*names, MarkerKind::AprilTag, 23));
  EXPECT_FALSE(find_name(*names, MarkerKind::Aruco, 24));
  EXPECT_TRUE(read_names("", 1, 999, true)->empty());
}

TEST(Names, AHueIsTheClosestOfThoseThatAreAlike) {
  auto names = read_names("colour:300=1 colour:330=2 colour:5=3", 0, 10, false);
  EXPECT_EQ(find_name(*names, MarkerKind::Colour, 312)->value, 1);
  EXPECT_EQ(find_name(*names, MarkerKind::Colour, 318)->value, 2);
  EXPECT_EQ(find_name(*names, MarkerKind::Colour, 350)->value, 3) << "round the circle";
  EXPECT_EQ(find_name(*names, MarkerKind::Colour, 350)->id, 5);
  EXPECT_FALSE(find_name(*names, MarkerKind::Colour, 200));
}

TEST(Names, WhatIsWrongIsNamedByItsWord) {
  for (const char* text :
       {"aruco", "aruco:5", "aruco=5", "aruco:5=", "aruco:=5", "aruco:x=5", "aruco:-1=5",
        "aruco:5=nan", "aruco:5=inf", "aruco:5=1000", "aruco:5=0", "aruco:5=1.5", "colour:360=5",
        "tag:5=5", "aruco:5=6=7", "aruco:5=6 aruco:5=7", "=:", "aruco:99999999999=5"}) {
    auto names = read_names(text, 1, 999, true);
    ASSERT_FALSE(names) << text;
    EXPECT_EQ(names.error().code, hc::Code::Invalid) << text;
  }
  EXPECT_NE(read_names("aruco:1=2 what:3=4", 1, 9, true).error().detail.find("\"what:3=4\""),
            std::string::npos);
  EXPECT_EQ(read_names("aruco:1=0.18", 0, 9, false)->at(0).value, 0.18);
}

}  // namespace
