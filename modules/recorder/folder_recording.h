// SPDX-License-Identifier: Apache-2.0
#pragma once
// Records into a folder: a file STREAM.mtp for each stream, of its messages and nothing else.

#include <memory>
#include <string>
#include <vector>

#include "recording.h"

/// Writes as messages come. Ends at the first failure: then all files hold whole messages alone.
///
/// Makes the folder where it is not there. Where it holds one of the files it is FOLDER_2 instead,
/// and so on.
/// @param streams  names of files, each another.
///
/// Errors: Invalid (names that cannot be those of files), System.
hc::Result<std::unique_ptr<Recording>> open_folder(const std::string& folder,
                                                   const std::vector<std::string>& streams);
