// SPDX-License-Identifier: Apache-2.0
#pragma once
// The messages of ROS 2 that MTP messages convert to, as structs; schema.h has their definitions.
// Sources: ros2/common_interfaces, ros2/rcl_interfaces, ros2/geometry2; foxglove/foxglove-sdk.

#include <array>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include <ros/cdr.h>

namespace hc::ros {

struct Time {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  static auto members(auto& m) { return std::tie(m.sec, m.nanosec); }
};

/// std_msgs/msg/Header
struct Stamp {
  Time stamp;
  std::string frame_id;
  static auto members(auto& m) { return std::tie(m.stamp, m.frame_id); }
};

struct Vector3 {
  double x = 0, y = 0, z = 0;
  static auto members(auto& m) { return std::tie(m.x, m.y, m.z); }
};

struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
  static auto members(auto& m) { return std::tie(m.x, m.y, m.z, m.w); }
};

/// geometry_msgs/msg/Pose and Transform, which have the same layout
struct Pose {
  Vector3 position;
  Quaternion orientation;
  static auto members(auto& m) { return std::tie(m.position, m.orientation); }
};

struct Image {
  Stamp header;
  std::uint32_t height = 0, width = 0;
  std::string encoding;
  std::uint8_t is_bigendian = 0;
  std::uint32_t step = 0;
  Numbers<std::uint8_t> data;
  static auto members(auto& m) {
    return std::tie(m.header, m.height, m.width, m.encoding, m.is_bigendian, m.step, m.data);
  }
};

struct CompressedImage {
  Stamp header;
  std::string format;
  Numbers<std::uint8_t> data;
  static auto members(auto& m) { return std::tie(m.header, m.format, m.data); }
};

struct PointField {
  static constexpr std::uint8_t kFloat32 = 7, kFloat64 = 8;

  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = kFloat32;
  std::uint32_t count = 1;
  static auto members(auto& m) { return std::tie(m.name, m.offset, m.datatype, m.count); }
};

struct PointCloud2 {
  Stamp header;
  std::uint32_t height = 0, width = 0;
  std::vector<PointField> fields;
  bool is_bigendian = false;
  std::uint32_t point_step = 0, row_step = 0;
  Numbers<std::uint8_t> data;
  bool is_dense = false;
  static auto members(auto& m) {
    return std::tie(m.header, m.height, m.width, m.fields, m.is_bigendian, m.point_step, m.row_step,
                    m.data, m.is_dense);
  }
};

struct RegionOfInterest {
  std::uint32_t x_offset = 0, y_offset = 0, height = 0, width = 0;
  bool do_rectify = false;
  static auto members(auto& m) {
    return std::tie(m.x_offset, m.y_offset, m.height, m.width, m.do_rectify);
  }
};

struct CameraInfo {
  Stamp header;
  std::uint32_t height = 0, width = 0;
  std::string distortion_model;
  std::vector<double> d;
  std::array<double, 9> k{}, r{};
  std::array<double, 12> p{};
  std::uint32_t binning_x = 0, binning_y = 0;
  RegionOfInterest roi;
  static auto members(auto& m) {
    return std::tie(m.header, m.height, m.width, m.distortion_model, m.d, m.k, m.r, m.p,
                    m.binning_x, m.binning_y, m.roi);
  }
};

struct PoseStamped {
  Stamp header;
  Pose pose;
  static auto members(auto& m) { return std::tie(m.header, m.pose); }
};

struct Twist {
  Vector3 linear, angular;
  static auto members(auto& m) { return std::tie(m.linear, m.angular); }
};

struct TransformStamped {
  Stamp header;
  std::string child_frame_id;
  Pose transform;
  static auto members(auto& m) { return std::tie(m.header, m.child_frame_id, m.transform); }
};

struct TfMessage {
  std::vector<TransformStamped> transforms;
  static auto members(auto& m) { return std::tie(m.transforms); }
};

struct JointState {
  Stamp header;
  std::vector<std::string> name;
  std::vector<double> position, velocity, effort;
  static auto members(auto& m) {
    return std::tie(m.header, m.name, m.position, m.velocity, m.effort);
  }
};

struct String {
  Characters data;
  static auto members(auto& m) { return std::tie(m.data); }
};

struct MultiArrayDimension {
  std::string label;
  std::uint32_t size = 0, stride = 0;
  static auto members(auto& m) { return std::tie(m.label, m.size, m.stride); }
};

/// std_msgs/msg/Float64MultiArray and those of other scalars
template <typename T>
struct MultiArray {
  std::vector<MultiArrayDimension> dim;
  std::uint32_t data_offset = 0;
  Numbers<T> data;
  static auto members(auto& m) { return std::tie(m.dim, m.data_offset, m.data); }
};

/// foxglove_msgs/msg/RawAudio
struct RawAudio {
  Time timestamp;
  Numbers<std::uint8_t> data;
  std::string format;
  std::uint32_t sample_rate = 0, number_of_channels = 0;
  static auto members(auto& m) {
    return std::tie(m.timestamp, m.data, m.format, m.sample_rate, m.number_of_channels);
  }
};

/// rcl_interfaces/msg/Log
struct Log {
  static constexpr std::uint8_t kInfo = 20, kWarning = 30, kError = 40;

  Time stamp;
  std::uint8_t level = kInfo;
  std::string name, msg, file, function;
  std::uint32_t line = 0;
  static auto members(auto& m) {
    return std::tie(m.stamp, m.level, m.name, m.msg, m.file, m.function, m.line);
  }
};

/// hypercolumn_msgs/msg/Matrix: a whole MTP message, or its header with a companion message of
/// another type that contains the elements.
struct Matrix {
  std::string header;        ///< the header line without the line end
  std::uint32_t offset = 0;  ///< of the elements in the companion; 0: they are here
  std::uint32_t size = 0;    ///< of the elements in the companion [byte]
  Numbers<std::uint8_t> elements;
  static auto members(auto& m) { return std::tie(m.header, m.offset, m.size, m.elements); }
};

}  // namespace hc::ros
