// SPDX-License-Identifier: Apache-2.0
#pragma once
// A recording that is a folder: where the messages of an output are.

#include <filesystem>
#include <string>
#include <system_error>

namespace hc {

/// FOLDER/MODULE.PORT.mtp.
/// @param output  MODULE.PORT
inline std::string recording_file(const std::string& folder, const std::string& output) {
  return (std::filesystem::path(folder) / (output + ".mtp")).string();
}

/// Whether a folder has no recording, or is not there.
inline bool is_free_for_recording(const std::string& folder) {
  std::error_code missing;
  std::filesystem::directory_iterator each(folder, missing);
  for (; !missing && each != std::filesystem::directory_iterator(); each.increment(missing))
    if (each->path().extension() == ".mtp") return false;
  return true;
}

}  // namespace hc
