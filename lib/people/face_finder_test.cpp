// SPDX-License-Identifier: Apache-2.0
// The photographs are of a package of networks (nets/package.json): private persons, in no picture
// or document of ours.
#include <people/face_finder.h>

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <people/box.h>
#include <people/face_search.h>
#include <people/gallery.h>

namespace {

using namespace std::chrono_literals;
using hc::people::Face;
using hc::people::FaceFinder;
using hc::people::FaceSearch;

/// One of six photographs of 3 to 5 persons, 800 pixels wide; RGB.
cv::Mat photograph(int number) {
  cv::Mat bgr = cv::imread(HC_SOURCE_DIR "/nets/node_modules/@vladmandic/face-api/demo/sample" +
                           std::to_string(number) + ".jpg");
  EXPECT_FALSE(bgr.empty()) << "the weights have been installed without photographs";
  cv::Mat rgb;
  cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
  cv::resize(rgb, rgb, {800, 800 * rgb.rows / rgb.cols}, 0, 0, cv::INTER_AREA);
  return rgb;
}

/// The face around a place, as the small network sees it.
std::optional<Face> face_around(FaceFinder& near, const cv::Mat& image, cv::Point2f middle,
                                float side) {
  const auto found =
      near.find(image, cv::Rect(cv::Rect2f(middle.x - side / 2, middle.y - side / 2, side, side)));
  for (const Face& face : found)
    if (face.box.contains(middle)) return face;
  return std::nullopt;
}

/// How long it takes until all parts of an image are searched while faces are followed.
std::chrono::milliseconds sweep_of(const cv::Mat& image) {
  const auto parts = hc::people::parts_of(image.size(), FaceFinder::read_wide()->size());
  return FaceSearch::kSweep * static_cast<int>(parts.size());
}

cv::Point2f middle_of(const Face& face) {
  return (face.box.tl() + face.box.br()) / 2;
}

constexpr int kFaces[] = {3, 3, 3, 4, 5, 4};  // in the photographs

constexpr hc::Time kStart(1'700'000'000s);

TEST(FaceSearch, finds_everybody_in_group_photographs) {
  for (int i = 0; i < 6; ++i)
    EXPECT_EQ(FaceSearch::read()->look(kStart, photograph(i + 1)).size(), kFaces[i]) << i + 1;
}

TEST(FaceSearch, finds_a_face_that_fills_the_image_once) {
  const cv::Mat image = photograph(1);
  const auto tracks = FaceSearch::read()->look(kStart, image);
  ASSERT_EQ(tracks.size(), 3U);
  for (const auto& track : tracks)
    for (const float wider : {1.1F, 1.3F, 1.6F}) {
      const cv::Rect2f face = track.face.box;
      const float height = wider * face.width, width = height * 4 / 3;
      const cv::Point2f middle = middle_of(track.face);
      const cv::Rect part(cv::Rect2f(middle.x - width / 2, middle.y - height / 2, width, height));
      ASSERT_EQ(part & cv::Rect({}, image.size()), part);
      cv::Mat near_by;
      cv::resize(image(part), near_by, {800, 600});
      const float scale = 600 / height;
      const cv::Point2f at = (face.tl() - cv::Point2f(part.tl())) * scale;
      const cv::Rect2f expected(at, cv::Size2f(face.width * scale, face.height * scale));
      auto faces = *FaceSearch::read();
      for (auto now = kStart; now < kStart + 1s; now += 50ms) {
        const auto seen = faces.look(now, near_by);
        ASSERT_EQ(seen.size(), 1U) << track.number << ' ' << wider;
        EXPECT_EQ(seen[0].number, 1);
        EXPECT_GT(hc::people::overlap(seen[0].face.box, expected), 0.5F)
            << seen[0].face.box << ' ' << expected;
      }
    }
}

TEST(FaceSearch, finds_them_in_black_and_white) {
  cv::Mat grey;
  cv::cvtColor(photograph(5), grey, cv::COLOR_RGB2GRAY);
  EXPECT_EQ(FaceSearch::read()->look(kStart, grey).size(), 5U);
}

TEST(FaceSearch, finds_no_face_that_is_upside_down) {
  std::size_t found = 0;
  for (int i = 0; i < 6; ++i) {
    cv::Mat turned;
    cv::rotate(photograph(i + 1), turned, cv::ROTATE_180);
    found += FaceSearch::read()->look(kStart, turned).size();
  }
  EXPECT_EQ(found, 0U) << "of 22";
}

TEST(FaceSearch, finds_nobody_where_there_is_nobody) {
  cv::Mat noise(600, 800, CV_8UC3);
  cv::RNG random(7);
  random.fill(noise, cv::RNG::UNIFORM, 0, 255);
  EXPECT_TRUE(FaceSearch::read()->look(kStart, noise).empty());
  for (const int level : {0, 128, 255})
    EXPECT_TRUE(FaceSearch::read()
                    ->look(kStart, cv::Mat(600, 800, CV_8UC3, cv::Scalar::all(level)))
                    .empty());
}

TEST(FaceSearch, takes_images_of_any_size) {
  for (const cv::Size size :
       {cv::Size(1, 1), {1, 600}, {800, 1}, {16, 16}, {4000, 300}, {300, 4000}, {65535, 40}})
    EXPECT_TRUE(
        FaceSearch::read()->look(kStart, cv::Mat(size, CV_8UC3, cv::Scalar::all(90))).empty())
        << size;
  EXPECT_TRUE(FaceSearch::read()->look(kStart, cv::Mat()).empty());
}

TEST(FaceSearch, looks_around_no_box_that_is_no_place) {
  auto faces = *FaceSearch::read();
  const cv::Mat image(60, 80, CV_8UC3, cv::Scalar::all(90));
  for (const cv::Rect2f& box : {cv::Rect2f(NAN, 0, 9, 9), cv::Rect2f(0, 0, INFINITY, 9),
                                cv::Rect2f(0, 0, 1e6F, 1e6F), cv::Rect2f(1e12F, 0, 9, 9)})
    EXPECT_TRUE(faces.look_around(image, box).empty()) << box;
}

TEST(FaceSearch, follows_faces_by_the_same_numbers) {
  FaceSearch faces = *FaceSearch::read();
  const cv::Mat image = photograph(3);
  hc::Time now = kStart;
  for (int i = 0; i < 10; ++i, now += 50ms) {
    const cv::Matx23d shift(1, 0, 6 * i, 0, 1, 0);
    cv::Mat moved;
    cv::warpAffine(image, moved, shift, image.size());
    const auto seen = faces.look(now, moved);
    ASSERT_EQ(seen.size(), 3U) << i;
    for (const auto& track : seen) EXPECT_LE(track.number, 3) << i;
  }
}

TEST(FaceSearch, finds_in_time_who_comes_in_while_others_are_followed) {
  FaceSearch faces = *FaceSearch::read();
  cv::Mat image = photograph(6), without = image.clone();
  const auto all = FaceSearch::read()->look(kStart, image);
  const auto rightmost = std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.face.box.x < b.face.box.x;
  });
  without.colRange(static_cast<int>(rightmost->face.box.x - 20), without.cols).setTo(40);
  const std::size_t before = faces.look(kStart, without).size();
  EXPECT_LT(before, all.size());
  hc::Time now = kStart;
  std::size_t seen = before;
  for (; now <= kStart + sweep_of(image) && seen < all.size(); now += 50ms)
    seen = faces.look(now, image).size();
  EXPECT_EQ(seen, all.size());
}

TEST(FaceSearch, takes_a_face_beside_a_followed_one_for_new_only_after_a_search) {
  FaceSearch faces = *FaceSearch::read();
  cv::Mat image = photograph(1);
  const auto first = faces.look(kStart, image);
  // The same face once more, half as large, so near that the small network sees both.
  const cv::Rect box(first.at(0).face.box);
  const cv::Rect from = (box + box.size() / 2) - cv::Point(box.size() / 4);
  cv::Rect to({}, from.size() / 2);
  to += cv::Point(box.x + box.width / 2 - to.width / 2, box.y + box.height * 23 / 20);
  ASSERT_EQ((from | to) & cv::Rect({}, image.size()), from | to);
  cv::Mat other = image.clone(), small = other(to);
  cv::resize(image(from), small, to.size(), 0, 0, cv::INTER_AREA);
  const auto last = kStart + sweep_of(image);
  EXPECT_EQ(faces.look_around(other, first.at(0).face.box).size(), 2U);
  EXPECT_EQ(faces.look(kStart + 50ms, other).size(), first.size());
  std::size_t most = 0;
  for (auto now = kStart + 100ms; now <= last + 50ms; now += 50ms)
    most = std::max(most, faces.look(now, other).size());
  EXPECT_EQ(most, first.size() + 1);
}

TEST(FaceFinder, finds_faces_that_are_tilted_or_partly_outside) {
  auto near = *FaceFinder::read_near();
  const cv::Mat image = photograph(1);
  const auto middle = middle_of(FaceSearch::read()->look(kStart, image).at(0).face);
  const float side = 250;
  const auto upright = face_around(near, image, middle, side);
  ASSERT_TRUE(upright);
  for (const double degrees : {-25, 25}) {
    cv::Mat turned;
    cv::warpAffine(image, turned, cv::getRotationMatrix2D(middle, degrees, 1), image.size());
    const auto found = face_around(near, turned, middle, side);
    ASSERT_TRUE(found) << degrees;
    // [rad], since it takes tilted faces for more upright ones than they are.
    EXPECT_NEAR(found->roll(), upright->roll() - degrees * CV_PI / 180, 0.2) << degrees;
  }
  const cv::Mat half = image.colRange(static_cast<int>(middle.x), image.cols);
  near.find(half, {0, 0, half.cols, half.rows});  // whether it counts is the network's affair
}

TEST(FaceFinder, refuses_other_networks) {
  auto network =
      hc::nets::Network::read(HC_BINARY_DIR "/share/hypercolumn/nets/palm_detection_lite.tflite");
  ASSERT_TRUE(network);
  const auto made = FaceFinder::make(std::move(*network));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, hc::Code::Malformed);
}

TEST(Embedding, is_near_for_one_person_and_far_for_others) {
  auto network =
      hc::nets::Network::read(HC_BINARY_DIR "/share/hypercolumn/nets/face_recognition.json");
  ASSERT_TRUE(network);
  auto identifier = *hc::people::Identifier::make(std::move(*network));
  auto near = *FaceFinder::read_near();
  for (int i = 1; i <= 6; ++i) {
    const cv::Mat image = photograph(i);
    std::vector<hc::people::Embedding> people;
    for (const auto& track : FaceSearch::read()->look(kStart, image)) {
      people.push_back(identifier.describe(image, track.face).value());
      // The same person a little turned, darker and smaller.
      cv::Mat other;
      const auto middle = middle_of(track.face);
      cv::warpAffine(image, other, cv::getRotationMatrix2D(middle, 10, 0.7), image.size());
      other *= 0.7;
      const auto found = face_around(near, other, middle, 1.6F * track.face.box.width);
      ASSERT_TRUE(found);
      EXPECT_LT(hc::people::distance(people.back(), identifier.describe(other, *found).value()),
                static_cast<float>(hc::people::kSamePerson))
          << i;
    }
    for (std::size_t a = 0; a < people.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        EXPECT_GT(hc::people::distance(people[a], people[b]), 0.5F) << i << ' ' << a << ' ' << b;
  }
}

}  // namespace
