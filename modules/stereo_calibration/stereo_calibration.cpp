// SPDX-License-Identifier: Apache-2.0
#include "stereo_calibration.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <hc/base/format.h>
#include <hc/os/new_file.h>
#include <hc/os/program.h>
#include <vision/board_print.h>
#include <vision/messages.h>

namespace {

using hc::vision::BoardKind;

const char* advice_for(BoardKind kind) {
  switch (kind) {
    case BoardKind::Chessboard:
      return "is it complete, with a white margin? columns and rows count inner corners";
    case BoardKind::Charuco:
      return "is it of this dictionary? columns and rows count squares";
    default:
      return "are its tags of the family 36h11, and tag 0 at the lower left? columns and rows "
             "count tags";
  }
}

}  // namespace

hc::vision::Board StereoCalibrationParameters::sought_board() const {
  hc::vision::Board sought{static_cast<int>(*columns), static_cast<int>(*rows), *square};
  sought.kind = *board == "charuco"     ? BoardKind::Charuco
                : *board == "aprilgrid" ? BoardKind::AprilGrid
                                        : BoardKind::Chessboard;
  sought.marker = *marker_size;
  sought.spacing = *tag_spacing;
  return sought;
}

StereoCalibration::StereoCalibration(hc::Module& module) : module_(module) {
  module.on_start([this] { start(); });
  module.on(hc::together(left_, right_),
            [this](const hc::Message& left, const hc::Message& right) { look(left, right); });
  module.on_end([this] {
    if (views_ && !hc::stop_requested()) finish(hc::value_or_end(views_->calibrate()));
  });
}

void StereoCalibration::start() {
  if (!parameters_.print->empty()) return draw_board();
  views_.emplace(hc::value_or_end(hc::vision::BoardViews::make(
      parameters_.sought_board(), static_cast<std::size_t>(*parameters_.views),
      *parameters_.dictionary)));
  const auto& file = parameters_.calibration_file;
  // A file that is not a calibration is not to be overwritten after all views have been taken.
  if (std::filesystem::is_regular_file(*file) && !std::filesystem::is_empty(*file)) {
    auto read = hc::vision::read_calibration(*file);
    if (!read) hc::refuse(file, read.error().detail + "; remove it or name another file");
    calibration_ = *read;
  }
}

void StereoCalibration::draw_board() const {
  const auto& file = *parameters_.print;
  const auto print =
      hc::value_or_end(hc::vision::print_of(parameters_.sought_board(), *parameters_.dictionary));
  if (const auto drawn = hc::replace_file(file, hc::vision::pdf_of(print)); !drawn)
    hc::refuse(parameters_.print, drawn.error().detail);
  module_.log(hc::format("{}: {:.0f} x {:.0f} mm, to be printed without scaling", file,
                         1000 * print.paper.width, 1000 * print.paper.height));
  module_.stop();
}

void StereoCalibration::look(const hc::Message& left, const hc::Message& right) {
  if (!views_) return;
  const cv::Mat image = hc::value_or_drop(hc::as_mat(left));
  const bool is_kept = hc::value_or_drop(
      views_->take(image, hc::value_or_drop(hc::as_mat(right)), *parameters_.difference));
  show(image);
  constexpr std::size_t kPatience = 50;  // pairs
  if (views_->pairs() == kPatience && views_->found() == 0)
    module_.log(hc::format("no {} in {} pairs: {}", views_->board().text(), kPatience,
                           advice_for(views_->board().kind)));
  if (!is_kept) return;
  time_ = std::max(left.header.time, right.header.time);
  view_.send({static_cast<double>(views_->size()), static_cast<double>(*parameters_.views)});
  advice_.send(views_->advice());
  ++untried_;
  constexpr std::int64_t kMore = 5;  // views after a refused calibration
  if (untried_ >= (was_refused_ ? kMore : *parameters_.views)) try_to_finish();
}

void StereoCalibration::try_to_finish() {
  const auto calibrated = views_->calibrate();
  if (calibrated) return finish(*calibrated);
  was_refused_ = true;
  untried_ = 0;
  module_.log(calibrated.error().detail + "; taking more views");
}

void StereoCalibration::finish(const hc::vision::Calibrated& calibrated) {
  const auto& file = *parameters_.calibration_file;
  score_.send(calibrated.numbers(), time_);
  module_.log(calibrated.text() + ": " + file);
  if (may_write(calibrated))
    hc::succeed_or_end(hc::vision::write_calibration(file, calibrated.calibration));
  views_.reset();
}

bool StereoCalibration::may_write(const hc::vision::Calibrated& calibrated) const {
  const auto& file = *parameters_.calibration_file;
  if (!*parameters_.replace && hc::vision::has_changed(file, calibration_)) {
    module_.log(file +
                " is kept: another program has written it since the start; replace = true "
                "replaces it");
    return false;
  }
  if (!calibration_ || calibration_->rms == 0) return true;  // rms 0: by calibrate, not measured
  const double error = views_->error_of(*calibration_);
  constexpr double kFits = 1.5;  // times the error of the new one
  if (error > kFits * views_->error_of(calibrated.calibration)) {
    module_.log(
        hc::format("{} is replaced: its error for these views is {:.2f} px (focal length "
                   "{:.1f} px, baseline {:.4f} m)",
                   file, error, calibration_->M1(0, 0), calibration_->baseline()));
    return true;
  }
  const double known = calibration_->focal_deviation, found = calibrated.deviations.focal;
  if (*parameters_.replace || known > found) return true;
  module_.log(hc::format(
      "{} is kept: it fits these views too, and {}; replace = true replaces it", file,
      known > 0 ? hc::format("its focal length is known to {:.2f} %, from these views to {:.2f} %",
                             100 * known, 100 * found)
                : "does not say how well its views determine it"));
  return false;
}

void StereoCalibration::show(const cv::Mat& left) {
  if (!picture_.linked()) return;
  auto draft = picture_.loan(left.rows, left.cols);
  hc::fill(draft, views_->picture(left));
  picture_.send(std::move(draft));
}
