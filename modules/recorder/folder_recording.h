// SPDX-License-Identifier: Apache-2.0
#pragma once
// Records into a folder: a file STREAM.mtp for each stream, of its messages and nothing else.

#include <memory>
#include <string>
#include <vector>

#include "recording.h"

/// Writes messages as they come. The first failure ends the recording of all streams; that of a
/// stream whose small messages are still in a buffer is noticed at its next message, or at the end.
/// Then each file holds only whole messages.
///
/// Creates the folder if there is none. If it holds one of the files, the recording goes to
/// FOLDER_2 instead, and so on. After an error nothing of it is left.
/// @param streams  names of files, all different.
///
/// Errors: Invalid (a name that cannot be a file's, or is there twice), System.
hc::Result<std::unique_ptr<Recording>> open_folder(const std::string& folder,
                                                   const std::vector<std::string>& streams);
