// SPDX-License-Identifier: Apache-2.0
#include "recogniser.h"

#include <dlfcn.h>

#include <algorithm>

#include <tesseract/baseapi.h>
#include <tesseract/resultiterator.h>

namespace {

/// Keeps Tesseract on one thread: its loops are too short to gain from more. The same as
/// OMP_THREAD_LIMIT=1, which is only read before main().
void keep_to_one_thread() {
  using SetLevels = void (*)(int);
  if (void* set = dlsym(RTLD_DEFAULT, "omp_set_max_active_levels"); set != nullptr)
    reinterpret_cast<SetLevels>(set)(0);
}

std::string without_space_around(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\n\r\f");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\n\r\f") - first + 1);
}

}  // namespace

struct Recogniser::Engine {
  tesseract::TessBaseAPI api;
};

hc::Result<Recogniser> Recogniser::make(const std::string& language, bool upper_case) {
  keep_to_one_thread();
  auto engine = std::make_shared<Engine>();
  auto& api = engine->api;
  api.SetVariable("debug_file", "/dev/null");  // else it writes to standard error
  if (api.Init(nullptr, language.c_str(), tesseract::OEM_LSTM_ONLY) != 0)
    return hc::Error{hc::Code::Invalid, "Tesseract has no language " + language +
                                            " (package tesseract-ocr-" + language + ")"};
  if (upper_case)
    api.SetVariable("tessedit_char_whitelist", "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-.,!? ");
  else  // look-alikes of ASCII characters
    api.SetVariable("tessedit_char_blacklist", "|—–‘’“”");
  // Names and codes are not in a dictionary.
  api.SetVariable("load_system_dawg", "0");
  api.SetVariable("load_freq_dawg", "0");
  return Recogniser(std::move(engine));
}

hc::vision::Reading Recogniser::read(const cv::Mat& line) {
  return read_by(tesseract::PSM_SINGLE_LINE, line);
}

hc::vision::Reading Recogniser::read_crop(const cv::Mat& crop) {
  // As a line, letters that touch the border are often missed.
  return read_by(tesseract::PSM_SINGLE_WORD, crop);
}

hc::vision::Reading Recogniser::read_by(int segmentation, const cv::Mat& image) {
  auto& api = engine_->api;
  api.SetPageSegMode(static_cast<tesseract::PageSegMode>(segmentation));
  api.SetImage(image.data, image.cols, image.rows, 1, static_cast<int>(image.step));
  api.SetSourceResolution(300);
  const std::unique_ptr<char[]> text(api.GetUTF8Text());
  hc::vision::Reading reading;
  if (text == nullptr) return reading;
  reading.text = without_space_around(text.get());
  // Mean over the letters: Tesseract's confidence of a word is that of its worst letter.
  const std::unique_ptr<tesseract::ResultIterator> letter(api.GetIterator());
  double sum = 0;
  int count = 0;
  bool is_ascii = true;
  if (letter != nullptr) {
    do {
      const std::unique_ptr<char[]> symbol(letter->GetUTF8Text(tesseract::RIL_SYMBOL));
      const double sure = letter->Confidence(tesseract::RIL_SYMBOL);
      sum += sure;
      ++count;
      int left = 0, top = 0, right = 0, bottom = 0;
      letter->BoundingBox(tesseract::RIL_SYMBOL, &left, &top, &right, &bottom);
      if (symbol == nullptr || symbol[0] == '\0' || symbol[1] != '\0')
        is_ascii = false;
      else
        reading.letters.push_back({symbol[0], sure, letter->IsAtBeginningOf(tesseract::RIL_WORD),
                                   letter->WordIsFromDictionary(), (left + right) / 2});
    } while (letter->Next(tesseract::RIL_SYMBOL));
  }
  if (!is_ascii) reading.letters.clear();
  if (count > 0) reading.confidence = std::clamp(sum / count / 100, 0.0, 1.0);
  api.Clear();
  return reading;
}
