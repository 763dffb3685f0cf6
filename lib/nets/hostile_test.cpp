// SPDX-License-Identifier: Apache-2.0
// Files and layers that were made to harm.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <span>
#include <string>

#include <opencv2/core.hpp>

#include <nets/network.h>
#include <nets/testing/tflite_writer.h>
#include <nets/tflite.h>

namespace {

using hc::Code;
using hc::nets::Kind;
using hc::nets::Layers;
using hc::nets::Network;
using hc::nets::testing::FlatWriter;
using hc::nets::testing::TinyOperator;
using hc::nets::testing::TinyTensor;

constexpr int kConvolution = 3, kReshape = 22;

/// A convolution of 1 × 1, from 3 channels to 2, and a reshape: tensors and operators to change.
struct Tiny {
  std::vector<TinyTensor> tensors = {
      {{1, 2, 2, 3}, 0, {}},
      {{2, 1, 1, 3}, 0, FlatWriter::text(std::vector<float>{1, 0, 0, 0, 1, 1})},
      {{1, 2, 2, 2}, 0, {}},
      {{1, 8}, 0, {}}};
  std::vector<TinyOperator> operators = {{kConvolution, {0, 1}, 2, {1, 1, 1}},
                                         {kReshape, {2}, 3, {}}};
  std::vector<int> outputs = {3};
  [[nodiscard]] std::string file() const {
    return hc::nets::testing::tflite(tensors, operators, outputs);
  }
};

auto layers_of(const std::string& bytes) {
  return hc::nets::read_tflite(std::as_bytes(std::span(bytes)));
}

/// Reads a file, and computes it if it can be read.
hc::Status run(const std::string& bytes) {
  const auto layers = HC_TRY(layers_of(bytes));
  const auto network = HC_TRY(Network::make(layers));
  const auto& input = network->input();
  const auto outputs = network->run(cv::Mat::zeros(input[0], input[1], CV_32FC(input[2])));
  EXPECT_EQ(outputs.size(), layers.outputs.size());
  return {};
}

TEST(Hostile, the_file_that_is_changed_here_is_right) {
  const auto layers = layers_of(Tiny().file());
  ASSERT_TRUE(layers) << layers.error().text();
  const auto network = Network::make(*layers);
  ASSERT_TRUE(network) << network.error().text();
  const cv::Mat image(2, 2, CV_32FC3, cv::Scalar(1, 2, 3));
  const cv::Mat known = (cv::Mat_<float>(1, 8) << 1, 5, 1, 5, 1, 5, 1, 5);
  EXPECT_EQ(cv::norm((*network)->run(image)[0], known), 0);
  EXPECT_TRUE(run(Tiny().file()));
}

TEST(Hostile, a_file_that_is_cut_anywhere_is_refused) {
  const std::string file = Tiny().file();
  for (std::size_t size = 0; size < file.size(); ++size) {
    const auto refused = layers_of(file.substr(0, size));
    ASSERT_FALSE(refused) << size;
    EXPECT_FALSE(refused.error().detail.empty()) << size;
  }
}

TEST(Hostile, any_offset_size_or_number_is_refused_or_computed) {
  const std::string file = Tiny().file();
  constexpr auto kMost = std::numeric_limits<int>::max(), kLeast = std::numeric_limits<int>::min();
  for (std::size_t place = 0; place + sizeof(int) <= file.size(); place += 2)
    for (const int number :
         {0, 1, 2, 4, 7, 100, 65535, 65536, 1 << 24, kMost, kLeast, -1, -2, -60}) {
      std::string bytes = file;
      std::memcpy(bytes.data() + place, &number, sizeof number);
      if (const auto result = run(bytes); !result) {
        EXPECT_FALSE(result.error().detail.empty()) << place << ' ' << number;
      }
    }
}

TEST(Hostile, extents_whose_product_overflows_are_too_large) {
  for (const int extent : {1 << 16, 1 << 30, std::numeric_limits<int>::max()}) {
    Tiny tiny;
    tiny.tensors[0].shape = {1, extent, extent, extent};
    EXPECT_EQ(run(tiny.file()).error().code, Code::TooLarge) << extent;
  }
}

TEST(Hostile, numbers_of_many_tensors_are_counted_together) {
  Tiny tiny;
  for (int i = 0; i < 40; ++i) tiny.tensors.push_back({{1, 1024, 1024, 2}, 0, {}});
  EXPECT_EQ(run(tiny.file()).error().code, Code::TooLarge);
}

TEST(Hostile, vectors_that_are_too_long_are_refused) {
  Tiny tiny;
  tiny.operators[0].inputs.resize(1000);
  EXPECT_EQ(run(tiny.file()).error().text(), "Unsupported: an operator 3 of more than 32 inputs");
  tiny = {};
  tiny.outputs.resize(1000);
  EXPECT_EQ(run(tiny.file()).error().text(), "Unsupported: more than 32 outputs");
  tiny = {};
  tiny.tensors[3].shape = {1, 1, 2, 2, 2};
  EXPECT_EQ(run(tiny.file()).error().code, Code::Unsupported);
}

TEST(Hostile, layers_that_share_their_weights_have_a_limit) {
  constexpr int kSide = 2048;
  Layers layers;
  const auto add = [&](hc::nets::Tensor tensor) {
    layers.tensors.push_back(std::move(tensor));
    return static_cast<int>(layers.tensors.size()) - 1;
  };
  layers.input = add({"image", {1, 1, 1, kSide}, {}, {}});
  const int weights = add({"weights", {kSide, kSide}, std::vector<float>(kSide * kSide), {}});
  int last = add({"row", {1, kSide}, {}, {}});
  layers.layers.push_back({Kind::Reshape, {layers.input}, last});
  for (int i = 0; i < 17; ++i) {
    const int next = add({"row", {1, kSide}, {}, {}});
    layers.layers.push_back({Kind::FullyConnected, {last, weights}, next});
    last = next;
  }
  layers.outputs = {last};
  EXPECT_EQ(Network::make(layers).error().text(),
            "TooLarge: layers with more than 67108864 weights");
}

TEST(Hostile, an_image_that_opencv_computes_smaller_is_refused) {
  // OpenCV computes the size of a pool by floats, which have 24 bits.
  constexpr int kHigh = (1 << 24) + 6, kPooled = (kHigh - 1) / 3 + 1;
  for (const Kind kind : {Kind::Convolution, Kind::DepthwiseConvolution}) {
    Layers layers;
    layers.tensors = {{"image", {1, kHigh, 1, 1}, {}, {}},   {"pool", {1, kPooled, 1, 1}, {}, {}},
                      {"other", {1, kPooled, 1, 1}, {}, {}}, {"sum", {1, kPooled, 1, 1}, {}, {}},
                      {"last", {1, kPooled, 1, 1}, {}, {}},  {"mean", {1, 1}, {}, {}},
                      {"weight", {1, 1, 1, 1}, {1}, {}},     {"axes", {2}, {}, {1, 2}}};
    hc::nets::Layer pool{Kind::MaxPool, {0}, 1}, stride{Kind::Convolution, {0, 6}, 2};
    pool.stride_down = stride.stride_down = 3;
    layers.layers = {pool, stride, {Kind::Convolution, {2, 6}, 3}, {Kind::Add, {3, 1}, 4}};
    if (kind == Kind::DepthwiseConvolution) layers.layers = {pool, {kind, {1, 6}, 4}};
    layers.layers.push_back({Kind::Mean, {4, 7}, 5});
    layers.outputs = {5};
    const auto refused = Network::make(layers);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Code::Unsupported) << refused.error().text();
  }
}

TEST(Hostile, a_pool_that_would_take_minutes_is_refused) {
  Layers layers;
  layers.tensors = {{"image", {1, 4096, 4096, 1}, {}, {}}, {"pool", {1, 4096, 4096, 1}, {}, {}}};
  hc::nets::Layer pool{Kind::MaxPool, {0}, 1};
  pool.is_padded = true;
  pool.window_height = pool.window_width = 64;
  layers.layers = {pool};
  layers.outputs = {1};
  EXPECT_EQ(Network::make(layers).error().code, Code::TooLarge);
}

}  // namespace
