// SPDX-License-Identifier: Apache-2.0
// The blob of a colour.
#include <cmath>
#include <optional>

#include <hc/base/format.h>
#include <hc/module/module.h>
#include <vision/blob.h>
#include <vision/messages.h>

int main(int argc, char** argv) {
  hc::Module module{
      "blob",
      "Finds the blob of a colour in images, and follows it: round, large, near the last one."};
  auto image = module.input("image", hc::rgb_image<std::uint8_t>(), "images");
  auto point = module.input("point", hc::position<double>().of(1, 1),
                            "x, y in the next image [px]: its colour is searched from then on, "
                            "until the parameter hue changes");
  auto target = module.output("target", hc::position<double>(),
                              "x, y of the blob's middle, its radius [px], in the coordinate "
                              "system of the image; nothing while there is none");
  auto area = module.output("area", hc::table<double>(), "area of the blob [px²]");
  auto hue = module.parameter("hue", 0.0, "", "0 red, 0.33 green, 0.67 blue", {.min = 0, .max = 1});
  auto hue_width = module.parameter("hue_width", 0.05, "", "maximum difference of a pixel's hue",
                                    {.min = 0, .max = 0.5});
  auto saturation = module.parameter("saturation", 0.5, "", "minimum saturation of a pixel",
                                     {.min = 0, .max = 1});
  auto value = module.parameter("value", 0.2, "", "minimum value of a pixel", {.min = 0, .max = 1});
  auto min_area =
      module.parameter("min_area", 60.0, "px²", "minimum area of a blob", {.min = 0, .max = 1e9});

  std::optional<hc::vision::BlobFinder> finder;
  std::optional<cv::Point2d> pointed;           // at the next image
  std::optional<hc::vision::BlobColour> taken;  // by pointing
  double hue_then = 0;                          // when it was taken
  auto take = [&](const cv::Mat& pixels) {
    const cv::Point at(static_cast<int>(std::lround(pointed->x)),
                       static_cast<int>(std::lround(pointed->y)));
    pointed.reset();
    if (!cv::Rect(0, 0, pixels.cols, pixels.rows).contains(at))
      return module.log("point: outside the image");
    auto colour = hc::vision::colour_at(pixels, at);
    if (!colour) return module.log(hc::format("point: no colour at {}, {}", at.x, at.y));
    colour->hue_width = *hue_width;
    taken = colour;
    hue_then = *hue;
    module.log(hc::format("point: hue {:.3f}, saturation {:.2f} and value {:.2f} at least",
                          colour->hue, colour->min_saturation, colour->min_value));
  };
  module.on(point, [&](const auto& message) {
    constexpr double kFar = 1e6;
    const auto numbers = message.numbers();
    if (!(std::abs(numbers[0]) < kFar) || !(std::abs(numbers[1]) < kFar))
      return module.log("point: outside the image");
    pointed = {numbers[0], numbers[1]};
  });
  // Once, and only while none was ever found: the light or the parameters are not right.
  int misses = 0, images = 0, seen = 0;
  auto warn = [&](const cv::Mat& pixels) {
    constexpr int kMany = 40;
    if (misses < 0 || ++misses < kMany) return;
    misses = -1;
    const auto faint = finder->find_faint(pixels, *min_area);
    if (!faint) return;
    const auto& wanted = finder->colour();
    char line[240];
    std::snprintf(
        line, sizeof line,
        "no blob in %d images: what is of hue %.2f has a mean saturation of %.2f and a mean "
        "value of %.2f, and must have %.2f and %.2f; raise the camera's exposure, or lower "
        "the parameters saturation or value",
        kMany, wanted.hue, faint->min_saturation, faint->min_value, wanted.min_saturation,
        wanted.min_value);
    module.log(line);
  };
  module.on(image, [&](const auto& message) {
    const cv::Mat pixels = hc::as_mat(message);
    if (pointed) take(pixels);
    if (taken && *hue != hue_then) taken.reset();
    const auto colour =
        taken.value_or(hc::vision::BlobColour{*hue, *hue_width, *saturation, *value});
    if (!finder || !(finder->colour() == colour)) finder.emplace(colour);
    const auto blob = finder->find(pixels, *min_area);
    ++images;
    if (!blob) return warn(pixels);
    misses = -1;
    ++seen;
    target.send(hc::position(blob->x, blob->y, blob->radius).in(message.header.coord));
    area.send(hc::table({blob->area}));
  });
  const int status = module.run(argc, argv);
  constexpr int kFew = 20;  // images that a person looks at
  if (images > kFew)
    module.log("result: saw its target in " + std::to_string(seen) + " of " +
               std::to_string(images) + " images");
  return status;
}
