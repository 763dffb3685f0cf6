// SPDX-License-Identifier: Apache-2.0
// Tracks a blob of a given colour.
#include <optional>

#include <hc/base/format.h>
#include <hc/module/module.h>
#include <transports/all.h>
#include <vision/messages.h>

#include "search.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{
      "blob",
      "Finds the blob of a colour in images, and follows it: round, large, near the last one."};
  auto image = module.input("image", hc::rgb_image(), "images");
  auto point = module.input(
      "point", hc::position().of(1, 1),
      "x, y in the next image of its coordinate system [px]: its colour is searched from then on, "
      "until the parameter hue changes");
  auto target = module.output("target", hc::position(),
                              "the blob's middle and its radius, in the coordinate system of the "
                              "image; nothing while there is none",
                              {.columns = {"x [px]", "y [px]", "radius [px]"}});
  auto area = module.output("area", hc::table(), "of the blob", {.columns = {"area [px²]"}});
  auto hue = module.parameter("hue", 0.0, "", "0 red, 0.33 green, 0.67 blue", {.min = 0, .max = 1});
  auto hue_width = module.parameter("hue_width", 0.05, "", "maximum difference of a pixel's hue",
                                    {.min = 0, .max = 0.5});
  auto saturation = module.parameter("saturation", 0.5, "", "minimum saturation of a pixel",
                                     {.min = 0, .max = 1});
  auto value = module.parameter("value", 0.2, "", "minimum value of a pixel", {.min = 0, .max = 1});
  auto min_area =
      module.parameter("min_area", 60.0, "px²", "minimum area of a blob", {.min = 0, .max = 1e9});

  Search search{[&](std::string_view line) { module.log(line); }};
  std::optional<hc::MessageOf<hc::PositionKind<double>>> pointed;
  module.on(point, [&](const auto& message) { pointed = message; });
  module.on(image, [&](const auto& message) {
    const auto coord = message.header.coord;
    if (pointed && (coord == 0 || pointed->header.coord == 0 || pointed->header.coord == coord)) {
      search.point(pointed->numbers()[0], pointed->numbers()[1]);
      pointed.reset();
    } else if (pointed) {
      module.log_once("point in another image",
                      hc::format("point: in coordinate system {}, but the image in {}",
                                 pointed->header.coord, coord));
    }
    const auto blob =
        search.look(hc::as_mat(message), {*hue, *hue_width, *saturation, *value}, *min_area);
    if (!blob) return;
    target.send({blob->x, blob->y, blob->radius}, {}, message.header.coord);
    area.send(blob->area);
  });
  const int status = module.run(argc, argv);
  if (const auto summary = search.summary(); !summary.empty())
    module.log(summary, hc::Level::Result);
  return status;
}
