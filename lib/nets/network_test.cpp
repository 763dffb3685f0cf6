// SPDX-License-Identifier: Apache-2.0
#include <nets/network.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/core.hpp>

#include <nets/weights.h>

namespace {

using hc::nets::Kind;
using hc::nets::Layer;
using hc::nets::Layers;
using hc::nets::Network;
using hc::nets::Shape;
using hc::nets::Tensor;

/// Numbers without a pattern, -1 … 1.
std::vector<float> some(long long count, float phase) {
  std::vector<float> numbers;
  for (long long i = 0; i < count; ++i)
    numbers.push_back(std::sin(phase + 7.3F * static_cast<float>(i)));
  return numbers;
}

/// A network of one layer after a convolution of 1 × 1 that leaves its image as it is, and before a
/// reshape, since outputs are no images.
class OneLayer : public ::testing::Test {
 protected:
  int add(Tensor tensor) {
    layers.tensors.push_back(std::move(tensor));
    return static_cast<int>(layers.tensors.size()) - 1;
  }
  int constant(const Shape& shape, float phase) {
    return add({"constant", shape, some(hc::nets::size_of(shape), phase), {}});
  }
  int computed(const Shape& shape) { return add({"computed", shape, {}, {}}); }

  /// The result for an image, as one row.
  hc::Result<std::vector<float>> run(const Shape& input, Layer layer, const Shape& made) {
    layers.input = computed(input);
    layer.inputs.insert(layer.inputs.begin(), layers.input);
    layer.output = computed(made);
    layers.layers.push_back(layer);
    const int size = static_cast<int>(hc::nets::size_of(made));
    int last = layer.output;
    if (made.size() == 4) {
      last = computed({1, size});
      layers.layers.push_back({Kind::Reshape, {layer.output}, last});
    }
    layers.outputs = {last};
    auto network = HC_TRY(Network::make(layers));
    image = some(hc::nets::size_of(input), 0);
    const auto outputs = network->run(cv::Mat(input[1], input[2], CV_32FC(input[3]), image.data()));
    return std::vector<float>(outputs[0].begin<float>(), outputs[0].end<float>());
  }
  [[nodiscard]] float at(const Shape& shape, int y, int x, int c) const {
    if (y < 0 || x < 0 || y >= shape[1] || x >= shape[2]) return 0;
    return image[static_cast<std::size_t>((y * shape[2] + x) * shape[3] + c)];
  }
  const std::vector<float>& numbers(int tensor) {
    return layers.tensors[static_cast<std::size_t>(tensor)].numbers;
  }

  Layers layers;
  std::vector<float> image;
};

/// A side of the image, of the window, its stride, and whether zeros surround the image.
struct WindowCase {
  int side, window, stride;
  bool is_padded;
  [[nodiscard]] int steps() const {
    return is_padded ? (side + stride - 1) / stride : (side - window) / stride + 1;
  }
  /// Where the first window begins. Source: TensorFlow, SAME.
  [[nodiscard]] int begin() const {
    return is_padded ? -(std::max(0, (steps() - 1) * stride + window - side) / 2) : 0;
  }
};
class Windows : public OneLayer, public ::testing::WithParamInterface<WindowCase> {
 protected:
  [[nodiscard]] Layer layer(Kind kind) const {
    const auto& one = GetParam();
    Layer made{kind, {}};
    made.is_padded = one.is_padded;
    made.window_height = made.window_width = one.window;
    made.stride_down = made.stride_right = one.stride;
    return made;
  }
};

TEST_P(Windows, a_convolution_is_a_sum_of_products) {
  const auto& one = GetParam();
  const Shape input{1, one.side, one.side, 3}, made{1, one.steps(), one.steps(), 4};
  const int weights = constant({4, one.window, one.window, 3}, 1), bias = constant({4}, 2);
  Layer convolution = layer(Kind::Convolution);
  convolution.inputs = {weights, bias};
  const auto result = run(input, convolution, made);
  ASSERT_TRUE(result) << result.error().text();
  for (int y = 0, i = 0; y < made[1]; ++y)
    for (int x = 0; x < made[2]; ++x)
      for (int out = 0; out < made[3]; ++out, ++i) {
        float sum = numbers(bias)[static_cast<std::size_t>(out)];
        for (int v = 0, w = out * one.window * one.window * 3; v < one.window; ++v)
          for (int u = 0; u < one.window; ++u)
            for (int c = 0; c < 3; ++c, ++w)
              sum +=
                  numbers(weights)[static_cast<std::size_t>(w)] *
                  at(input, one.begin() + y * one.stride + v, one.begin() + x * one.stride + u, c);
        ASSERT_NEAR((*result)[static_cast<std::size_t>(i)], sum, 1e-4)
            << y << ' ' << x << ' ' << out;
      }
}

TEST_P(Windows, a_depthwise_convolution_is_one_of_each_channel) {
  const auto& one = GetParam();
  const Shape input{1, one.side, one.side, 3}, made{1, one.steps(), one.steps(), 3};
  const int weights = constant({1, one.window, one.window, 3}, 1);
  Layer convolution = layer(Kind::DepthwiseConvolution);
  convolution.inputs = {weights};
  const auto result = run(input, convolution, made);
  ASSERT_TRUE(result) << result.error().text();
  for (int y = 0, i = 0; y < made[1]; ++y)
    for (int x = 0; x < made[2]; ++x)
      for (int c = 0; c < 3; ++c, ++i) {
        float sum = 0;
        for (int v = 0; v < one.window; ++v)
          for (int u = 0; u < one.window; ++u)
            sum += numbers(weights)[static_cast<std::size_t>((v * one.window + u) * 3 + c)] *
                   at(input, one.begin() + y * one.stride + v, one.begin() + x * one.stride + u, c);
        ASSERT_NEAR((*result)[static_cast<std::size_t>(i)], sum, 1e-4) << y << ' ' << x << ' ' << c;
      }
}

INSTANTIATE_TEST_SUITE_P(Network, Windows,
                         ::testing::Values(WindowCase{7, 3, 1, true}, WindowCase{8, 3, 2, true},
                                           WindowCase{9, 3, 2, true}, WindowCase{8, 5, 2, true},
                                           WindowCase{8, 1, 1, true}, WindowCase{8, 2, 2, false},
                                           WindowCase{9, 3, 2, false}, WindowCase{7, 7, 1, false}));

TEST_F(OneLayer, a_depthwise_convolution_adds_its_bias_and_is_activated) {
  for (const auto activation : {std::optional<Kind>(), {Kind::Relu}, {Kind::Relu6}}) {
    layers = {};
    const Shape input{1, 4, 5, 2};
    const int weights = constant({1, 1, 1, 2}, 1), bias = add({"bias", {2}, {-0.5F, 5.8F}, {}});
    Layer convolution{Kind::DepthwiseConvolution, {weights, bias}};
    convolution.activation = activation;
    const auto result = run(input, convolution, input);
    ASSERT_TRUE(result) << result.error().text();
    for (std::size_t i = 0; i < image.size(); ++i) {
      float expected = image[i] * numbers(weights)[i % 2] + numbers(bias)[i % 2];
      if (activation) expected = std::max(expected, 0.F);
      if (activation == Kind::Relu6) expected = std::min(expected, 6.F);
      EXPECT_NEAR((*result)[i], expected, 1e-6) << i;
    }
  }
}

/// A pointwise convolution is followed by a sum, an activation, or both, which are fused.
class Fused : public OneLayer, public ::testing::WithParamInterface<std::optional<Kind>> {
 protected:
  static constexpr int kChannels = 5;
  const Shape shape{1, 9, 13, kChannels};

  void SetUp() override {
    weights = constant({kChannels, 1, 1, kChannels}, 1);
    slopes = constant({1, 1, kChannels}, 2);
    layers.input = computed(shape);
  }
  int follow(Kind kind, std::vector<int> inputs) {
    const int made = computed(shape);
    layers.layers.push_back({kind, std::move(inputs), made});
    return made;
  }
  /// The result of a convolution, plus the image if it is added.
  [[nodiscard]] float expected(std::size_t pixel, std::size_t channel, bool is_added) {
    float sum = is_added ? image[pixel * kChannels + channel] : 0;
    for (std::size_t k = 0; k < kChannels; ++k)
      sum += numbers(weights)[channel * kChannels + k] * image[pixel * kChannels + k];
    if (!GetParam()) return sum;
    if (sum < 0) return GetParam() == Kind::Prelu ? sum * numbers(slopes)[channel] : 0;
    return GetParam() == Kind::Relu6 ? std::min(sum, 6.F) : sum;
  }

  int weights = 0, slopes = 0;
};

TEST_P(Fused, are_a_sum_and_an_activation) {
  for (const bool is_first : {false, true})
    for (const bool is_added : {false, true}) {
      layers = {};
      SetUp();
      int last = follow(Kind::Convolution, {layers.input, weights});
      if (is_added && is_first) last = follow(Kind::Add, {layers.input, last});
      if (is_added && !is_first) last = follow(Kind::Add, {last, layers.input});
      if (GetParam() == Kind::Prelu)
        last = follow(Kind::Prelu, {last, slopes});
      else if (GetParam())
        last = follow(*GetParam(), {last});
      const int size = static_cast<int>(hc::nets::size_of(shape));
      layers.outputs = {computed({1, size})};
      layers.layers.push_back({Kind::Reshape, {last}, layers.outputs[0]});
      const auto network = Network::make(layers);
      ASSERT_TRUE(network) << network.error().text();
      image = some(size, 0);
      for (float& number : image) number *= 5;  // sums beyond 6
      const auto result =
          (*network)->run(cv::Mat(shape[1], shape[2], CV_32FC(kChannels), image.data()))[0];
      for (int i = 0; i < size; ++i)
        ASSERT_NEAR(result.at<float>(i),
                    expected(static_cast<std::size_t>(i / kChannels),
                             static_cast<std::size_t>(i % kChannels), is_added),
                    1e-4)
            << i << (is_added ? " added" : "");
    }
}
INSTANTIATE_TEST_SUITE_P(All, Fused,
                         ::testing::Values(std::nullopt, Kind::Relu, Kind::Relu6, Kind::Prelu));

TEST_F(OneLayer, one_with_another_activation_or_two_is_refused) {
  const Shape shape{1, 4, 5, 2};
  for (const auto& [kind, activation] : {std::pair(Kind::Convolution, Kind::Logistic),
                                         {Kind::Convolution, Kind::Prelu},
                                         {Kind::Relu, Kind::Relu6}}) {
    layers = {};
    const int weights = constant({2, 1, 1, 2}, 1);
    Layer layer{kind, {}};
    if (kind == Kind::Convolution) layer.inputs = {weights};
    layer.activation = activation;
    const auto refused = run(shape, layer, shape);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, hc::Code::Malformed);
  }
}

TEST_F(OneLayer, one_whose_padding_is_too_large_is_refused) {
  const int weights = constant({1, 1, 64, 1}, 1);
  Layer convolution{Kind::DepthwiseConvolution, {weights}};
  convolution.is_padded = true;
  constexpr int kHigh = 1 << 21;
  const auto refused = run({1, kHigh, 1, 1}, convolution, {1, kHigh, 1, 1});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().text(), "TooLarge: more than 67108864 numbers with the padding");
}

TEST_F(OneLayer, one_that_takes_too_long_is_refused) {
  // A window as wide as the image, which all the same is computed at each of its columns.
  const int weights = constant({1, 64, 64, 1}, 1);
  constexpr int kHigh = 1 << 19;
  const auto refused =
      run({1, kHigh, 64, 1}, {Kind::DepthwiseConvolution, {weights}}, {1, kHigh - 63, 1, 1});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().text(), "TooLarge: more than 20000000000 multiplications");
}

TEST_F(OneLayer, a_pool_takes_the_largest) {
  Layer pool{Kind::MaxPool, {}};
  pool.window_height = pool.window_width = pool.stride_down = pool.stride_right = 2;
  const Shape input{1, 4, 6, 2};
  const auto result = run(input, pool, {1, 2, 3, 2});
  ASSERT_TRUE(result) << result.error().text();
  EXPECT_FLOAT_EQ((*result)[3], std::max({at(input, 0, 2, 1), at(input, 0, 3, 1),
                                          at(input, 1, 2, 1), at(input, 1, 3, 1)}));
}

TEST_F(OneLayer, a_padding_adds_zeros_after_channels_too) {
  Layer pad{Kind::Pad, {add({"by", {4, 2}, {}, {0, 0, 1, 0, 0, 2, 0, 3}})}};
  const Shape input{1, 2, 2, 2}, made{1, 3, 4, 5};
  const auto result = run(input, pad, made);
  ASSERT_TRUE(result) << result.error().text();
  for (int y = 0, i = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x)
      for (int c = 0; c < 5; ++c, ++i)
        EXPECT_EQ((*result)[static_cast<std::size_t>(i)], c < 2 ? at(input, y - 1, x, c) : 0);
}

TEST_F(OneLayer, a_resize_interpolates_between_pixels_centres) {
  Layer resize{Kind::ResizeBilinear, {add({"size", {2}, {}, {4, 4}})}};
  resize.half_pixel_centers = true;
  const Shape input{1, 2, 2, 1};
  const auto result = run(input, resize, {1, 4, 4, 1});
  ASSERT_TRUE(result) << result.error().text();
  EXPECT_NEAR((*result)[0], at(input, 0, 0, 0), 1e-6);
  EXPECT_NEAR((*result)[1], 0.75F * at(input, 0, 0, 0) + 0.25F * at(input, 0, 1, 0), 1e-6);
}

TEST_F(OneLayer, a_mean_is_of_each_channel) {
  Layer mean{Kind::Mean, {add({"axes", {2}, {}, {1, 2}})}};
  const Shape input{1, 2, 3, 2};
  const auto result = run(input, mean, {1, 2});
  ASSERT_TRUE(result) << result.error().text();
  float sum = 0;
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x) sum += at(input, y, x, 1);
  EXPECT_NEAR((*result)[1], sum / 6, 1e-6);
}

TEST_F(OneLayer, a_prelu_has_a_slope_for_each_channel) {
  const int slopes = constant({1, 1, 2}, 1);
  const Shape input{1, 2, 2, 2};
  const auto result = run(input, {Kind::Prelu, {slopes}}, input);
  ASSERT_TRUE(result) << result.error().text();
  for (std::size_t i = 0; i < image.size(); ++i)
    EXPECT_FLOAT_EQ((*result)[i], image[i] > 0 ? image[i] : image[i] * numbers(slopes)[i % 2]);
}

TEST_F(OneLayer, a_shape_that_does_not_follow_is_named) {
  const int weights = constant({4, 3, 3, 3}, 1);
  const auto refused = run({1, 8, 8, 3}, {Kind::Convolution, {weights}}, {1, 8, 8, 4});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().text(),
            "Malformed: convolution computed: its shape is 1×6×6×4, not 1×8×8×4");
}

TEST_F(OneLayer, one_that_would_take_minutes_is_refused) {
  const int weights = constant({512, 9, 9, 512}, 1);
  Layer convolution{Kind::Convolution, {weights}};
  convolution.is_padded = true;
  const auto refused = run({1, 64, 64, 512}, convolution, {1, 64, 64, 512});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, hc::Code::TooLarge);
}

/// What TensorFlow Lite's own interpreter computes, as WebAssembly in Chromium (npm's package
/// @tensorflow/tfjs-tflite 0.0.1-alpha.10), for an image whose number i is sin(0.01 i).
struct Computed {
  const char* file;
  std::vector<std::array<double, 2>> outputs;  // their first number, and the sum of all
};
class Known : public ::testing::TestWithParam<Computed> {};

TEST_P(Known, networks_compute_what_the_interpreter_does) {
  const auto& known = GetParam();
  auto network = Network::read(hc::nets::weights_path(known.file));
  ASSERT_TRUE(network) << network.error().text();
  const Shape& input = (*network)->input();
  cv::Mat image(input[0], input[1], CV_32FC(input[2]));
  for (std::size_t i = 0; i < image.total() * 3; ++i)
    image.ptr<float>()[i] = static_cast<float>(std::sin(0.01 * static_cast<double>(i)));
  const auto outputs = (*network)->run(image);
  ASSERT_EQ(outputs.size(), known.outputs.size());
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    double least = 0, most = 0;
    cv::minMaxLoc(outputs[i], &least, &most);
    const double range = std::max(most - least, most);
    EXPECT_NEAR(outputs[i].at<float>(0), known.outputs[i][0], 1e-4 * range);
    EXPECT_NEAR(cv::sum(outputs[i])[0], known.outputs[i][1],
                1e-6 + 1e-5 * range * static_cast<double>(outputs[i].total()));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Network, Known,
    ::testing::Values(Computed{"face_detection_short_range.tflite",
                               {{0.429193, 87577.0070}, {-5.553931, -3868.8063}}},
                      Computed{"face_detection_full_range.tflite",
                               {{-3.856728, 36591.4268}, {-6.805768, -14222.6583}}},
                      Computed{"palm_detection_lite.tflite",
                               {{-3.298960, 2633010.9103}, {-18.747286, -185802.3696}}},
                      Computed{"hand_landmark_lite.tflite",
                               {{106.803154, 4171.3767},
                                {0.001676, 0.001676},
                                {0.899602, 0.899602},
                                {4.1e-6, 0.0097}}}));

TEST(Network, a_file_that_is_no_network_is_named) {
  const auto path = hc::nets::weights_path("NOTICE");
  const auto refused = Network::read(path);
  ASSERT_FALSE(refused);
  EXPECT_EQ(
      refused.error().text(),
      "Malformed: " + path + ": not a file of TensorFlow Lite: it does not have TFL3 at byte 4");
}

}  // namespace
