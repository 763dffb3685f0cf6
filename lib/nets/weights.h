// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where the weights of networks are installed.

#include <string>

#include <hc/base/result.h>

namespace hc::nets {

/// The path of a file of weights, beside the installed modules or in the build to which the running
/// program belongs: PREFIX/share/hypercolumn/nets/NAME. It need not exist.
std::string weights_path(const std::string& name);

/// The bytes of such a file.
///
/// Errors: NotFound, which says what installs the weights; TooLarge (more than 64 MiB); System.
/// Each begins with the path.
Result<std::string> read_weights(const std::string& path);

}  // namespace hc::nets
