// SPDX-License-Identifier: Apache-2.0
#include <drivers/aravis/aravis.h>

#include <atomic>
#include <cmath>
#include <mutex>
#include <span>
#include <vector>

#include <arv.h>
#include <drivers/aravis/pixels.h>

namespace hc::aravis {
namespace {

constexpr int kBuffers = 8;
constexpr std::chrono::milliseconds kSilence{1000};
constexpr std::chrono::milliseconds kBeginning{2000};  // so much more until the first picture
// A camera's time that is further from ours is by another clock.
constexpr std::int64_t kMostAge = 10'000'000'000;  // [ns]

/// Looking for cameras works on lists that all have in common.
std::mutex& search_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// Takes an error of GLib's, and gives it free.
class Failure {
 public:
  Failure() = default;
  Failure(const Failure&) = delete;
  Failure& operator=(const Failure&) = delete;
  ~Failure() { g_clear_error(&error_); }
  GError** out() {
    g_clear_error(&error_);
    return &error_;
  }
  explicit operator bool() const { return error_ != nullptr; }
  [[nodiscard]] Error error(Code code = Code::System) const {
    return {code, error_ != nullptr ? error_->message : "Aravis gives no reason"};
  }

 private:
  GError* error_ = nullptr;
};

std::int64_t wall_clock() {
  return g_get_real_time() * 1000;
}

/// Has the camera give pixels that we can read.
Status choose_format(ArvCamera* camera, const std::string& wanted) {
  Failure failure;
  if (!wanted.empty()) {
    arv_camera_set_pixel_format_from_string(camera, wanted.c_str(), failure.out());
    if (failure) return failure.error(Code::Unsupported);
  }
  const auto now = static_cast<std::uint32_t>(arv_camera_get_pixel_format(camera, failure.out()));
  if (failure) return failure.error();
  if (is_known(now)) return {};
  if (!wanted.empty())
    return Error{Code::Unsupported,
                 "pixel format " + wanted + " is none of Mono8, RGB8, BGR8 and 8-bit Bayer"};
  guint count = 0;
  gint64* all = arv_camera_dup_available_pixel_formats(camera, &count, failure.out());
  if (failure) return failure.error();
  const std::vector<gint64> formats(all, all + count);
  g_free(all);
  // Colours rather than grey, and fewer bytes rather than more.
  for (auto like :
       {PixelFormat::BayerRG8, PixelFormat::BayerBG8, PixelFormat::BayerGR8, PixelFormat::BayerGB8,
        PixelFormat::Rgb8, PixelFormat::Bgr8, PixelFormat::Mono8})
    for (gint64 format : formats) {
      if (format != static_cast<gint64>(like)) continue;
      arv_camera_set_pixel_format(camera, static_cast<ArvPixelFormat>(format), failure.out());
      if (!failure) return {};
    }
  return Error{Code::Unsupported, "has none of Mono8, RGB8, BGR8 and 8-bit Bayer"};
}

void note_loss(ArvGvDevice*, std::atomic<bool>* is_lost) {
  *is_lost = true;
}

}  // namespace

struct Camera::Handles {
  ArvCamera* camera = nullptr;
  ArvStream* stream = nullptr;
  std::atomic<bool> is_lost = false;  // set on Aravis' thread
  std::chrono::steady_clock::time_point heard = std::chrono::steady_clock::now();
  double exposure = 0;  // as we have set it [s]

  Handles() = default;
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;
  ~Handles() {
    const std::lock_guard lock(search_mutex());
    if (camera != nullptr) {
      g_signal_handlers_disconnect_by_data(arv_camera_get_device(camera), &is_lost);
      if (!is_lost && stream != nullptr) {
        Failure ignored;  // it may be gone
        arv_camera_stop_acquisition(camera, ignored.out());
      }
    }
    if (stream != nullptr) g_object_unref(stream);
    if (camera != nullptr) g_object_unref(camera);
  }
};

Camera::Camera(std::unique_ptr<Handles> handles) : handles_(std::move(handles)) {}
Camera::~Camera() = default;

Result<std::unique_ptr<Camera>> Camera::open(const std::string& name,
                                             const std::string& pixel_format) {
  auto handles = std::make_unique<Handles>();
  Failure failure;
  {
    const std::lock_guard lock(search_mutex());
    if (name.starts_with("Fake_")) arv_enable_interface("Fake");
    handles->camera = arv_camera_new(name.empty() ? nullptr : name.c_str(), failure.out());
    if (failure || handles->camera == nullptr) {
      if (handles->camera != nullptr) g_object_unref(handles->camera);
      handles->camera = nullptr;
      return failure ? failure.error(Code::NotFound)
                     : Error{Code::NotFound, name.empty() ? "no camera" : "no such camera"};
    }
  }
  ArvCamera* camera = handles->camera;
  g_signal_connect(arv_camera_get_device(camera), "control-lost", G_CALLBACK(note_loss),
                   &handles->is_lost);
  if (auto chosen = choose_format(camera, pixel_format); !chosen) return chosen.error();
  arv_camera_set_acquisition_mode(camera, ARV_ACQUISITION_MODE_CONTINUOUS, failure.out());
  if (failure) return failure.error();
  handles->stream = arv_camera_create_stream(camera, nullptr, nullptr, failure.out());
  if (failure || handles->stream == nullptr) return failure.error();
  const auto bytes = arv_camera_get_payload(camera, failure.out());
  if (failure) return failure.error();
  for (int i = 0; i < kBuffers; ++i)
    arv_stream_push_buffer(handles->stream, arv_buffer_new_allocate(bytes));
  arv_camera_start_acquisition(camera, failure.out());
  if (failure) return failure.error();
  handles->heard = std::chrono::steady_clock::now() + kBeginning;
  return std::unique_ptr<Camera>(new Camera(std::move(handles)));
}

Result<std::optional<Picture>> Camera::next(std::chrono::milliseconds timeout) {
  auto& all = *handles_;
  if (all.is_lost) return Error{Code::Closed, "it has gone"};
  ArvBuffer* buffer = arv_stream_timeout_pop_buffer(
      all.stream, static_cast<guint64>(std::chrono::microseconds(timeout).count()));
  const auto now = std::chrono::steady_clock::now();
  const bool is_whole =
      buffer != nullptr && arv_buffer_get_status(buffer) == ARV_BUFFER_STATUS_SUCCESS;
  if (!is_whole) {
    if (buffer != nullptr) arv_stream_push_buffer(all.stream, buffer);
    const auto patience = kSilence + std::chrono::milliseconds(std::llround(all.exposure * 1e3));
    if (all.is_lost) return Error{Code::Closed, "it has gone"};
    if (now - all.heard > patience) {
      all.is_lost = true;
      return Error{Code::Closed, "it is silent"};
    }
    return std::optional<Picture>();
  }
  all.heard = now;
  std::size_t bytes = 0;
  const auto* data = static_cast<const std::byte*>(arv_buffer_get_data(buffer, &bytes));
  auto bgr = to_bgr(static_cast<std::uint32_t>(arv_buffer_get_image_pixel_format(buffer)),
                    arv_buffer_get_image_width(buffer), arv_buffer_get_image_height(buffer),
                    std::span(data, bytes));
  const auto came = static_cast<std::int64_t>(arv_buffer_get_system_timestamp(buffer));
  arv_stream_push_buffer(all.stream, buffer);
  if (!bgr) return bgr.error();
  const std::int64_t wall = wall_clock();
  const bool is_sensible = came > wall - kMostAge && came <= wall;
  return std::optional<Picture>(Picture{*bgr, is_sensible ? came : wall});
}

Status Camera::set_exposure(double exposure) {
  ArvCamera* camera = handles_->camera;
  Failure failure;
  if (arv_camera_is_exposure_auto_available(camera, failure.out()))
    arv_camera_set_exposure_time_auto(camera, ARV_AUTO_OFF, failure.out());
  if (!arv_camera_is_exposure_time_available(camera, failure.out()))
    return Error{Code::Unsupported, "has no exposure to set"};
  double least = 0, most = 0;
  arv_camera_get_exposure_time_bounds(camera, &least, &most, failure.out());
  if (failure) return failure.error();
  if (exposure * 1e6 < least || exposure * 1e6 > most)
    return Error{Code::Unsupported, "its exposure is from " + std::to_string(least * 1e-6) +
                                        " to " + std::to_string(most * 1e-6) + " s"};
  arv_camera_set_exposure_time(camera, exposure * 1e6, failure.out());
  if (failure) return failure.error();
  handles_->exposure = exposure;
  return {};
}

Status Camera::set_gain(double gain) {
  ArvCamera* camera = handles_->camera;
  Failure failure;
  if (arv_camera_is_gain_auto_available(camera, failure.out()))
    arv_camera_set_gain_auto(camera, ARV_AUTO_OFF, failure.out());
  if (!arv_camera_is_gain_available(camera, failure.out()))
    return Error{Code::Unsupported, "has no gain to set"};
  double least = 0, most = 0;
  arv_camera_get_gain_bounds(camera, &least, &most, failure.out());
  if (failure) return failure.error();
  if (gain < least || gain > most)
    return Error{Code::Unsupported,
                 "its gain is from " + std::to_string(least) + " to " + std::to_string(most)};
  arv_camera_set_gain(camera, gain, failure.out());
  if (failure) return failure.error();
  return {};
}

Status Camera::choose_exposure() {
  Failure failure;
  if (arv_camera_is_exposure_auto_available(handles_->camera, failure.out()))
    arv_camera_set_exposure_time_auto(handles_->camera, ARV_AUTO_CONTINUOUS, failure.out());
  if (failure) return failure.error();
  return {};
}

Status Camera::choose_gain() {
  Failure failure;
  if (arv_camera_is_gain_auto_available(handles_->camera, failure.out()))
    arv_camera_set_gain_auto(handles_->camera, ARV_AUTO_CONTINUOUS, failure.out());
  if (failure) return failure.error();
  return {};
}

Result<double> Camera::exposure() const {
  Failure failure;
  const double microseconds = arv_camera_get_exposure_time(handles_->camera, failure.out());
  if (failure) return failure.error();
  return microseconds * 1e-6;
}

Result<double> Camera::gain() const {
  Failure failure;
  const double gain = arv_camera_get_gain(handles_->camera, failure.out());
  if (failure) return failure.error();
  return gain;
}

Result<bool> Camera::chooses_exposure() const {
  Failure failure;
  const ArvAuto mode = arv_camera_get_exposure_time_auto(handles_->camera, failure.out());
  if (failure) return failure.error();
  return mode == ARV_AUTO_CONTINUOUS;
}

Result<bool> Camera::chooses_gain() const {
  Failure failure;
  const ArvAuto mode = arv_camera_get_gain_auto(handles_->camera, failure.out());
  if (failure) return failure.error();
  return mode == ARV_AUTO_CONTINUOUS;
}

}  // namespace hc::aravis
