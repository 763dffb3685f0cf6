// SPDX-License-Identifier: Apache-2.0
#pragma once
// Converts messages of ROS 2, in CDR, to MTP messages. Pure.
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

/// Selects parts of a message.
struct Choice {
  std::vector<std::string>
      joints;         ///< of a JointState, in this order; empty: all, as in the message
  std::string child;  ///< of a TFMessage: the frame whose pose is taken
};

/// Converts a message of ROS to a port's type. Its time is that of the stamp, if any.
///
/// | ROS | MTP |
/// |---|---|
/// | Image: rgb8, bgr8, rgba8, bgra8, mono8 | rgb_image or intensity_image of u8 |
/// | Image: 32FC1 [m], 16UC1 [mm] | intensity_image of f32 [m]; 0: unknown |
/// | CompressedImage: jpeg | rgb_image or intensity_image of u8 in encoding jpeg, not decoded |
/// | PointCloud2 with x, y, z of float32 or float64 | position of f32 |
/// | CameraInfo | table of 5 × 1: fx, fy, cx, cy [px], baseline [m], from its matrix P |
/// | PoseStamped, one transform of TFMessage | transformation of 4 × 4 |
/// | Twist | table of 6 × 1: linear, angular |
/// | JointState | table, a column for each joint: positions, velocities and efforts, if present |
/// | String | string |
/// | Float64MultiArray | table; of one row, unless it has two or three dimensions |
///
/// @param bytes  with their encapsulation header; may be hostile.
///
/// Errors: as CdrReader::read(); Malformed (inconsistent); Unsupported (another image encoding,
/// big-endian elements, a type that does not convert to the port's); NotFound (a joint or frame of
/// the choice); TooLarge.
/// Cost: a copy of the elements.
Result<Message> decode(Type type, std::span<const std::byte> bytes, const PortType& port,
                       const Choice& choice = {});

}  // namespace hc::ros
