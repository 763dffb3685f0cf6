// SPDX-License-Identifier: Apache-2.0
#pragma once
// Chooses the type of ROS 2 to which MTP messages convert. Pure.

#include <cstdint>
#include <optional>
#include <string_view>

#include <hc/contract/description.h>
#include <hc/contract/port_type.h>
#include <hc/mtp/message.h>
#include <ros/schema.h>

namespace hc::ros {

/// The ROS type for messages of a port's type, valid for every shape it allows; nullopt for
/// encoding zstd, which must be expanded first.
///
/// | MTP | ROS |
/// |---|---|
/// | jpeg | CompressedImage |
/// | rgb_image, intensity_image; not of u32, u64, i64 | Image |
/// | position, 1 × 1 of 3 components | PoseStamped without a rotation |
/// | other position; vector_field of 3 or 6 floats in a metric frame | PointCloud2 |
/// | rotation, coord gaze | JointState: roll, tilt, pan |
/// | rotation, 1 × 1 or any shape | PoseStamped at the origin |
/// | transformation, 4 × 4 | PoseStamped, in its target frame |
/// | string | String |
/// | sound | RawAudio, pcm-s16 |
/// | table of 5 × 1 f64, coord left_rectified | CameraInfo (R45) |
/// | anything else | Float64MultiArray, or that of its scalar |
///
/// Twist, TfMessage and Log are never chosen.
std::optional<Type> type_for(const PortType& port);
/// The ROS type for an output, expanded if compressed; nullopt for an output of any type.
/// @param jpeg  images of u8 become CompressedImage.
std::optional<Type> type_for(const PortDescription& output, bool jpeg = false);
/// The ROS type for a single message.
std::optional<Type> type_for(const Header& header);

/// ROS's name for the pixels of an image matrix, such as "rgb8"; empty: none.
std::string_view pixel_encoding(const Info& info, std::int32_t coord);

}  // namespace hc::ros
