// SPDX-License-Identifier: Apache-2.0
#pragma once
// QR codes, to open a URL on a phone.

#include <string>
#include <vector>

namespace hc::web {

/// A QR code (ISO/IEC 18004, level L) for a terminal, as lines of half blocks, dark on light; empty
/// if the text is too long.
std::vector<std::string> qr_lines(const std::string& text);

}  // namespace hc::web
