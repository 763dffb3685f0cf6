// SPDX-License-Identifier: Apache-2.0
#pragma once
// Converts MTP messages to messages of ROS 2 in CDR. Pure.
//
//     ros::Encoder encoder;
//     ros::Type type = *ros::type_for(port);        // fixed, like the schema of a topic
//     auto pieces = encoder.encode(type, message);  // views the elements if possible

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <hc/contract/log_line.h>
#include <hc/mtp/message.h>
#include <ros/messages.h>
#include <ros/schema.h>

namespace hc::ros {

/// A joint of the frames of a graph at a time: T_parent_child.
struct Joint {
  std::string parent, child;
  std::array<double, 3> translation{};            ///< [m]
  std::array<double, 4> rotation = {0, 0, 0, 1};  ///< unit quaternion (x, y, z, w)
  hc::Time time;
};

/// Writes messages in CDR. Results are valid until the next call, and no longer than the message.
/// Not thread-safe.
class Encoder {
 public:
  /// Names of frames, by number; others have the names of R44, or their number as text.
  std::map<std::int32_t, std::string> frames;
  /// Size of the images described by a CameraInfo; 0: unknown. [px]
  std::uint32_t camera_width = 0, camera_height = 0;
  /// Joint names of the columns of a table that becomes a JointState; its rows are positions,
  /// velocities and efforts, if present.
  std::vector<std::string> joints;

  /// Converts a message to `type`. Elements of images, points and so on are `body`, not copied.
  ///
  /// Errors: Unsupported (a matrix, shape or encoding that does not fit the type).
  /// Cost: copies no large elements, except sound that is not i16.
  Result<Pieces> encode(Type type, const Message& message);

  /// Converts a message in any encoding: expands or, for CompressedImage, compresses it first; a
  /// Matrix keeps its encoding.
  ///
  /// Errors: as encode(), expand() and compress().
  Result<Pieces> encode_any(Type type, const Message& message);

  /// A tf2_msgs/msg/TFMessage of joints.
  Pieces encode(std::span<const Joint> list);

  /// A line of a graph's log as a rcl_interfaces/msg/Log.
  Pieces encode_log(hc::Time time, const LogLine& line);

  /// A whole MTP message (`offset` 0), or the companion of a message of another type, in which the
  /// elements start at `offset`.
  Pieces encode_matrix(const Message& message, std::uint32_t offset = 0);

  /// The frame_id of a coordinate system; for images, the frame of their camera.
  [[nodiscard]] std::string frame_id(std::int32_t coord) const;

 private:
  Result<Pieces> encode_image(const Message& message);
  Result<Pieces> encode_points(const Message& message);
  Result<Pieces> encode_pose(const Message& message);
  Result<Pieces> encode_twist(const Message& message);
  Result<Pieces> encode_joints(const Message& message);
  Result<Pieces> encode_camera(const Message& message);
  Result<Pieces> encode_text(const Message& message);
  Result<Pieces> encode_sound(const Message& message);

  CdrWriter writer_;
  Message made_;                    // expanded or compressed
  std::string text_;                // of several rows
  std::vector<std::byte> samples_;  // of sound in another scalar
};

/// Converts a time; ROS times end in 2038.
Time time_of(hc::Time time);

}  // namespace hc::ros
