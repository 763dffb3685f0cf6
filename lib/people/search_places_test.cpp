// SPDX-License-Identifier: Apache-2.0
#include <people/search_places.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <people/box.h>

namespace {

using hc::people::SearchPlaces;

const cv::Size kSize(800, 600);

bool is_around(const cv::Rect& place, const cv::Rect2f& face) {
  return std::abs(static_cast<float>(place.x + place.width / 2) - face.x - face.width / 2) < 2;
}

/// Searches, each after an image in which something flickers there, and counts the places around
/// each face.
std::vector<int> counts(const std::vector<cv::Rect2f>& faces, const cv::Rect& flickering,
                        int searches) {
  SearchPlaces places;
  std::vector<int> found(faces.size());
  for (int i = 0; i < searches; ++i) {
    cv::Mat image(kSize, CV_8UC1, cv::Scalar(90));
    image(flickering) = i % 2 == 0 ? 90 : 200;
    places.add(image);
    const cv::Rect place = places.next(kSize, faces);
    for (std::size_t face = 0; face < faces.size(); ++face)
      found[face] += is_around(place, faces[face]);
  }
  return found;
}

std::vector<cv::Rect2f> faces(int count) {
  std::vector<cv::Rect2f> made;
  for (int i = 0; i < count; ++i)
    made.emplace_back(static_cast<float>(100 + 600 * i / (count - 1)), 200, 40, 40);
  return made;
}

TEST(SearchPlaces, are_around_the_face_where_something_moves_most_often) {
  for (const int count : {2, 3, 5}) {
    const auto found = counts(faces(count), {90, 350, 60, 60}, 300);
    EXPECT_EQ(std::ranges::max_element(found), found.begin()) << count;
  }
}

TEST(SearchPlaces, are_around_each_face_now_and_then) {
  for (const int count : {2, 3, 5}) {
    const auto found = counts(faces(count), {90, 350, 60, 60}, 300);
    EXPECT_GT(*std::ranges::min_element(found), 300 / 3 / (2 * count)) << count;
  }
}

TEST(SearchPlaces, are_all_of_the_image_and_its_parts_without_faces) {
  SearchPlaces places;
  places.add(cv::Mat(kSize, CV_8UC1, cv::Scalar(90)));
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(places.next(kSize, {}), cv::Rect({}, kSize));
    for (const cv::Rect& part : hc::people::parts_of(kSize))
      EXPECT_EQ(places.next(kSize, {}), part);
  }
  EXPECT_NE(places.next(kSize, {cv::Rect2f(-1e8F, 0, 1e9F, 1e9F)}).area(), 0) << "no face";
}

}  // namespace
