// SPDX-License-Identifier: Apache-2.0
#pragma once
// A URL for a phone's camera.

#include <string>
#include <vector>

namespace hc::web {

/// A text as a QR code (ISO/IEC 18004, level L) for a terminal: lines of half blocks, dark on
/// light; nothing where the text is too long.
std::vector<std::string> qr_lines(const std::string& text);

}  // namespace hc::web
