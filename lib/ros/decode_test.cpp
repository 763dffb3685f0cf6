// SPDX-License-Identifier: Apache-2.0
#include <ros/decode.h>

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <hc/compress/compress.h>
#include <hc/module/kind.h>

#include <hc/testing/must.h>
#include <ros/cdr_test.h>
#include <ros/encode.h>
#include <ros/messages.h>

namespace hc::ros {
namespace {

const PortType kRgb = rgb_image().type, kGrey = intensity_image().type,
               kDepth = intensity_image<float>().type, kPoints = position<float>().type,
               kPose = transformation().type, kTable = table().type, kText = string().type;
const Stamp kStamp{{5, 7}, "eye"};
constexpr hc::Time kTime = unix_time(5'000'000'007);

template <typename T>
std::vector<T> numbers(const Result<Message>& message) {
  const auto kept = must(message);
  const auto all = view<T>(kept)->numbers();
  return {all.begin(), all.end()};
}

TEST(Decode, images_in_each_order_of_colours_and_with_padded_rows) {
  const auto pixels = octets({1, 2, 3, 4, 5, 6, 0, 7, 8, 9, 10, 11, 12, 0});
  const auto rgb = decode(Type::Image, cdr(Image{kStamp, 2, 2, "rgb8", 0, 7, {pixels}}), kRgb);
  EXPECT_EQ(numbers<std::uint8_t>(rgb),
            (std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
  EXPECT_EQ(rgb->header.width, 2);
  EXPECT_EQ(rgb->header.time, kTime);
  const auto bgr = decode(Type::Image, cdr(Image{kStamp, 1, 1, "bgr8", 0, 3, {pixels}}), kRgb);
  EXPECT_EQ(numbers<std::uint8_t>(bgr), (std::vector<std::uint8_t>{3, 2, 1}));
  const auto bgra = decode(Type::Image, cdr(Image{kStamp, 1, 1, "bgra8", 0, 4, {pixels}}), kRgb);
  EXPECT_EQ(numbers<std::uint8_t>(bgra), (std::vector<std::uint8_t>{3, 2, 1}));
  const auto mono = decode(Type::Image, cdr(Image{kStamp, 1, 2, "mono8", 0, 2, {pixels}}), kRgb);
  EXPECT_EQ(numbers<std::uint8_t>(mono), (std::vector<std::uint8_t>{1, 1, 1, 2, 2, 2}));
  const auto white = octets({255, 255, 255, 255, 0, 0});
  const auto grey = decode(Type::Image, cdr(Image{kStamp, 1, 2, "rgb8", 0, 6, {white}}), kGrey);
  EXPECT_EQ(numbers<std::uint8_t>(grey), (std::vector<std::uint8_t>{255, 76}));
}

TEST(Decode, depth_is_in_metres) {
  const std::array<float, 3> metres = {1.5F, NAN, 3};
  const auto bytes = std::as_bytes(std::span(metres));
  EXPECT_EQ(numbers<float>(
                decode(Type::Image, cdr(Image{kStamp, 1, 3, "32FC1", 0, 12, {bytes}}), kDepth)),
            (std::vector<float>{1.5F, 0, 3}));
  const auto millimetres = octets({0xDC, 0x05});
  EXPECT_EQ(numbers<float>(decode(Type::Image,
                                  cdr(Image{kStamp, 1, 1, "16UC1", 0, 2, {millimetres}}), kDepth)),
            (std::vector<float>{1.5F}));
}

TEST(Decode, a_compressed_image_stays_so) {
  const std::vector<std::uint8_t> pixels(16 * 8 * 3, 200);
  const auto jpeg = must(compress(rgb_image().message(8, 16, pixels), Encoding::Jpeg));
  const auto image =
      decode(Type::CompressedImage, cdr(CompressedImage{kStamp, "jpeg", {jpeg.elements}}), kRgb);
  ASSERT_TRUE(image) << image.error().detail;
  EXPECT_EQ(image->header.width, 16);
  EXPECT_EQ(image->header.height, 8);
  EXPECT_EQ(image->header.info.encoding, Encoding::Jpeg);
  EXPECT_TRUE(expand(*image));
  const auto png = octets({0x89, 'P', 'N', 'G', 0, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(
      decode(Type::CompressedImage, cdr(CompressedImage{kStamp, "png", {png}}), kRgb).error().code,
      Code::Unsupported);
}

TEST(Decode, points_whatever_else_they_have) {
  PointCloud2 cloud;
  cloud.header = kStamp;
  cloud.height = 1;
  cloud.width = 2;
  cloud.fields = {{"z", 0, PointField::kFloat64, 1},
                  {"x", 8, PointField::kFloat32, 1},
                  {"y", 12, PointField::kFloat32, 1},
                  {"rgb", 16, 6, 1}};
  cloud.point_step = 20;
  cloud.row_step = 40;
  std::vector<std::byte> data(40);
  for (std::size_t i = 0; i < 2; ++i) {
    const double z = 3 + 10. * static_cast<double>(i);
    const float x = 1 + 10.F * static_cast<float>(i), y = 2;
    std::memcpy(&data[i * 20], &z, 8);
    std::memcpy(&data[i * 20 + 8], &x, 4);
    std::memcpy(&data[i * 20 + 12], &y, 4);
  }
  cloud.data.bytes = data;
  EXPECT_EQ(numbers<float>(decode(Type::PointCloud2, cdr(cloud), kPoints)),
            (std::vector<float>{1, 2, 3, 11, 2, 13}));
  cloud.fields[0].offset = 13;  // exceeds the point
  EXPECT_EQ(decode(Type::PointCloud2, cdr(cloud), kPoints).error().code, Code::Malformed);
  cloud.fields[0].offset = 0;
  cloud.height = 2;
  EXPECT_EQ(decode(Type::PointCloud2, cdr(cloud), kPoints).error().code, Code::Malformed);
  cloud.fields.clear();
  EXPECT_EQ(decode(Type::PointCloud2, cdr(cloud), kPoints).error().code, Code::Unsupported);
}

TEST(Decode, poses_and_one_transform_of_many) {
  const double half = std::sqrt(0.5);
  const Pose pose{{1, 2, 3}, {0, 0, half, half}};
  const auto expected = [](const Result<Message>& message) {
    const auto got = numbers<double>(message);
    const std::vector<double> T = {0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1};
    ASSERT_EQ(got.size(), T.size());
    for (std::size_t i = 0; i < T.size(); ++i) EXPECT_NEAR(got[i], T[i], 1e-12) << i;
  };
  expected(decode(Type::PoseStamped, cdr(PoseStamped{kStamp, pose}), kPose));
  const TfMessage tf{{{kStamp, "cup", {}}, {kStamp, "head", pose}, {kStamp, "hand", {}}}};
  expected(decode(Type::TfMessage, cdr(tf), kPose, {{}, "head"}));
  EXPECT_EQ(decode(Type::TfMessage, cdr(tf), kPose, {{}, "foot"}).error().code, Code::NotFound);
  EXPECT_EQ(
      decode(Type::PoseStamped, cdr(PoseStamped{kStamp, {{}, {0, 0, 0, 0}}}), kPose).error().code,
      Code::Malformed);
  EXPECT_EQ(
      decode(Type::PoseStamped, cdr(PoseStamped{kStamp, {{NAN, 0, 0}, {}}}), kPose).error().code,
      Code::Malformed);
}

TEST(Decode, joints_by_name) {
  JointState state{kStamp, {"roll", "tilt", "pan"}, {1, 2, 3}, {}, {}};
  EXPECT_EQ(numbers<double>(decode(Type::JointState, cdr(state), kTable)),
            (std::vector<double>{1, 2, 3}));
  state.velocity = {4, 5, 6};
  const auto two = decode(Type::JointState, cdr(state), kTable, {{"pan", "tilt"}, ""});
  EXPECT_EQ(numbers<double>(two), (std::vector<double>{3, 2, 6, 5}));
  EXPECT_EQ(two->header.height, 2);
  EXPECT_EQ(decode(Type::JointState, cdr(state), kTable, {{"jaw"}, ""}).error().code,
            Code::NotFound);
  state.velocity = {4};
  EXPECT_EQ(decode(Type::JointState, cdr(state), kTable).error().code, Code::Malformed);
}

TEST(Decode, small_ones) {
  EXPECT_EQ(numbers<double>(decode(Type::Twist, cdr(Twist{{1, 2, 3}, {4, 5, 6}}), kTable)),
            (std::vector<double>{1, 2, 3, 4, 5, 6}));
  const auto text = decode(Type::String, cdr(String{{"zwölf"}}), kText);
  ASSERT_TRUE(text);
  EXPECT_EQ(text->text(), "zwölf");
  EXPECT_TRUE(decode(Type::String, cdr(String{{""}}), kText));
  CameraInfo camera;
  camera.p = {500, 0, 320, -60, 0, 510, 240, 0, 0, 0, 1, 0};
  EXPECT_EQ(numbers<double>(decode(Type::CameraInfo, cdr(camera), kTable)),
            (std::vector<double>{500, 510, 320, 240, 0.12}));
  EXPECT_EQ(decode(Type::CameraInfo, cdr(CameraInfo{}), kTable).error().code, Code::Malformed);
}

TEST(Decode, arrays_have_the_shape_that_they_say) {
  const std::array<double, 6> all = {1, 2, 3, 4, 5, 6};
  const auto bytes = std::as_bytes(std::span(all));
  MultiArray<double> array{{}, 1, {bytes}};
  EXPECT_EQ(numbers<double>(decode(Type::Float64MultiArray, cdr(array), kTable)),
            (std::vector<double>{2, 3, 4, 5, 6}));
  array = {{{"height", 3, 6}, {"width", 2, 2}}, 0, {bytes}};
  const auto matrix = must(decode(Type::Float64MultiArray, cdr(array), kTable));
  EXPECT_EQ(matrix.header.height, 3);
  array.dim[0].size = 4;
  EXPECT_EQ(decode(Type::Float64MultiArray, cdr(array), kTable).error().code, Code::Malformed);
  array.dim = {{"", 0xFFFFFFFF, 0}, {"", 0xFFFFFFFF, 0}, {"", 0xFFFFFFFF, 0}};
  EXPECT_EQ(decode(Type::Float64MultiArray, cdr(array), kTable).error().code, Code::Malformed);
}

TEST(Decode, images_that_promise_more_than_is_there_are_refused) {
  const auto pixels = octets({1, 2, 3});
  for (const auto& image :
       {Image{kStamp, 2, 1, "rgb8", 0, 3, {pixels}}, Image{kStamp, 1, 2, "rgb8", 0, 3, {pixels}},
        Image{kStamp, 0xFFFFFFFF, 0xFFFFFFFF, "mono8", 0, 0xFFFFFFFF, {pixels}},
        Image{kStamp, 0x80000000, 0, "mono8", 0, 0, {pixels}}}) {
    const auto refused = decode(Type::Image, cdr(image), kRgb);
    ASSERT_FALSE(refused);
    EXPECT_TRUE(refused.error().code == Code::Malformed || refused.error().code == Code::TooLarge);
  }
  EXPECT_EQ(
      decode(Type::Image, cdr(Image{kStamp, 1, 1, "yuv422", 0, 3, {pixels}}), kRgb).error().code,
      Code::Unsupported);
  EXPECT_EQ(decode(Type::Image, cdr(Twist{}), kPose).error().code, Code::Unsupported);
}

TEST(Decode, what_is_damaged_is_decoded_or_refused) {
  const std::vector<std::byte> data(64);
  PointCloud2 cloud{kStamp, 2,   2, {{"x", 0, 7, 1}, {"y", 4, 7, 1}, {"z", 8, 7, 1}}, false, 12, 24,
                    {data}, true};
  const TfMessage tf{{{kStamp, "cup", {}}}};
  const JointState joints{kStamp, {"a", "b"}, {1, 2}, {}, {}};
  struct Case {
    Type type;
    std::vector<std::byte> bytes;
    PortType port;
  };
  const Case cases[] = {{Type::Image, cdr(Image{kStamp, 4, 4, "rgb8", 0, 12, {data}}), kRgb},
                        {Type::CompressedImage, cdr(CompressedImage{kStamp, "jpeg", {data}}), kRgb},
                        {Type::PointCloud2, cdr(cloud), kPoints},
                        {Type::CameraInfo, cdr(CameraInfo{}), kTable},
                        {Type::PoseStamped, cdr(PoseStamped{}), kPose},
                        {Type::TfMessage, cdr(tf), kPose},
                        {Type::Twist, cdr(Twist{}), kTable},
                        {Type::JointState, cdr(joints), kTable},
                        {Type::String, cdr(String{{"text"}}), kText},
                        {Type::Float64MultiArray,
                         cdr(MultiArray<double>{{{"", 4, 8}, {"", 2, 2}}, 0, {data}}), kTable}};
  std::mt19937 random(2);
  for (const auto& [type, bytes, port] : cases)
    for (int round = 0; round < 5000; ++round) {
      auto damaged = bytes;
      for (unsigned i = 0; i <= random() % 3; ++i)
        damaged[4 + random() % (damaged.size() - 4)] = static_cast<std::byte>(random());
      if (random() % 4 == 0) damaged.resize(random() % damaged.size());
      const auto message = decode(type, damaged, port, {{}, "cup"});
      EXPECT_TRUE(!message || check(message->header));
    }
}

}  // namespace
}  // namespace hc::ros
