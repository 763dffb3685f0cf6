// SPDX-License-Identifier: Apache-2.0
#pragma once
// Records into a file of MCAP, with what the graph says of itself.

#include <memory>
#include <string>
#include <vector>

#include <hc/module/module.h>
#include <mcap/recorder.h>

#include "recording.h"

struct McapOptions : hc::mcap::RecorderOptions {
  std::string frames;  ///< of the graph, as text
  /// A stream: what is kept of the last time is saved when its first number becomes other than 0.
  std::string when;
};

/// Where the file is there, and neither split nor made of the last time, it is FILE_2 instead, and
/// so on.
/// @param module  gives the time, and logs what is saved; must outlive the recording.
///
/// Errors: Invalid, System.
hc::Result<std::unique_ptr<Recording>> open_mcap(hc::Module& module, McapOptions options,
                                                 const std::vector<std::string>& streams);
