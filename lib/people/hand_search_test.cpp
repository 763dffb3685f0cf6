// SPDX-License-Identifier: Apache-2.0
// With the real networks, and a photograph of OpenCV's documentation: a player with both hands
// stretched out.
#include <people/hand_search.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <people/sign.h>

namespace hc::people {
namespace {

using namespace std::chrono_literals;

constexpr Time kFirstImage{100s};
const std::string kHandWeights = HC_BINARY_DIR "/share/hypercolumn/nets/";

template <typename Finder>
Finder made(const std::string& weights) {
  auto network = nets::Network::read(kHandWeights + weights);
  if (!network) throw std::runtime_error(network.error().text());
  auto finder = Finder::make(std::move(*network));
  if (!finder) throw std::runtime_error(finder.error().text());
  return std::move(*finder);
}
PalmFinder made_palms() {
  return made<PalmFinder>("palm_detection_lite.tflite");
}
HandLandmarks made_landmarks() {
  return made<HandLandmarks>("hand_landmark_lite.tflite");
}

cv::Mat photograph() {
  const char* folder = std::getenv("HC_DATA");
  return cv::imread(
      (folder ? folder : "/usr/share/doc/opencv-doc/examples/data") + std::string("/messi5.jpg"),
      cv::IMREAD_COLOR);
}

class HandsInAPhotograph : public testing::Test {
 protected:
  void SetUp() override {
    const cv::Mat bgr = photograph();
    if (bgr.empty()) GTEST_SKIP() << "messi5.jpg is not there (opencv-doc)";
    cv::cvtColor(bgr, image_, cv::COLOR_BGR2RGB);
  }

  static constexpr float kAside = 1.5F;
  /// The hand with its fingers up, or turned from there, in a square image.
  [[nodiscard]] cv::Mat tile(float turn) const {
    constexpr float kTile = 240, kScale = 3;
    const float by = turn - kAside;
    const float cos = kScale * std::cos(by), sin = kScale * std::sin(by);
    const cv::Point2f from = region_.middle;
    const cv::Matx23f turned(cos, -sin, kTile / 2 - cos * from.x + sin * from.y, sin, cos,
                             kTile / 2 - sin * from.x - cos * from.y);
    cv::Mat made;
    cv::warpAffine(image_, made, turned, {static_cast<int>(kTile), static_cast<int>(kTile)});
    return made;
  }

  /// The hand before the player, found and looked at again.
  Hand hand(const cv::Mat& image, Region region) {
    for (int i = 0; i < 3; ++i) region = region_of(landmarks_.find(image, region));
    return landmarks_.find(image, region);
  }

  cv::Mat image_;
  HandLandmarks landmarks_ = made_landmarks();
  Region region_{{363, 166}, 54, 1.85F};
};

TEST_F(HandsInAPhotograph, are_found_by_their_palms) {
  auto finder = made_palms();
  const auto palms = finder.find(image_, {0, 0, image_.cols, image_.rows});
  ASSERT_GE(palms.size(), 1U);
  EXPECT_GT(palms[0].score, 0.7F);
  const Region region = region_of(palms[0]);
  EXPECT_LT(cv::norm(region.middle - cv::Point2f(360, 166)), 10);
  EXPECT_NEAR(region.turn, 1.6F, 0.4F) << "the fingers are to the right";
}

TEST_F(HandsInAPhotograph, have_points_that_stay_where_the_region_moves) {
  const Hand usual = hand(image_, region_);
  EXPECT_GT(usual.presence, 0.9F);
  EXPECT_GT(usual.points[Hand::MiddleTip].x, usual.points[Hand::Wrist].x + 20);
  Region moved = region_;
  moved.middle += {4, -3};
  moved.side *= 1.15F;
  moved.turn -= 0.2F;
  const Hand other = hand(image_, moved);
  for (std::size_t i = 0; i < Hand::kPoints; ++i)
    EXPECT_LT(cv::norm(other.points[i] - usual.points[i]), 3) << i;
}

TEST_F(HandsInAPhotograph, turn_with_the_image) {
  const Hand usual = landmarks_.find(image_, region_);
  cv::Mat turned;  // a pixel (x, y) comes to (height - 1 - y, x)
  cv::rotate(image_, turned, cv::ROTATE_90_CLOCKWISE);
  const auto place = [&](const cv::Point2f& p) {
    return cv::Point2f(static_cast<float>(image_.rows) - 1 - p.y, p.x);
  };
  constexpr float kQuarter = 1.5707963F;
  const Hand after =
      landmarks_.find(turned, {place(region_.middle), region_.side, region_.turn + kQuarter});
  EXPECT_NEAR(after.presence, usual.presence, 0.01F);
  for (std::size_t i = 0; i < Hand::kPoints; ++i) {
    EXPECT_LT(cv::norm(after.points[i] - place(usual.points[i])), 0.3) << i;
    const cv::Point3f world(-usual.world[i].y, usual.world[i].x, usual.world[i].z);
    EXPECT_LT(cv::norm(after.world[i] - world), 1e-3) << i;
  }
}

TEST_F(HandsInAPhotograph, are_the_other_ones_in_a_mirror) {
  const Hand usual = hand(image_, region_);
  cv::Mat mirrored;
  cv::flip(image_, mirrored, 1);
  const auto width = static_cast<float>(image_.cols);
  const Hand other = hand(
      mirrored, {{width - 1 - region_.middle.x, region_.middle.y}, region_.side, -region_.turn});
  EXPECT_NE(usual.side, other.side);
  for (std::size_t i = 0; i < Hand::kPoints; ++i)
    EXPECT_LT(
        cv::norm(other.points[i] - cv::Point2f(width - 1 - usual.points[i].x, usual.points[i].y)),
        6)
        << i;
}

TEST_F(HandsInAPhotograph, are_found_and_followed) {
  HandSearch search(made_palms(), made_landmarks());
  std::vector<HandTrack> tracks;
  cv::Mat image;
  for (int i = 0; i < 20; ++i) {  // the camera turns by 6 px in an image
    const cv::Matx23f shift(1, 0, static_cast<float>(6 * i), 0, 1, 0);
    cv::warpAffine(image_, image, shift, image_.size());
    tracks = search.look(kFirstImage + i * 100ms, image);
    if (i > 3) {
      ASSERT_GE(tracks.size(), 1U) << i;
      EXPECT_EQ(tracks[0].number, 1) << i;
    }
  }
  const auto near = [&](float x, float y) {
    return std::count_if(tracks.begin(), tracks.end(), [&](const HandTrack& track) {
      return cv::norm(region_of(track.hand).middle - cv::Point2f(x + 114, y)) < 15;
    });
  };
  EXPECT_EQ(near(360, 166), 1);
  EXPECT_LE(tracks.size(), 2U);
}

TEST_F(HandsInAPhotograph, are_followed_beside_enough_others_while_they_are_up) {
  HandSearch search(made_palms(), made_landmarks(), 1);
  Time time = kFirstImage;
  const auto look = [&](float turn) {
    cv::Mat both;
    cv::hconcat(tile(kAside), tile(turn), both);
    std::vector<HandTrack> tracks;
    for (int i = 0; i < 25; ++i) tracks = search.look(time += 100ms, both);
    return tracks;
  };
  EXPECT_EQ(look(kAside).size(), 1U) << "no more than that";
  const auto tracks = look(0);
  ASSERT_EQ(tracks.size(), 2U);
  EXPECT_EQ(tracks[0].number, 1);
  EXPECT_EQ(sign_of(tracks[0].hand), Sign::None);
  EXPECT_EQ(sign_of(tracks[1].hand), Sign::Open);
  EXPECT_EQ(look(kAside).size(), 1U) << "it is not up any more";
}

TEST(HandSearch, finds_nothing_in_a_wall) {
  HandSearch search(made_palms(), made_landmarks());
  const cv::Mat wall(600, 800, CV_8UC3, cv::Scalar(120, 110, 100));
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(search.look(kFirstImage + i * 250ms, wall).empty());
  EXPECT_TRUE(search.look(kFirstImage, cv::Mat()).empty());
  EXPECT_TRUE(search.look(kFirstImage + 1s, cv::Mat(30, 40, CV_8UC1, cv::Scalar(90))).empty())
      << "grey";
}

TEST(HandSearch, searches_at_times) {
  SearchTimes times;
  EXPECT_TRUE(times.is_due(kFirstImage, true, false));
  EXPECT_FALSE(times.is_due(kFirstImage + 99ms, true, false));
  EXPECT_TRUE(times.is_due(kFirstImage + 100ms, true, false));
  EXPECT_FALSE(times.is_due(kFirstImage + 999ms, false, false)) << "no face is in view";
  EXPECT_TRUE(times.is_due(kFirstImage + 1100ms, false, false));
  EXPECT_TRUE(times.is_due(kFirstImage, true, false)) << "time went back";
}

TEST(HandSearch, waits_while_a_palm_may_be_a_command) {
  SearchTimes times;
  EXPECT_FALSE(times.is_due(kFirstImage, true, true));
  EXPECT_FALSE(times.is_due(kFirstImage + 300ms, true, true));
  EXPECT_TRUE(times.is_due(kFirstImage + 400ms, true, false)) << "taken for another sign";
  EXPECT_FALSE(times.is_due(kFirstImage + 500ms, true, true)) << "the same palm";
  EXPECT_FALSE(times.is_due(kFirstImage + 690ms, true, true));
  EXPECT_TRUE(times.is_due(kFirstImage + 700ms, true, true)) << "it has had its time";
  EXPECT_TRUE(times.is_due(kFirstImage + 900ms, true, true));
  EXPECT_TRUE(times.is_due(kFirstImage + 1100ms, true, false)) << "it is down";
  EXPECT_FALSE(times.is_due(kFirstImage + 1300ms, true, true)) << "another palm";
}

TEST_F(HandsInAPhotograph, are_looked_at_less_often_while_a_palm_comes_up) {
  HandSearch search(made_palms(), made_landmarks(), 2);
  Time time = kFirstImage;
  std::vector<std::size_t> open, others;  // hands in each image
  const auto look = [&](float turn, int images) {
    cv::Mat both;
    cv::hconcat(tile(kAside), tile(turn), both);
    for (int i = 0; i < images; ++i) {
      const auto tracks = search.look(time += 50ms, both);
      open.push_back(static_cast<std::size_t>(std::ranges::count_if(
          tracks, [](const HandTrack& track) { return sign_of(track.hand) == Sign::Open; })));
      others.push_back(tracks.size() - open.back());
    }
  };
  look(kAside, 40);
  EXPECT_EQ(open.back(), 0U);
  EXPECT_EQ(others.back(), 2U);
  look(0, 40);
  const auto up = std::ranges::find(open, 1U);
  ASSERT_LT(up, open.end() - 20);
  EXPECT_EQ(std::count(up, open.end(), 1U), open.end() - up) << "the palm is in each image";
  const auto first = others.begin() + (up - open.begin());
  EXPECT_EQ(std::count(first + 1, first + 13, 1U), 4) << "the other one in each third";
  // The palm's pause begins with the first image or, if a search found the palm, with the second.
  EXPECT_EQ(std::count(first + 16, others.end(), 1U), others.end() - first - 16) << "in each again";
}

TEST(HandSearch, looks_at_other_hands_less_often_while_a_palm_may_be_a_command) {
  SearchTimes times;
  Time time = kFirstImage;
  /// In how many images, 50 ms apart, other hands are looked at, if there is a palm or not.
  const auto looks = [&](int images, bool is_palm) {
    int count = 0;
    for (int i = 0; i < images; ++i, time += 50ms) {
      count += times.are_others_due(time) ? 1 : 0;
      times.is_due(time, true, is_palm);
    }
    return count;
  };
  EXPECT_EQ(looks(10, false), 10);
  EXPECT_EQ(looks(13, true), 5) << "the first one, before the palm is seen, and each third";
  EXPECT_EQ(looks(10, true), 8) << "from 700 ms";
}

TEST(HandSearch, waits_for_an_image_in_which_all_hands_are_looked_at) {
  SearchTimes times;
  EXPECT_TRUE(times.are_others_due(kFirstImage));
  EXPECT_FALSE(times.is_due(kFirstImage, true, true));
  EXPECT_FALSE(times.are_others_due(kFirstImage + 50ms));
  EXPECT_FALSE(times.is_due(kFirstImage + 50ms, true, false)) << "the palm is lost";
  EXPECT_TRUE(times.are_others_due(kFirstImage + 100ms));
  EXPECT_TRUE(times.is_due(kFirstImage + 100ms, true, false));
}

TEST_F(HandsInAPhotograph, far_from_the_camera_are_found_beside_a_face) {
  // As far away as a person at 3 m: neither the whole image nor a part shows the hand large enough.
  cv::Mat far, image(600, 800, CV_8UC3, cv::Scalar(120, 110, 100));
  cv::resize(image_, far, {}, 0.35, 0.35, cv::INTER_AREA);
  far.copyTo(image(cv::Rect({20, 200}, far.size())));
  HandSearch blind(made_palms(), made_landmarks()), search(made_palms(), made_landmarks());
  const cv::Rect2f face(20 + 0.35F * 224, 200 + 0.35F * 84, 0.35F * 60, 0.35F * 60);
  Time time = kFirstImage;
  std::size_t without = 0, with = 0;
  for (int i = 0; i < 12; ++i) {
    time += 100ms;
    without += blind.look(time, image).size();
    with += search.look(time, image, std::vector{face}).size();
  }
  EXPECT_EQ(without, 0U);
  EXPECT_GT(with, 0U);
  for (const cv::Rect2f& odd : {cv::Rect2f(-900, -900, 20, 20), cv::Rect2f(0, -1990, 60, 2000),
                                cv::Rect2f(-1e8F, 0, 1e9F, 1e9F), cv::Rect2f(799, 599, 1, 1)})
    for (int i = 0; i < 3; ++i)
      EXPECT_NO_THROW(search.look(time += 100ms, image, std::vector{odd})) << odd;
}

TEST(Networks, that_do_not_fit_are_refused) {
  auto faces = nets::Network::read(kHandWeights + "face_detection_full_range.tflite");
  ASSERT_TRUE(faces);
  const auto palms = PalmFinder::make(std::move(*faces));
  ASSERT_FALSE(palms);
  EXPECT_EQ(palms.error().text(),
            "Malformed: not a network that finds palms: its input is 192×192×3");
  auto other = nets::Network::read(kHandWeights + "palm_detection_lite.tflite");
  ASSERT_TRUE(other);
  const auto landmarks = HandLandmarks::make(std::move(*other));
  ASSERT_FALSE(landmarks);
  EXPECT_EQ(landmarks.error().text(),
            "Malformed: not a network that finds the points of hands: its input is 192×192×3");
}

}  // namespace
}  // namespace hc::people
