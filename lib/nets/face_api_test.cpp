// SPDX-License-Identifier: Apache-2.0
#include <nets/face_api.h>

#include <gtest/gtest.h>

#include <span>
#include <string>

#include <opencv2/core.hpp>

#include <hc/base/format.h>
#include <nets/network.h>
#include <nets/weights.h>

namespace {

std::string content(const std::string& name) {
  return *hc::nets::read_weights(hc::nets::weights_path(name));
}

auto read(const std::string& manifest, const std::string& weights) {
  return hc::nets::read_face_recognition(manifest, std::as_bytes(std::span(weights)));
}

TEST(FaceApi, a_chip_gives_128_numbers) {
  auto network = hc::nets::Network::read(hc::nets::weights_path("face_recognition.json"));
  ASSERT_TRUE(network) << network.error().text();
  EXPECT_EQ((*network)->input(), (hc::nets::Shape{150, 150, 3}));
  const auto outputs = (*network)->run(cv::Mat::zeros(150, 150, CV_32FC3));
  ASSERT_EQ(outputs.size(), 1U);
  EXPECT_EQ(outputs[0].total(), 128U);
  EXPECT_LT(cv::norm(outputs[0]), 10);
}

TEST(FaceApi, files_that_do_not_fit_are_refused) {
  const auto manifest = content("face_recognition.json"), weights = content("face_recognition.bin");
  EXPECT_FALSE(read("", weights));
  EXPECT_FALSE(read("[]", weights));
  EXPECT_FALSE(read("[{\"weights\": [{\"name\": 3}]}]", weights));
  for (const char* shape : {"[0]", "[-1]", "[1.5]", "[1e300]", "[18446744073709551615]", "[\"1\"]",
                            "[65536, 65536, 65536, 65536]", "3"})
    EXPECT_FALSE(read(hc::format("[{{\"weights\": [{{\"name\": \"a\", \"dtype\": \"float32\", "
                                 "\"shape\": {}}}]}}]",
                                 shape),
                      weights))
        << shape;
  EXPECT_EQ(read("[{\"weights\": [{\"name\": \"a\", \"dtype\": \"int32\", \"shape\": [1]}]}]", "")
                .error()
                .text(),
            "Unsupported: a has numbers of type int32");
  const std::string one = R"({"name": "a", "dtype": "float32", "shape": [1]})";
  EXPECT_EQ(read("[{\"weights\": [" + one + ", " + one + "]}]", "8 bytes.").error().text(),
            "Malformed: it has a twice");
  EXPECT_FALSE(read(manifest, weights.substr(0, 1000)));
  EXPECT_FALSE(read(manifest, weights + "x"));
  EXPECT_EQ(read("[{\"weights\": []}]", "").error().text(),
            "Malformed: it has no conv32_down/conv/filters");
}

}  // namespace
