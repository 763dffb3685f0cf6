// SPDX-License-Identifier: Apache-2.0
// Reads letters in images, and says where they are.
#include <algorithm>
#include <optional>

#include <hc/module/module.h>
#include <vision/letter_shapes.h>
#include <vision/letters.h>
#include <vision/messages.h>

#include "announcer.h"
#include "block.h"
#include "recogniser.h"

int main(int argc, char** argv) {
  hc::Module module{"read", "Reads lines of letters on an even ground, as on a board."};
  auto image = module.input(
      "image", hc::any_of(hc::rgb_image<std::uint8_t>(), hc::intensity_image<std::uint8_t>()),
      "image with letters");
  auto text = module.output("text", hc::string().in(hc::Coord::kText),
                            "the text, once it is certain, and when it changes");
  auto confidence =
      module.output("confidence", hc::table<double>(), "of each reading, certain or not, 0 to 1");
  auto target = module.output("target", hc::position<double>(),
                              "x, y, width of the lines [px], in the image's coordinate system");
  auto language = module.parameter("language", "eng", "", "Tesseract's name: eng, deu, eng+deu",
                                   {.fixed = true});
  auto upper_case = module.parameter(
      "upper_case", true, "", "nothing but capital letters, digits and - . , ! ?", {.fixed = true});
  auto least = module.parameter("confidence", 0.4, "", "minimum confidence of a text that is sent",
                                {.min = 0, .max = 1});
  auto repeat =
      module.parameter("repeat", 2, "", "of the last 2 repeat - 1 readings so many must agree",
                       {.min = 1, .max = 1000});
  auto again =
      module.parameter("again", 10.0, "s", "until an unchanged text is sent again, 0: never",
                       {.min = 0, .max = 1e6});
  auto rate = module.parameter("rate", 4.0, "Hz",
                               "maximum readings a second, 0: all; target is sent for every image",
                               {.min = 0, .max = 1000});
  auto score =
      module.parameter("score", 0.4, "", "minimum similarity of a line to one on a clean board",
                       {.min = 0, .max = 1});

  std::optional<Recogniser> recogniser;
  Announcer announcer;
  std::optional<std::int64_t> read_at;
  int texts = 0;
  std::string last;
  module.on_start(
      [&] { recogniser.emplace(hc::value_or_end(Recogniser::make(*language, *upper_case))); });

  /// Whether it is time to read again. By the images' times, as recordings are to give the same.
  auto is_due = [&](std::int64_t time) {
    if (*rate <= 0 || !read_at) return true;
    const auto since = time - *read_at;
    // Half a millisecond is what times of images that come evenly may differ by.
    return since < 0 || static_cast<double>(since) + 5e5 >= 1e9 / *rate;
  };

  module.on(image, [&](const hc::Message& message) {
    const cv::Mat pixels = hc::value_or_end(hc::as_mat(message));
    const auto block = hc::vision::block_of_best(hc::vision::find_text_lines(pixels, *score));
    if (block.empty()) return;
    if (target.linked()) {
      cv::Rect2f box = block.front().box();
      for (const auto& line : block) box |= line.box();
      const double x = box.x + box.width / 2, y = box.y + box.height / 2;
      target.send(hc::position<double>(x, y, box.width).in(message.header.coord));
    }
    const std::int64_t time = message.header.time != 0 ? message.header.time : module.now();
    const bool is_whole =
        std::all_of(block.begin(), block.end(), [](const auto& line) { return line.is_whole; });
    if (!is_whole || !is_due(time)) return;
    read_at = time;
    const auto reading = read_block(*recogniser, pixels, block, *upper_case);
    confidence.send(hc::table({reading.confidence}));
    if (announcer.take(reading.text, reading.confidence, time, {*least, *repeat, *again},
                       module.has_focus())) {
      ++texts;
      last = reading.text;
      text.send(hc::string(last));
    }
  });
  module.background();
  const int status = module.run(argc, argv);
  if (texts > 0)
    module.log("result: read " + std::to_string(texts) + (texts == 1 ? " text" : " texts") +
               ", the last \"" + last + "\"");
  return status;
}
