// SPDX-License-Identifier: Apache-2.0
#pragma once
// The files of lib/room/assets, within the program. CMake writes the source (hc_embed_bytes).

#include <cstddef>
#include <span>

namespace hc::room {

std::span<const std::byte> face_photograph();  ///< JPEG
std::span<const std::byte> left_hand_model();  ///< binary glTF, with bones as WebXR names them
std::span<const std::byte> right_hand_model();

}  // namespace hc::room
