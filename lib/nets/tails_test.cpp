// SPDX-License-Identifier: Apache-2.0
#include <nets/tails.h>

#include <gtest/gtest.h>

#include <utility>

namespace hc::nets {
namespace {

/// A convolution of tensor 0 to tensor 1, and what follows it. Tensor 9 is computed before it.
struct Followed {
  Layers layers;

  explicit Followed(std::vector<Layer> after, std::vector<int> outputs = {8}) {
    layers.tensors.resize(10);
    layers.layers = {{Kind::Convolution, {0, 5}, 1}};
    layers.layers.insert(layers.layers.end(), after.begin(), after.end());
    layers.outputs = std::move(outputs);
  }
  [[nodiscard]] Tail tail() const {
    return Tails(layers).after(layers.layers[0], [](int tensor) { return tensor == 9; });
  }
};

TEST(Tails, is_a_sum_and_then_an_activation) {
  const Tail tail =
      Followed({{Kind::Add, {9, 1}, 2}, {Kind::Prelu, {2, 6}, 3}, {Kind::Relu, {3}, 4}}).tail();
  EXPECT_EQ(tail.plus, 9);
  EXPECT_EQ(tail.activation, Kind::Prelu);
  EXPECT_EQ(tail.slopes, 6);
  EXPECT_EQ(tail.output, 3);
  EXPECT_EQ(tail.layers, (std::vector<std::size_t>{1, 2}));
}

TEST(Tails, has_the_activation_of_the_sum) {
  Followed followed({{Kind::Add, {1, 9}, 2}, {Kind::Relu, {2}, 3}});
  followed.layers.layers[1].activation = Kind::Relu6;
  const Tail tail = followed.tail();
  EXPECT_EQ(tail.activation, Kind::Relu6);
  EXPECT_EQ(tail.output, 2);
}

TEST(Tails, ends_at_an_activation) {
  Followed followed({{Kind::Add, {1, 9}, 2}});
  followed.layers.layers[0].activation = Kind::Relu;
  EXPECT_EQ(followed.tail().output, 1);
  EXPECT_EQ(Followed({{Kind::Relu, {1}, 2}, {Kind::Add, {2, 9}, 3}}).tail().output, 2);
}

TEST(Tails, ends_at_another_layer) {
  EXPECT_EQ(Followed({{Kind::MaxPool, {1}, 2}, {Kind::Relu, {2}, 3}}).tail().output, 1);
}

TEST(Tails, ends_where_a_result_is_used_twice) {
  EXPECT_EQ(Followed({{Kind::Relu, {1}, 2}, {Kind::Logistic, {1}, 3}}).tail().output, 1);
  EXPECT_EQ(Followed({{Kind::Add, {1, 1}, 2}}).tail().output, 1);
  EXPECT_EQ(Followed({{Kind::Relu, {1}, 2}}, {1}).tail().output, 1);  // an output
}

TEST(Tails, adds_only_what_is_computed_before_and_once) {
  EXPECT_EQ(Followed({{Kind::Add, {1, 7}, 2}}).tail().output, 1);
  EXPECT_EQ(Followed({{Kind::Add, {1, 9}, 2}, {Kind::Add, {2, 9}, 3}}).tail().output, 2);
}

}  // namespace
}  // namespace hc::nets
