// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <hc/mtp/coords.h>
#include <hc/mtp/matrix_view.h>
#include <ros/cdr_test.h>
#include <ros/encode.h>
#include <ros/type_for.h>

namespace hc::ros {
namespace {

template <typename T>
Message message_of(MatrixType type, int components, std::int32_t width, std::int32_t height,
                   std::vector<T> numbers, std::int32_t coord = 0) {
  Draft draft =
      Draft::make({type, static_cast<std::uint8_t>(components), scalar_for<T>(), Encoding::Binary},
                  height, width);
  draft.header.coord = coord;
  draft.header.time = unix_time(1'763'683'200'123'456'789);
  std::ranges::copy(numbers, view<T>(draft).numbers().begin());
  return std::move(draft).finish();
}

/// Converts a message, and parses the result.
template <typename T>
T become(const Message& message, Type expected, Encoder encoder = {}) {
  EXPECT_EQ(type_for(message.header), expected);
  static std::vector<std::byte> bytes;  // viewed by the result
  bytes = bytes_of(must(encoder.encode(expected, message)));
  return *CdrReader::read<T>(bytes);
}

TEST(Encode, AnImageIsNotCopied) {
  const auto image = message_of<std::uint8_t>(MatrixType::RgbImage, 3, 2, 1, {1, 2, 3, 4, 5, 6},
                                              Coord::kLeftImage);
  Encoder encoder;
  EXPECT_EQ(encoder.encode(Type::Image, image)->body.data(), image.elements.data());
  const auto read = become<Image>(image, Type::Image);
  EXPECT_EQ(read.encoding, "rgb8");
  EXPECT_EQ(read.step, 6U);
  EXPECT_EQ(read.width, 2U);
  EXPECT_EQ(read.header.frame_id, "left_eye");
  EXPECT_EQ(read.header.stamp.sec, 1'763'683'200);
  EXPECT_EQ(read.header.stamp.nanosec, 123'456'789U);
}

TEST(Encode, ALineOfTheLogHasNameAndSeverity) {
  Encoder encoder;
  auto words = [&](Level level) {
    const auto bytes = bytes_of(encoder.encode_log({}, {"eyes", level, "it is dark"}));
    const auto log = *CdrReader::read<Log>(bytes);
    return std::to_string(log.level) + " " + std::string(log.name) + " " + std::string(log.msg);
  };
  EXPECT_EQ(words(Level::Info), "20 eyes it is dark");
  EXPECT_EQ(words(Level::Result), "20 eyes it is dark");
  EXPECT_EQ(words(Level::Warning), "30 eyes it is dark");
  EXPECT_EQ(words(Level::Error), "40 eyes it is dark");
}

TEST(Encode, PixelsHaveTheNamesOfRos) {
  auto encoding = [](const Message& message) {
    return become<Image>(message, Type::Image).encoding;
  };
  EXPECT_EQ(encoding(message_of<float>(MatrixType::IntensityImage, 1, 1, 1, {2}, Coord::kDepth)),
            "32FC1");
  EXPECT_EQ(encoding(message_of<std::uint16_t>(MatrixType::IntensityImage, 1, 1, 1, {2})),
            "mono16");
  EXPECT_EQ(
      encoding(message_of<std::uint16_t>(MatrixType::IntensityImage, 1, 1, 1, {2}, Coord::kDepth)),
      "16UC1");
  EXPECT_EQ(encoding(message_of<std::uint8_t>(MatrixType::RgbImage, 4, 1, 1, {1, 2, 3, 4})),
            "rgba8");
}

TEST(Encode, PosesArePositionsRotationsAndTransformations) {
  const auto position = become<PoseStamped>(
      message_of<float>(MatrixType::Position, 3, 1, 1, {1, 2, 3}, Coord::kHead), Type::PoseStamped);
  EXPECT_EQ(position.header.frame_id, "head");
  EXPECT_EQ(position.pose.position.y, 2);
  EXPECT_EQ(position.pose.orientation.w, 1);
  const auto rotation = become<PoseStamped>(
      message_of<double>(MatrixType::Rotation, 3, 1, 1, {0, 0, std::numbers::pi / 2}),
      Type::PoseStamped);
  EXPECT_NEAR(rotation.pose.orientation.z, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(rotation.pose.orientation.w, std::sqrt(0.5), 1e-12);
  const auto pose = become<PoseStamped>(
      message_of<double>(MatrixType::Transformation, 1, 4, 4,
                         {0, -1, 0, 7, 1, 0, 0, 8, 0, 0, 1, 9, 0, 0, 0, 1}, transform_coord(1, 3)),
      Type::PoseStamped);
  EXPECT_EQ(pose.header.frame_id, "world");
  EXPECT_EQ(pose.pose.position.z, 9);
  EXPECT_NEAR(pose.pose.orientation.z, std::sqrt(0.5), 1e-12);
}

TEST(Encode, ManyPositionsAreACloud) {
  const auto cloud = become<PointCloud2>(
      message_of<float>(MatrixType::Position, 6, 1, 2, std::vector<float>(12, 1)),
      Type::PointCloud2);
  ASSERT_EQ(cloud.fields.size(), 6U);
  EXPECT_EQ(cloud.fields[3].name, "vx");
  EXPECT_EQ(cloud.fields[3].offset, 12U);
  EXPECT_EQ(cloud.point_step, 24U);
  EXPECT_EQ(cloud.height, 2U);
}

TEST(Encode, TheGazeIsAJointState) {
  const auto joints = become<JointState>(
      message_of<double>(MatrixType::Rotation, 6, 1, 1, {0, 1, 2, 3, 4, 5}, Coord::kGaze),
      Type::JointState);
  EXPECT_EQ(joints.name, (std::vector<std::string>{"roll", "tilt", "pan"}));
  EXPECT_EQ(joints.position, (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(joints.velocity, (std::vector<double>{3, 4, 5}));
}

TEST(Encode, ATableIsAnArrayOfItsScalar) {
  const auto array = become<MultiArray<std::int16_t>>(
      message_of<std::int16_t>(MatrixType::Table, 2, 3, 1, {1, 2, 3, 4, 5, 6}),
      Type::Int16MultiArray);
  ASSERT_EQ(array.dim.size(), 3U);
  EXPECT_EQ(array.dim[1].label, "width");
  EXPECT_EQ(array.dim[1].size, 3U);
  EXPECT_EQ(array.dim[1].stride, 6U);
  EXPECT_EQ(array.data.bytes.size(), 12U);
}

TEST(Encode, IntrinsicsAreACamera) {
  Encoder encoder;
  encoder.camera_width = 800;
  const auto camera = become<CameraInfo>(
      message_of<double>(MatrixType::Table, 1, 5, 1, {600, 601, 399, 299, 0.1}, 9),
      Type::CameraInfo, encoder);
  EXPECT_EQ(camera.width, 800U);
  EXPECT_EQ(camera.k[4], 601);
  EXPECT_EQ(camera.p[2], 399);
}

TEST(Encode, R32_RowsOfTextAreLines) {
  std::vector<std::uint8_t> text;
  for (const char c : std::string_view("go at ")) text.push_back(static_cast<std::uint8_t>(c));
  EXPECT_EQ(become<String>(message_of(MatrixType::String, 1, 3, 2, text), Type::String).data.text,
            "go\nat");
  EXPECT_EQ(become<String>(message_of(MatrixType::String, 1, 6, 1, text), Type::String).data.text,
            "go at ");
}

TEST(Encode, SoundOfAnyScalarIsPcm) {
  auto samples = [](const Message& message) {
    const auto audio = become<RawAudio>(message, Type::RawAudio);
    EXPECT_EQ(audio.sample_rate, 22050U);
    std::vector<std::int16_t> all(audio.data.bytes.size() / 2);
    std::memcpy(all.data(), audio.data.bytes.data(), audio.data.bytes.size());
    return all;
  };
  using Samples = std::vector<std::int16_t>;
  EXPECT_EQ(samples(message_of<float>(MatrixType::Sound, 1, 3, 1, {-1, 0, 2}, 22)),
            (Samples{-32767, 0, 32767}));
  EXPECT_EQ(samples(message_of<std::uint8_t>(MatrixType::Sound, 1, 2, 1, {128, 255}, 22)),
            (Samples{0, 32512}));
  EXPECT_EQ(samples(message_of<std::int32_t>(MatrixType::Sound, 1, 1, 1, {-65536}, 22)),
            (Samples{-1}));
  EXPECT_EQ(samples(message_of<std::uint32_t>(MatrixType::Sound, 1, 1, 1, {0x80000000U}, 22)),
            (Samples{0}));
  EXPECT_EQ(samples(message_of<std::int16_t>(MatrixType::Sound, 1, 1, 1, {-5}, 22)), (Samples{-5}));
}

TEST(Encode, APortsTypeIsFixed) {
  PortType port{{MatrixType::Position, 3, Scalar::F64, Encoding::Text}, 0, 0, Coord::kHead, false};
  EXPECT_EQ(type_for(port), Type::PointCloud2);
  port.width = port.height = 1;
  EXPECT_EQ(type_for(port), Type::PoseStamped);
  port.info = {MatrixType::RgbImage, 3, Scalar::U8, Encoding::Jpeg};
  EXPECT_EQ(type_for(port), Type::CompressedImage);
  port.info.encoding = Encoding::Zstd;
  EXPECT_FALSE(type_for(port));
  port.info = {MatrixType::IntensityImage, 1, Scalar::U64, Encoding::Binary};
  EXPECT_EQ(type_for(port), Type::UInt64MultiArray);
}

TEST(Encode, WhatDoesNotFitIsRefused) {
  Encoder encoder;
  const auto table = message_of<double>(MatrixType::Table, 1, 2, 1, {1, 2});
  for (const auto& each : schemas()) {
    if (each.type == Type::Float64MultiArray || each.type == Type::Matrix) continue;
    EXPECT_EQ(refused(encoder.encode(each.type, table)).code, Code::Unsupported) << each.name;
  }
}

TEST(Encode, AMatrixSaysWhereItsElementsAre) {
  Encoder encoder;
  const auto table = message_of<double>(MatrixType::Table, 1, 2, 1, {1, 2});
  auto bytes = bytes_of(encoder.encode_matrix(table));
  auto whole = must(CdrReader::read<Matrix>(bytes));
  EXPECT_EQ(whole.header, text(table.header));
  EXPECT_EQ(whole.elements.bytes.size(), 16U);
  bytes = bytes_of(encoder.encode_matrix(table, 52));
  auto beside = must(CdrReader::read<Matrix>(bytes));
  EXPECT_EQ(beside.offset, 52U);
  EXPECT_EQ(beside.size, 16U);
  EXPECT_TRUE(beside.elements.bytes.empty());
}

}  // namespace
}  // namespace hc::ros
