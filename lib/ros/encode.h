// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages as messages of ROS 2: which type a port's become, and their bytes in CDR. Pure.
//
//     ros::Encoder encoder;
//     ros::Type type = *ros::type_for(port);            // fixed, as the schema of a topic is
//     auto pieces = encoder.encode(type, message);      // the elements in place where they fit

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <hc/contract/description.h>
#include <hc/contract/log_line.h>
#include <hc/contract/port_type.h>
#include <hc/mtp/message.h>
#include <ros/messages.h>
#include <ros/schema.h>

namespace hc::ros {

/// The type that messages of a type become, whatever of a shape it does not fix; nothing for those
/// in encoding zstd, which are to be expanded first.
///
/// | messages | become |
/// |---|---|
/// | jpeg | CompressedImage |
/// | rgb_image, intensity_image; not of u32, u64, i64 | Image |
/// | position, 1 × 1 of 3 components | PoseStamped without a rotation |
/// | position else; vector_field of 3 or 6 floats in a metric frame | PointCloud2 |
/// | rotation, coord gaze | JointState: roll, tilt, pan |
/// | rotation, 1 × 1 or any shape | PoseStamped at the origin |
/// | transformation, 4 × 4 | PoseStamped, in the frame that it leads to |
/// | string | String |
/// | sound | RawAudio, pcm-s16 |
/// | table of 5 × 1 f64, coord left_rectified | CameraInfo (R45) |
/// | all else | Float64MultiArray, or that of its scalar |
///
/// Twist, TfMessage and Log are nobody's by themselves.
std::optional<Type> type_for(const PortType& port);
/// The same of an output, expanded where it is compressed; nothing where it may send anything.
/// @param jpeg  images of u8 are made CompressedImage.
std::optional<Type> type_for(const PortDescription& output, bool jpeg = false);
/// The same of a message alone.
std::optional<Type> type_for(const Header& header);

/// A joint of the frames of a graph at some time: T_parent_child.
struct Joint {
  std::string parent, child;
  std::array<double, 3> translation{};            ///< [m]
  std::array<double, 4> rotation = {0, 0, 0, 1};  ///< unit quaternion (x, y, z, w)
  std::int64_t time = 0;                          ///< [ns since the Unix epoch]
};

/// Writes messages in CDR. What it gives is valid until it is called again, and no longer than the
/// message. An object is used by one thread.
class Encoder {
 public:
  /// Names of frames by their number; the others have those of R44, and numbers as text.
  std::map<std::int32_t, std::string> frames;
  /// Size of the images that a CameraInfo is of; 0: unknown. [px]
  std::uint32_t camera_width = 0, camera_height = 0;
  /// Names of the joints that are the columns of a table which is to be a JointState: rows of
  /// positions, velocities and efforts, as far as there are.
  std::vector<std::string> joints;

  /// A message as one of `type`. Images, points and so on are `body`, where they were.
  ///
  /// Errors: Unsupported (another matrix, shape or encoding than the type can hold).
  /// Cost: no copy of large elements but those of sound that is not of i16.
  Result<Pieces> encode(Type type, const Message& message);

  /// The same of a message in any encoding: expanded where it is compressed, and made JPEG where it
  /// is to be a CompressedImage; a Matrix has it as it came.
  ///
  /// Errors: as encode(), expand() and compress().
  Result<Pieces> encode_any(Type type, const Message& message);

  /// A tf2_msgs/msg/TFMessage of joints.
  Pieces encode(std::span<const Joint> list);

  /// A line of a graph's log as a rcl_interfaces/msg/Log.
  /// @param time  [ns since the Unix epoch]
  Pieces encode_log(std::int64_t time, const LogLine& line);

  /// An MTP message whole (`offset` 0), or what its other form lacks, whose bytes from `offset` on
  /// are its elements.
  Pieces encode_matrix(const Message& message, std::uint32_t offset = 0);

  /// Name of a coordinate system as a frame_id; that of an image is its camera's frame.
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

/// Seconds and nanoseconds of a time [ns since the Unix epoch], which ends in 2038 there.
Time time_of(std::int64_t nanoseconds);

}  // namespace hc::ros
