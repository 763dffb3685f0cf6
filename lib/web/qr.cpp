// SPDX-License-Identifier: Apache-2.0
#include <web/qr.h>

#include <qrencode.h>

#include <memory>

namespace hc::web {

std::vector<std::string> qr_lines(const std::string& text) {
  const std::unique_ptr<QRcode, void (*)(QRcode*)> code(
      QRcode_encodeString(text.c_str(), 0, QR_ECLEVEL_L, QR_MODE_8, 1), QRcode_free);
  if (!code) return {};
  constexpr int kQuiet = 2;  // margin in modules; the standard asks for 4, 2 are enough in practice
  const int size = code->width;
  const auto is_dark = [&](int x, int y) {
    const bool is_inside = x >= 0 && y >= 0 && x < size && y < size;
    return is_inside && (code->data[y * size + x] & 1) != 0;
  };
  std::vector<std::string> lines;
  for (int y = -kQuiet; y < size + kQuiet; y += 2) {
    std::string line = "\x1b[30;107m";
    for (int x = -kQuiet; x < size + kQuiet; ++x)
      line += is_dark(x, y) ? (is_dark(x, y + 1) ? "█" : "▀") : is_dark(x, y + 1) ? "▄" : " ";
    lines.push_back(line + "\x1b[0m");
  }
  return lines;
}

}  // namespace hc::web
