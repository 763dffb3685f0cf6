// SPDX-License-Identifier: Apache-2.0
#pragma once
// The types of ROS 2 that messages convert to, with their names and definitions (`ros2msg`). Pure.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace hc::ros {

/// A message type of ROS 2. The arrays are in the order of hc::Scalar.
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

struct Schema {
  Type type;
  std::string name;  ///< such as "sensor_msgs/msg/Image"
  std::string text;  ///< its definition, then those of its parts, each after a line of 80 `=`
};

/// All schemas, in the order of Type.
std::span<const Schema> schemas();
const Schema& schema(Type type);

/// The type of that name; nullopt if unknown.
std::optional<Type> type_of(std::string_view name);

}  // namespace hc::ros
