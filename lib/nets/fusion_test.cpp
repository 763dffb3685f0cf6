// SPDX-License-Identifier: Apache-2.0
#include <nets/fusion.h>

#include <gtest/gtest.h>

#include <utility>

namespace hc::nets {
namespace {

/// What is fused into a convolution of tensor 0 to tensor 1. Tensor 9 is computed before it.
struct Followed {
  Layers layers;

  explicit Followed(std::vector<Layer> after, std::vector<int> outputs = {8}) {
    layers.tensors.resize(10);
    layers.layers = {{Kind::Logistic, {0}, 9}, {Kind::Convolution, {0, 5}, 1}};
    layers.layers.insert(layers.layers.end(), after.begin(), after.end());
    layers.outputs = std::move(outputs);
  }
  [[nodiscard]] Fused fused() const { return Fusion(layers).of(1); }
};

TEST(Fusion, takes_a_sum_and_then_an_activation) {
  const Fused fused =
      Followed({{Kind::Add, {9, 1}, 2}, {Kind::Prelu, {2, 6}, 3}, {Kind::Relu, {3}, 4}}).fused();
  EXPECT_EQ(fused.addend, 9);
  EXPECT_EQ(fused.activation, Kind::Prelu);
  EXPECT_EQ(fused.slopes, 6);
  EXPECT_EQ(fused.output, 3);
  EXPECT_EQ(fused.layers, (std::vector<std::size_t>{2, 3}));
}

TEST(Fusion, takes_the_activation_of_the_sum) {
  Followed followed({{Kind::Add, {1, 0}, 2}, {Kind::Relu, {2}, 3}});
  followed.layers.layers[2].activation = Kind::Relu6;
  EXPECT_EQ(followed.fused().addend, 0) << "the image";
  EXPECT_EQ(followed.fused().activation, Kind::Relu6);
  EXPECT_EQ(followed.fused().output, 2);
}

TEST(Fusion, ends_at_an_activation) {
  Followed followed({{Kind::Add, {1, 9}, 2}});
  followed.layers.layers[1].activation = Kind::Relu;
  EXPECT_EQ(followed.fused().output, 1);
  EXPECT_EQ(Followed({{Kind::Relu, {1}, 2}, {Kind::Add, {2, 9}, 3}}).fused().output, 2);
}

TEST(Fusion, ends_at_another_layer) {
  EXPECT_EQ(Followed({{Kind::MaxPool, {1}, 2}, {Kind::Relu, {2}, 3}}).fused().output, 1);
}

TEST(Fusion, ends_where_a_result_is_used_twice) {
  EXPECT_EQ(Followed({{Kind::Relu, {1}, 2}, {Kind::Logistic, {1}, 3}}).fused().output, 1);
  EXPECT_EQ(Followed({{Kind::Add, {1, 1}, 2}}).fused().output, 1);
  EXPECT_EQ(Followed({{Kind::Relu, {1}, 2}}, {1}).fused().output, 1) << "an output";
}

TEST(Fusion, adds_only_what_is_computed_before_and_once) {
  EXPECT_EQ(Followed({{Kind::Logistic, {0}, 7}, {Kind::Add, {1, 7}, 2}}).fused().output, 1);
  EXPECT_EQ(Followed({{Kind::Add, {1, 9}, 2}, {Kind::Add, {2, 9}, 3}}).fused().output, 2);
}

}  // namespace
}  // namespace hc::nets
