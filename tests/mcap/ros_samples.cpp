// SPDX-License-Identifier: Apache-2.0
// ros_samples COUNT: prints a line of JSON for each type of ROS 2, {"type", "text", "messages"}:
// messages in CDR as hexadecimal digits, first one with known values (ros_test.mjs has them), then
// COUNT random ones.

#include <cstdlib>
#include <iostream>
#include <random>

#include <hc/base/json_string.h>
#include <hc/mtp/coords.h>
#include <hc/mtp/matrix_view.h>
#include <ros/encode.h>

namespace {

using hc::Info;
using hc::MatrixType;
using hc::Scalar;
using hc::ros::Type;

constexpr hc::Time kTime = hc::unix_time(1'763'683'200'123'456'789);

struct Case {
  Type type;
  hc::Header header;
};

hc::Header header(MatrixType type, int components, Scalar scalar, std::int32_t width,
                  std::int32_t height, std::int32_t coord) {
  hc::Header header;
  header.info = {type, static_cast<std::uint8_t>(components), scalar, hc::Encoding::Binary};
  header.width = width;
  header.height = height;
  header.coord = coord;
  header.time = kTime;
  return header;
}

/// Elements 1, 2, 3, …, or random bits.
hc::Message message_of(const hc::Header& header, std::mt19937* random) {
  auto draft = hc::Draft::make(header);
  if (random != nullptr) {
    draft.header.time = hc::unix_time(static_cast<std::int64_t>((*random)()) * 1'000'000'007 / 2);
    for (auto& each : draft.elements()) each = static_cast<std::byte>((*random)());
  } else {
    hc::visit_scalar(header.info.scalar, [&](auto zero) {
      auto next = zero;
      for (auto& each : hc::view<decltype(zero)>(draft).numbers()) each = ++next;
    });
  }
  return std::move(draft).finish();
}

std::vector<Case> cases() {
  std::vector<Case> all = {
      {Type::Image, header(MatrixType::RgbImage, 3, Scalar::U8, 3, 2, 7)},
      {Type::CompressedImage, header(MatrixType::RgbImage, 3, Scalar::U8, 3, 2, 8)},
      {Type::PointCloud2, header(MatrixType::VectorField, 6, Scalar::F32, 2, 2, 4)},
      {Type::CameraInfo, header(MatrixType::Table, 1, Scalar::F64, 5, 1, 9)},
      {Type::PoseStamped, header(MatrixType::Position, 3, Scalar::F64, 1, 1, 3)},
      {Type::Twist, header(MatrixType::Table, 1, Scalar::F64, 6, 1, 0)},
      {Type::JointState, header(MatrixType::Rotation, 6, Scalar::F64, 1, 1, 13)},
      {Type::String, header(MatrixType::String, 1, Scalar::U8, 5, 1, 30)},
      {Type::RawAudio, header(MatrixType::Sound, 2, Scalar::I16, 3, 1, 21)},
      {Type::Matrix, header(MatrixType::Table, 1, Scalar::U8, 3, 1, 0)},
  };
  for (int scalar = 0; scalar < 10; ++scalar)
    all.push_back({static_cast<Type>(scalar),
                   header(MatrixType::Table, 2, static_cast<Scalar>(scalar), 3, 2, 40)});
  return all;
}

std::string hex(const hc::ros::Pieces& pieces) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const auto piece : {pieces.head, pieces.body, pieces.tail})
    for (const auto each : piece) {
      text += kDigits[static_cast<unsigned>(each) >> 4];
      text += kDigits[static_cast<unsigned>(each) & 15];
    }
  return text;
}

void print(Type type, const std::vector<std::string>& messages) {
  const auto& schema = hc::ros::schema(type);
  std::string text;
  hc::append_json_string(schema.text, text);
  std::cout << R"({"type":")" << schema.name << R"(","text":)" << text << R"(,"messages":[)";
  for (std::size_t i = 0; i < messages.size(); ++i)
    std::cout << (i > 0 ? ",\"" : "\"") << messages[i] << '"';
  std::cout << "]}\n";
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 0;
  std::mt19937 random(1);  // NOLINT(cert-msc51-cpp): the same each time
  hc::ros::Encoder encoder;
  encoder.camera_width = 800;
  encoder.camera_height = 600;
  for (const auto& [type, first] : cases()) {
    std::vector<std::string> messages;
    for (int i = 0; i <= count; ++i) {
      auto header = first;
      const bool is_small = type == Type::CameraInfo || type == Type::PoseStamped ||
                            type == Type::Twist || type == Type::CompressedImage;
      if (i > 0 && !is_small) header.width = static_cast<std::int32_t>(random() % 9);
      auto message = message_of(header, i > 0 ? &random : nullptr);
      if (i > 0 && type == Type::String) {  // bytes that are UTF-8
        auto draft = hc::Draft::make(message.header);
        for (auto& each : draft.elements()) each = static_cast<std::byte>(' ' + random() % 90);
        message = std::move(draft).finish();
      }
      if (type == Type::CompressedImage) message.header.info.encoding = hc::Encoding::Jpeg;
      messages.push_back(hex(*encoder.encode(type, message)));
    }
    print(type, messages);
  }
  const hc::ros::Joint joint{"robot", "head", {1, 2, 3}, {0, 0, 0.6, 0.8}, kTime};
  print(Type::TfMessage, {hex(encoder.encode(std::vector{joint, joint}))});
  print(Type::Log, {hex(encoder.encode_log(kTime, {"eyes", hc::Level::Warning, "it is dark"}))});
}
