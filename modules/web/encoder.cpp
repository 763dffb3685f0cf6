// SPDX-License-Identifier: Apache-2.0
#include "encoder.h"

#include <vpx/vp8cx.h>
#include <vpx/vpx_encoder.h>

#include <algorithm>
#include <cstring>

#include <hc/module/kind.h>
#include <vision/messages.h>
#include <opencv2/imgproc.hpp>

namespace {

using hc::MatrixType;

bool is_picture_type(MatrixType type) {
  return type == MatrixType::RgbImage || type == MatrixType::IntensityImage;
}

/// Every n-th element of every n-th row.
hc::Message sampled(const hc::Message& message, int step) {
  hc::Header header = message.header;
  header.info.encoding = hc::Encoding::Binary;
  header.width = (header.width + step - 1) / step;
  header.height = (header.height + step - 1) / step;
  auto draft = hc::Draft::make(header);
  const std::size_t size = header.info.element_bytes(), n = static_cast<std::size_t>(step);
  const auto width = static_cast<std::size_t>(message.header.width);
  std::byte* to = draft.elements().data();
  for (std::size_t y = 0; y < static_cast<std::size_t>(message.header.height); y += n)
    for (std::size_t x = 0; x < width; x += n, to += size)
      std::memcpy(to, message.elements.data() + (y * width + x) * size, size);
  return std::move(draft).finish();
}

}  // namespace

bool is_picture(const hc::Header& header) {
  return is_picture_type(header.info.type) && header.info.scalar == hc::Scalar::U8 &&
         !header.empty();
}

hc::Result<hc::Message> scaled(const hc::Message& message, int width) {
  const auto& header = message.header;
  const bool has_places = is_picture_type(header.info.type) ||
                          header.info.type == MatrixType::VectorField ||
                          header.info.type == MatrixType::Map;
  if (!has_places || width <= 0 || header.width <= width || !message.plain()) return message;
  if (!is_picture(header)) return sampled(message, (header.width + width - 1) / width);
  auto whole = hc::as_mat(message);
  if (!whole) return whole.error();
  hc::Header small = header;
  small.info.encoding = hc::Encoding::Binary;
  small.width = width;
  small.height = std::max(1, static_cast<int>(std::int64_t{header.height} * width / header.width));
  auto draft = hc::Draft::make(small);
  cv::Mat to(small.height, small.width, whole->type(), draft.elements().data());
  cv::resize(*whole, to, to.size(), 0, 0, cv::INTER_AREA);
  return std::move(draft).finish();
}

struct Vp8Encoder::Codec {
  vpx_codec_ctx_t context{};
  vpx_image_t image{};
  cv::Size size;
  std::int64_t frames = 0;
  cv::Mat planes;  // Y, then U and V: I420

  Codec() = default;
  Codec(const Codec&) = delete;
  Codec& operator=(const Codec&) = delete;
  ~Codec() { close(); }
  void close() {
    if (!size.empty()) vpx_codec_destroy(&context);
    size = {};
  }

  hc::Status open(const cv::Size& wanted) {
    close();
    vpx_codec_enc_cfg_t settings;
    if (vpx_codec_enc_config_default(vpx_codec_vp8_cx(), &settings, 0) != VPX_CODEC_OK)
      return hc::Error{hc::Code::System, "VP8: no default settings"};
    settings.g_w = static_cast<unsigned>(wanted.width);
    settings.g_h = static_cast<unsigned>(wanted.height);
    settings.g_timebase = {1, 1000};
    settings.g_threads = 1;
    settings.g_lag_in_frames = 0;
    settings.rc_end_usage = VPX_CBR;
    // 0.15 bit per pixel at 20 Hz is hardly distinguishable from the original.
    settings.rc_target_bitrate = static_cast<unsigned>(wanted.area() * 20.0 * 0.15 / 1000) + 100;
    settings.rc_max_quantizer = 40;
    settings.kf_mode = VPX_KF_DISABLED;  // key frames only on request
    if (vpx_codec_enc_init(&context, vpx_codec_vp8_cx(), &settings, 0) != VPX_CODEC_OK)
      return hc::Error{hc::Code::System, std::string("VP8: ") + vpx_codec_error(&context)};
    size = wanted;
    constexpr int kFastest = -10;  // of -16 … 16: fast, with good quality
    vpx_codec_control(&context, VP8E_SET_CPUUSED, kFastest);
    return {};
  }
};

Vp8Encoder::Vp8Encoder() : codec_(std::make_unique<Codec>()) {}
Vp8Encoder::~Vp8Encoder() = default;

hc::Result<hc::Message> Vp8Encoder::encode(const hc::Message& message, bool is_key) {
  auto pixels = hc::as_mat(message);
  if (!pixels) return pixels.error();
  const cv::Size size(pixels->cols & ~1, pixels->rows & ~1);
  if (size.empty())
    return hc::Error{hc::Code::Unsupported, "VP8 takes images of at least 2 x 2 pixels"};
  Codec& codec = *codec_;
  if (size != codec.size) {
    if (auto opened = codec.open(size); !opened) return opened.error();
    is_key = true;
  }
  cv::Mat colours = (*pixels)(cv::Rect({}, size));
  if (colours.channels() == 1) cv::cvtColor(colours, colours, cv::COLOR_GRAY2RGB);
  cv::cvtColor(colours, codec.planes,
               colours.channels() == 4 ? cv::COLOR_RGBA2YUV_I420 : cv::COLOR_RGB2YUV_I420);
  vpx_img_wrap(&codec.image, VPX_IMG_FMT_I420, static_cast<unsigned>(size.width),
               static_cast<unsigned>(size.height), 1, codec.planes.data);
  constexpr int kPeriod = 50;  // assumed by the rate control [ms]
  if (vpx_codec_encode(&codec.context, &codec.image, codec.frames++ * kPeriod, kPeriod,
                       is_key ? VPX_EFLAG_FORCE_KF : 0, VPX_DL_REALTIME) != VPX_CODEC_OK)
    return hc::Error{hc::Code::System, std::string("VP8: ") + vpx_codec_error(&codec.context)};
  vpx_codec_iter_t place = nullptr;
  while (const vpx_codec_cx_pkt_t* packet = vpx_codec_get_cx_data(&codec.context, &place)) {
    if (packet->kind != VPX_CODEC_CX_FRAME_PKT) continue;
    const auto& frame = packet->data.frame;
    hc::Message coded =
        hc::table<std::uint8_t>().message(std::span(static_cast<const std::uint8_t*>(frame.buf), frame.sz));
    const auto info = coded.header.info;
    const auto width = coded.header.width;
    coded.header = message.header;
    coded.header.info = info;
    coded.header.width = width;
    coded.header.height = 1;
    return coded;
  }
  return hc::Error{hc::Code::System, "VP8: no frame came out"};
}

bool is_key_frame(const hc::Message& vp8) {
  return !vp8.elements.empty() && (std::to_integer<unsigned>(vp8.elements[0]) & 1) == 0;
}
