// SPDX-License-Identifier: Apache-2.0
#pragma once
// The types of ROS 2 that messages become, by name and as text (`ros2msg`). Pure.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace hc::ros {

/// A message type of ROS 2. The arrays of numbers are in the order of hc::Scalar.
enum class Type : std::uint8_t {
  UInt8MultiArray,
  Int8MultiArray,
  UInt16MultiArray,
  Int16MultiArray,
  UInt32MultiArray,
  Int32MultiArray,
  UInt64MultiArray,
  Int64MultiArray,
  Float32MultiArray,
  Float64MultiArray,
  Image,
  CompressedImage,
  PointCloud2,
  CameraInfo,
  PoseStamped,
  Twist,
  TfMessage,
  JointState,
  String,
  RawAudio,
  Log,
  Matrix,
};

/// How a type is described to others.
struct Schema {
  Type type;
  std::string name;  ///< "sensor_msgs/msg/Image"
  std::string text;  ///< its definition, and behind a line of 80 `=` each that it is made of
};

/// All of them, in the order of Type.
std::span<const Schema> schemas();
const Schema& schema(Type type);

/// The type of that name; nothing where it is none of these.
std::optional<Type> type_of(std::string_view name);

}  // namespace hc::ros
