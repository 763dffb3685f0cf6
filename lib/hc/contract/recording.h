// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where the messages of an output are in a recording that is a folder.

#include <filesystem>
#include <string>

namespace hc {

/// FOLDER/MODULE.PORT.mtp.
/// @param output  MODULE.PORT
inline std::string recording_file(const std::string& folder, const std::string& output) {
  return (std::filesystem::path(folder) / (output + ".mtp")).string();
}

}  // namespace hc
