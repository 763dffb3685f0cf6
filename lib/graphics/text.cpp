// SPDX-License-Identifier: Apache-2.0
#include <graphics/text.h>

#include <algorithm>
#include <filesystem>

#include <opencv2/freetype.hpp>
#include <opencv2/imgproc.hpp>

namespace hc::graphics {
namespace {

const char* const kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";  // fonts-dejavu-core

Pen stroked_pen(const cv::Scalar& ink) {
  constexpr int kDuplex = cv::FONT_HERSHEY_DUPLEX;
  const auto plain = [](const std::string& text) {
    std::string each;
    for (const char letter : text)
      if (letter >= ' ' && letter <= '~')
        each += letter;
      else if ((letter & 0xC0) != 0x80)  // first byte of a UTF-8 character
        each += '?';
    return each;
  };
  return {[=](const std::string& text, double scale, int stroke, int& below) {
            return cv::getTextSize(plain(text), kDuplex, scale, stroke, &below);
          },
          [=](cv::Mat& image, const std::string& text, cv::Point at, double scale, int stroke) {
            cv::putText(image, plain(text), at, kDuplex, scale, ink, stroke, cv::LINE_AA);
          }};
}

}  // namespace

Pen pen_for(const std::string& text, const cv::Scalar& ink) {
  const bool is_ascii =
      std::all_of(text.begin(), text.end(), [](char letter) { return (letter & 0x80) == 0; });
  if (is_ascii || !std::filesystem::exists(kFont)) return stroked_pen(ink);
  auto font = cv::freetype::createFreeType2();
  font->loadFontData(kFont, 0);
  const auto height = [](double scale) { return std::max(1, static_cast<int>(30 * scale)); };
  return {[=](const std::string& each, double scale, int, int& below) {
            return font->getTextSize(each, height(scale), cv::FILLED, &below);
          },
          [=](cv::Mat& image, const std::string& each, cv::Point at, double scale, int) {
            font->putText(image, each, at, height(scale), ink, cv::FILLED, cv::LINE_AA, true);
          }};
}

}  // namespace hc::graphics
