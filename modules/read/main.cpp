// SPDX-License-Identifier: Apache-2.0
// Reads text in images, and locates it.
#include <hc/module/module.h>
#include <transports/all.h>
#include <vision/messages.h>

#include "announcer.h"
#include "block.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{
      "read", "Reads lines of letters on an even ground, as on a board.", {.background = true}};
  auto image = module.input("image", hc::image(), "image with letters, or a word cropped from one");
  auto text = module.output("text", hc::string().in(hc::Coord::kText),
                            "the text, once it is certain, and when it changes");
  auto confidence =
      module.output("confidence", hc::table(), "of each reading, certain or not, 0 to 1",
                    {.columns = {"confidence"}});
  auto target =
      module.output("target", hc::position(), "the lines, in the image's coordinate system",
                    {.columns = {"x [px]", "y [px]", "width [px]"}});
  auto language = module.parameter("language", "eng", "", "Tesseract's name: eng, deu, eng+deu",
                                   {.fixed = true});
  auto upper_case = module.parameter("upper_case", true, "",
                                     "only capital letters, digits and - . , ! ?", {.fixed = true});
  auto least = module.parameter("confidence", 0.4, "", "minimum confidence of a text that is sent",
                                {.min = 0, .max = 1});
  auto repeat =
      module.parameter("repeat", 2, "", "readings that must agree among the last 2 repeat - 1",
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

  std::optional<BlockReader> reader;
  Announcer announcer;
  module.on_start(
      [&] { reader.emplace(hc::value_or_end(BlockReader::make(*language, *upper_case))); });
  module.on(image, [&](const hc::Message& message) {
    const cv::Mat pixels = hc::value_or_drop(hc::as_mat(message));
    const auto block = BlockReader::find(pixels, *score);
    if (block.empty()) return;
    const auto box = hc::vision::box_of(block);
    target.send({box.x + box.width / 2, box.y + box.height / 2, box.width}, {},
                message.header.coord);
    const hc::Time time = module.time_of(message.header);
    const auto reading = reader->read_when_due(pixels, block, time, *rate);
    if (!reading) return;
    confidence.send(reading->confidence);
    if (announcer.take(reading->text, reading->confidence, time, {*least, *repeat, *again},
                       module.has_focus()))
      text.send(reading->text);
  });
  const int status = module.run(argc, argv);
  if (const auto summary = announcer.summary(); !summary.empty())
    module.log(summary, hc::Level::Result);
  return status;
}
