// SPDX-License-Identifier: Apache-2.0
#include <people/gallery.h>

#include <gtest/gtest.h>

namespace {

using hc::people::Embedding;
using hc::people::Gallery;

Embedding embedding(float first, float second = 0) {
  Embedding made = {};
  made[0] = first;
  made[127] = second;
  return made;
}

TEST(Distance, is_euclidean) {
  EXPECT_FLOAT_EQ(hc::people::distance(embedding(3), embedding(0, 4)), 5);
}

TEST(Mean, is_between_all) {
  const auto mean = hc::people::mean({embedding(0, 1), embedding(1, 1), embedding(2, 1)});
  EXPECT_FLOAT_EQ(mean[0], 1);
  EXPECT_FLOAT_EQ(mean[127], 1);
}

TEST(Gallery, finds_the_nearest_of_those_who_are_near_enough) {
  Gallery gallery;
  const int anna = gallery.add("Anna", embedding(0)), ben = gallery.add("Ben", embedding(1));
  EXPECT_EQ(gallery.find(embedding(0.4F), 0.5F)->number, anna);
  EXPECT_EQ(gallery.find(embedding(0.6F), 0.5F)->number, ben);
  EXPECT_FLOAT_EQ(gallery.find(embedding(0.6F), 0.5F)->distance, 0.4F);
  EXPECT_FALSE(gallery.find(embedding(2), 0.5F));
  EXPECT_FALSE(Gallery().find(embedding(0), 2));
}

TEST(Gallery, numbers_are_never_another_persons) {
  Gallery gallery;
  const int anna = gallery.add("Anna", embedding(0));
  gallery.forget("Anna");
  EXPECT_FALSE(gallery.find(embedding(0), 0.5F));
  const int ben = gallery.add("Ben", embedding(0));
  EXPECT_NE(anna, ben);
  EXPECT_EQ(gallery.add("Anna", embedding(1)), anna);
  EXPECT_EQ(gallery.names(), (std::map<std::string, int>{{"Anna", anna}, {"Ben", ben}}));
}

}  // namespace
