// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages of ROS 2, in CDR, as messages. Pure.
//
//     auto message = ros::decode(ros::Type::Twist, bytes, hc::table().of(1, 6).type);

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <hc/base/result.h>
#include <hc/contract/port_type.h>
#include <hc/mtp/message.h>
#include <ros/schema.h>

namespace hc::ros {

/// What is taken of a message, where it has more than one thing.
struct Choice {
  std::vector<std::string> joints;  ///< of a JointState, in this order; empty: all, in its own
  std::string child;                ///< of a TFMessage: the frame whose pose it is
};

/// A message of ROS as one of a port's type. Its time is the stamp's; 0: it has none.
///
/// | of ROS | becomes |
/// |---|---|
/// | Image: rgb8, bgr8, rgba8, bgra8, mono8 | rgb_image or intensity_image of u8 |
/// | Image: 32FC1 [m], 16UC1 [mm] | intensity_image of f32 [m]; 0: unknown |
/// | CompressedImage: jpeg | rgb_image or intensity_image of u8 in encoding jpeg, not looked into |
/// | PointCloud2 with x, y, z of float32 or float64 | position of f32 |
/// | CameraInfo | table of 5 × 1: fx, fy, cx, cy [px], baseline [m], of its matrix P |
/// | PoseStamped, one transform of TFMessage | transformation of 4 × 4 |
/// | Twist | table of 6 × 1: linear, angular |
/// | JointState | table, a joint a column: positions, velocities and efforts, as far as known |
/// | String | string |
/// | Float64MultiArray | table; of one row, unless it says two dimensions or three |
///
/// @param bytes  with their encapsulation header; whatever they are, memory is taken in proportion
///   to them.
///
/// Errors: as CdrReader::read(); Malformed (what contradicts itself); Unsupported (another image
/// encoding, big-endian elements, a type that does not become that port's); NotFound (a joint or
/// frame of the choice is not there); TooLarge.
/// Cost: a copy of the elements.
Result<Message> decode(Type type, std::span<const std::byte> bytes, const PortType& port,
                       const Choice& choice = {});

}  // namespace hc::ros
