// SPDX-License-Identifier: Apache-2.0
#include <drivers/aravis/aravis.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <span>
#include <string_view>
#include <vector>

#include <arv.h>
#include <drivers/aravis/pixels.h>

namespace hc::aravis {
namespace {

constexpr int kBuffers = 8;
constexpr std::chrono::milliseconds kSilence{1000};
constexpr std::chrono::milliseconds kForEver = std::chrono::hours(24 * 365 * 100);
constexpr std::chrono::milliseconds kBeginning{2000};  // additional time for the first image
// A camera's time that differs more is of another clock.
constexpr std::chrono::seconds kMostAge{10};

/// Guards Aravis' global lists of cameras.
std::mutex& search_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// Owns a GError.
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
    return {code, error_ != nullptr ? error_->message : "unknown error of Aravis"};
  }
  [[nodiscard]] Status status() const { return error_ != nullptr ? Status(error()) : Status(); }
  template <typename T>
  [[nodiscard]] Result<T> or_error(const T& value) const {
    return error_ != nullptr ? Result<T>(error()) : Result<T>(value);
  }

 private:
  GError* error_ = nullptr;
};

/// Sets the requested pixel format, or one that to_bgr() supports.
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
                 "pixel format " + wanted + " is not one of Mono8, RGB8, BGR8, 8-bit Bayer"};
  guint count = 0;
  gint64* all = arv_camera_dup_available_pixel_formats(camera, &count, failure.out());
  if (failure) return failure.error();
  const std::vector<gint64> formats(all, all + count);
  g_free(all);
  // Prefers colour to grey, then fewer bytes.
  for (auto like :
       {PixelFormat::BayerRG8, PixelFormat::BayerBG8, PixelFormat::BayerGR8, PixelFormat::BayerGB8,
        PixelFormat::Rgb8, PixelFormat::Bgr8, PixelFormat::Mono8})
    for (gint64 format : formats) {
      if (format != static_cast<gint64>(like)) continue;
      arv_camera_set_pixel_format(camera, static_cast<ArvPixelFormat>(format), failure.out());
      if (!failure) return {};
    }
  return Error{Code::Unsupported, "supports none of Mono8, RGB8, BGR8, 8-bit Bayer"};
}

/// The flag is shared, since Aravis may set it while its camera is being released.
using Flag = std::shared_ptr<std::atomic<bool>>;

void note_loss(ArvDevice*, Flag* is_lost) {
  **is_lost = true;
}

void forget_flag(gpointer flag, GClosure*) {
  delete static_cast<Flag*>(flag);
}

/// Sets the frame rate. Returns how long the camera may be silent; unlimited if triggered.
std::chrono::milliseconds choose_rate(ArvCamera* camera, double rate) {
  Failure ignored;  // many cameras lack these features
  const char* trigger = arv_camera_is_feature_available(camera, "TriggerMode", ignored.out())
                            ? arv_camera_get_string(camera, "TriggerMode", ignored.out())
                            : nullptr;
  if (trigger != nullptr && std::string_view(trigger) == "On") return kForEver;
  if (arv_camera_is_frame_rate_available(camera, ignored.out())) {
    if (rate > 0) arv_camera_set_frame_rate(camera, rate, ignored.out());
    const double native = arv_camera_get_frame_rate(camera, ignored.out());
    if (!ignored && native > 0) rate = native;
  }
  if (!(rate > 0)) return kSilence;
  return kSilence + std::chrono::milliseconds(std::llround(std::min(2 / rate, 1e6) * 1e3));
}

}  // namespace

struct Camera::Handles {
  ArvCamera* camera = nullptr;
  ArvStream* stream = nullptr;
  Flag is_lost = std::make_shared<std::atomic<bool>>(false);  // set on Aravis' thread
  gulong handler = 0;                                         // signal handler that sets it
  std::chrono::milliseconds timeout = kSilence;               // in addition to the exposure
  std::chrono::steady_clock::time_point heard = std::chrono::steady_clock::now();
  double exposure = 0;  // last set [s]

  Handles() = default;
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;
  ~Handles() {
    const std::lock_guard lock(search_mutex());
    if (camera != nullptr) {
      if (handler != 0) g_signal_handler_disconnect(arv_camera_get_device(camera), handler);
      if (!*is_lost && stream != nullptr) {
        Failure ignored;  // the camera may be disconnected
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
                                             const std::string& pixel_format, double rate) {
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
  handles->handler =
      g_signal_connect_data(arv_camera_get_device(camera), "control-lost", G_CALLBACK(note_loss),
                            new Flag(handles->is_lost), forget_flag, static_cast<GConnectFlags>(0));
  HC_TRY(choose_format(camera, pixel_format));
  arv_camera_set_acquisition_mode(camera, ARV_ACQUISITION_MODE_CONTINUOUS, failure.out());
  if (failure) return failure.error();
  handles->timeout = choose_rate(camera, rate);
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

Result<std::optional<Image>> Camera::next(std::chrono::milliseconds timeout) {
  auto& all = *handles_;
  if (*all.is_lost) return Error{Code::Closed, "connection lost"};
  ArvBuffer* buffer = arv_stream_timeout_pop_buffer(
      all.stream, static_cast<guint64>(std::chrono::microseconds(timeout).count()));
  const auto now = std::chrono::steady_clock::now();
  const bool is_whole =
      buffer != nullptr && arv_buffer_get_status(buffer) == ARV_BUFFER_STATUS_SUCCESS;
  if (!is_whole) {
    if (buffer != nullptr) arv_stream_push_buffer(all.stream, buffer);
    const auto exposure = std::chrono::milliseconds(std::llround(all.exposure * 1e3));
    if (*all.is_lost) return Error{Code::Closed, "connection lost"};
    if (now - all.heard - exposure > all.timeout) {
      *all.is_lost = true;
      return Error{Code::Closed, "no image received"};
    }
    return std::optional<Image>();
  }
  all.heard = now;
  std::size_t bytes = 0;
  const auto* data = static_cast<const std::byte*>(arv_buffer_get_data(buffer, &bytes));
  int padding = 0, ignored = 0;
  arv_buffer_get_image_padding(buffer, &padding, &ignored);
  auto bgr = to_bgr(static_cast<std::uint32_t>(arv_buffer_get_image_pixel_format(buffer)),
                    arv_buffer_get_image_width(buffer), arv_buffer_get_image_height(buffer),
                    std::span(data, bytes), padding);
  const auto came = unix_time(static_cast<std::int64_t>(arv_buffer_get_system_timestamp(buffer)));
  arv_stream_push_buffer(all.stream, buffer);
  if (!bgr) return bgr.error();
  const Time wall = std::chrono::system_clock::now();
  const bool is_sensible = came > wall - kMostAge && came <= wall;
  return std::optional<Image>(Image{*bgr, is_sensible ? came : wall});
}

Status Camera::set_exposure(double exposure) {
  ArvCamera* camera = handles_->camera;
  Failure failure;
  if (arv_camera_is_exposure_auto_available(camera, failure.out()))
    arv_camera_set_exposure_time_auto(camera, ARV_AUTO_OFF, failure.out());
  if (!arv_camera_is_exposure_time_available(camera, failure.out()))
    return Error{Code::Unsupported, "the exposure cannot be set"};
  double least = 0, most = 0;
  arv_camera_get_exposure_time_bounds(camera, &least, &most, failure.out());
  if (failure) return failure.error();
  if (exposure * 1e6 < least || exposure * 1e6 > most)
    return Error{Code::Unsupported, "exposure must be from " + std::to_string(least * 1e-6) +
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
    return Error{Code::Unsupported, "the gain cannot be set"};
  double least = 0, most = 0;
  arv_camera_get_gain_bounds(camera, &least, &most, failure.out());
  if (failure) return failure.error();
  if (gain < least || gain > most)
    return Error{Code::Unsupported,
                 "gain must be from " + std::to_string(least) + " to " + std::to_string(most)};
  arv_camera_set_gain(camera, gain, failure.out());
  return failure.status();
}

Status Camera::choose_exposure() {
  Failure failure;
  if (arv_camera_is_exposure_auto_available(handles_->camera, failure.out()))
    arv_camera_set_exposure_time_auto(handles_->camera, ARV_AUTO_CONTINUOUS, failure.out());
  return failure.status();
}

Status Camera::choose_gain() {
  Failure failure;
  if (arv_camera_is_gain_auto_available(handles_->camera, failure.out()))
    arv_camera_set_gain_auto(handles_->camera, ARV_AUTO_CONTINUOUS, failure.out());
  return failure.status();
}

Result<double> Camera::exposure() const {
  Failure failure;
  const double microseconds = arv_camera_get_exposure_time(handles_->camera, failure.out());
  return failure.or_error(microseconds * 1e-6);
}

Result<double> Camera::gain() const {
  Failure failure;
  const double gain = arv_camera_get_gain(handles_->camera, failure.out());
  return failure.or_error(gain);
}

Result<bool> Camera::chooses_exposure() const {
  Failure failure;
  const ArvAuto mode = arv_camera_get_exposure_time_auto(handles_->camera, failure.out());
  return failure.or_error(mode == ARV_AUTO_CONTINUOUS);
}

Result<bool> Camera::chooses_gain() const {
  Failure failure;
  const ArvAuto mode = arv_camera_get_gain_auto(handles_->camera, failure.out());
  return failure.or_error(mode == ARV_AUTO_CONTINUOUS);
}

}  // namespace hc::aravis
