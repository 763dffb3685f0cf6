// SPDX-License-Identifier: Apache-2.0
#include <ros/encode.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <hc/compress/compress.h>
#include <hc/contract/description.h>
#include <hc/mtp/coords.h>
#include <hc/mtp/matrix_view.h>
#include <ros/type_for.h>

namespace hc::ros {
namespace {

using namespace std::chrono_literals;

Error unfit(Type type, const Message& message) {
  const Header& header = message.header;
  return {Code::Unsupported, "no " + schema(type).name + " can be made of " +
                                 matrix_text(header.info, header.width, header.height) + ", " +
                                 std::string(name(header.info.encoding))};
}

Stamp stamp_of(const Encoder& encoder, const Message& message, std::int32_t coord) {
  return {time_of(message.header.time), encoder.frame_id(coord)};
}

/// The numbers of an uncompressed message.
std::vector<double> numbers_of(const Message& message) {
  return visit_scalar(message.header.info.scalar, [&](auto zero) {
    const auto numbers = view<decltype(zero)>(message)->numbers();
    std::vector<double> all(numbers.size());
    std::ranges::transform(numbers, all.begin(),
                           [](auto each) { return static_cast<double>(each); });
    return all;
  });
}

std::int16_t sample_of(auto sample) {
  using T = decltype(sample);
  if constexpr (std::is_floating_point_v<T>) {
    constexpr double kMost = std::numeric_limits<std::int16_t>::max();
    const double level = std::isnan(sample) ? 0 : std::clamp(static_cast<double>(sample), -1., 1.);
    return static_cast<std::int16_t>(std::lround(level * kMost));
  } else {
    constexpr int kBits = static_cast<int>(sizeof(T)) * 8;
    using Unsigned = std::make_unsigned_t<T>;
    auto bits = static_cast<std::uint64_t>(static_cast<Unsigned>(sample));
    if constexpr (std::is_unsigned_v<T>) bits ^= std::uint64_t{1} << (kBits - 1);
    bits = kBits <= 16 ? bits << (16 - std::min(kBits, 16)) : bits >> (std::max(kBits, 16) - 16);
    return static_cast<std::int16_t>(bits);
  }
}

/// The sample rate of a coordinate system [Hz]; 0: none.
std::uint32_t sample_rate(std::int32_t coord) {
  constexpr std::uint32_t kRates[] = {8000, 16000, 22050, 44100, 48000};
  if (coord < Coord::kSound8k || coord > Coord::kSound48k) return 0;
  return kRates[coord - Coord::kSound8k];
}

Quaternion to_quaternion(const Eigen::Quaterniond& rotation) {
  return {rotation.x(), rotation.y(), rotation.z(), rotation.w()};
}

template <typename T>
Pieces write_array(CdrWriter& writer, const Message& message) {
  const Header& header = message.header;
  const auto width = static_cast<std::uint32_t>(header.width);
  const std::uint32_t components = header.info.components, row = width * components;
  const auto height = static_cast<std::uint32_t>(header.height);
  return writer.write(MultiArray<T>{{{"height", height, height * row},
                                     {"width", width, row},
                                     {"components", components, components}},
                                    0,
                                    {message.elements}});
}

/// Position and rotation of a 4 × 4 matrix in row-major order.
Pose pose_of(std::span<const double> n) {
  Eigen::Matrix3d rotation;
  rotation << n[0], n[1], n[2], n[4], n[5], n[6], n[8], n[9], n[10];
  return {{n[3], n[7], n[11]}, to_quaternion(Eigen::Quaterniond(rotation).normalized())};
}

}  // namespace

Time time_of(hc::Time time) {
  const auto since = time.time_since_epoch();
  return {static_cast<std::int32_t>(since / 1s), static_cast<std::uint32_t>((since % 1s).count())};
}

std::string Encoder::frame_id(std::int32_t coord) const {
  switch (coord) {
    case Coord::kLeftImage:
    case Coord::kLeftRectified:
    case Coord::kDepth:
    case Coord::kDisparity:
      return frame_id(Coord::kLeftEye);
    case Coord::kRightImage:
    case Coord::kRightRectified:
    case Coord::kRightDepth:
      return frame_id(Coord::kRightEye);
    default:
      break;
  }
  if (coord == 0) return "";
  if (const auto found = frames.find(coord); found != frames.end()) return found->second;
  const Coord* known = find_coord(coord);
  return known != nullptr ? std::string(known->name) : std::to_string(coord);
}

Result<Pieces> Encoder::encode(Type type, const Message& message) {
  const Info& info = message.header.info;
  if (type == Type::CompressedImage) {
    if (info.encoding != Encoding::Jpeg) return unfit(type, message);
    return writer_.write(CompressedImage{
        stamp_of(*this, message, message.header.coord), "jpeg", {message.elements}});
  }
  if (type == Type::Matrix) return encode_matrix(message);
  if (!message.plain()) return unfit(type, message);
  if (type <= Type::Float64MultiArray) {
    if (static_cast<Type>(info.scalar) != type) return unfit(type, message);
    return visit_scalar(info.scalar, [&](auto zero) -> Result<Pieces> {
      return write_array<decltype(zero)>(writer_, message);
    });
  }
  switch (type) {
    case Type::Image:
      return encode_image(message);
    case Type::PointCloud2:
      return encode_points(message);
    case Type::PoseStamped:
      return encode_pose(message);
    case Type::Twist:
      return encode_twist(message);
    case Type::JointState:
      return encode_joints(message);
    case Type::CameraInfo:
      return encode_camera(message);
    case Type::String:
      return encode_text(message);
    case Type::RawAudio:
      return encode_sound(message);
    default:
      return unfit(type, message);
  }
}

Result<Pieces> Encoder::encode_any(Type type, const Message& message) {
  const bool is_jpeg = message.header.info.encoding == Encoding::Jpeg;
  if (type == Type::Matrix || (type == Type::CompressedImage && is_jpeg))
    return encode(type, message);
  auto made = expand(message);
  if (made && type == Type::CompressedImage) made = compress(*made, Encoding::Jpeg);
  if (!made) return made.error();
  made_ = std::move(*made);
  return encode(type, made_);
}

Result<Pieces> Encoder::encode_image(const Message& message) {
  const Header& header = message.header;
  const bool is_image =
      header.info.type == MatrixType::RgbImage || header.info.type == MatrixType::IntensityImage;
  const auto encoding = is_image ? pixel_encoding(header.info, header.coord) : "";
  if (encoding.empty()) return unfit(Type::Image, message);
  return writer_.write(
      Image{stamp_of(*this, message, header.coord),
            static_cast<std::uint32_t>(header.height),
            static_cast<std::uint32_t>(header.width),
            std::string(encoding),
            0,
            static_cast<std::uint32_t>(header.row_numbers() * size_of(header.info.scalar)),
            {message.elements}});
}

Result<Pieces> Encoder::encode_points(const Message& message) {
  const Header& header = message.header;
  const Info& info = header.info;
  const bool is_field = info.type == MatrixType::VectorField;
  const bool is_float = info.scalar == Scalar::F32 || info.scalar == Scalar::F64;
  if (!is_float || (info.type != MatrixType::Position && !is_field) || info.components % 3 != 0 ||
      info.components > 9)
    return unfit(Type::PointCloud2, message);
  constexpr const char* kNames[] = {"x", "y", "z", "vx", "vy", "vz", "ax", "ay", "az"};
  constexpr const char* kColoured[] = {"x", "y", "z", "r", "g", "b", "nx", "ny", "nz"};
  const auto size = static_cast<std::uint32_t>(size_of(info.scalar));
  std::vector<PointField> fields;
  for (std::uint32_t i = 0; i < info.components; ++i)
    fields.push_back({is_field ? kColoured[i] : kNames[i], i * size,
                      size == 4 ? PointField::kFloat32 : PointField::kFloat64, 1});
  const auto step = static_cast<std::uint32_t>(info.element_bytes());
  const auto width = static_cast<std::uint32_t>(header.width);
  return writer_.write(PointCloud2{stamp_of(*this, message, header.coord),
                                   static_cast<std::uint32_t>(header.height),
                                   width,
                                   std::move(fields),
                                   false,
                                   step,
                                   step * width,
                                   {message.elements},
                                   false});
}

Result<Pieces> Encoder::encode_pose(const Message& message) {
  const Header& header = message.header;
  PoseStamped pose{stamp_of(*this, message, header.coord), {}};
  const bool is_matrix = header.info.type == MatrixType::Transformation;
  const std::int32_t side = is_matrix ? 4 : 1;
  if (header.width != side || header.height != side) return unfit(Type::PoseStamped, message);
  const auto n = numbers_of(message);
  auto& [position, orientation] = pose.pose;
  if (is_matrix) {
    pose.header.frame_id = frame_id(header.coord / 1000);
    pose.pose = pose_of(n);
  } else if (header.info.type == MatrixType::Position) {
    position = {n[0], n[1], n[2]};
  } else if (header.info.type == MatrixType::Rotation) {
    using Eigen::AngleAxisd;
    using Eigen::Vector3d;
    orientation = to_quaternion(Eigen::Quaterniond(AngleAxisd(n[2], Vector3d::UnitZ()) *
                                                   AngleAxisd(n[1], Vector3d::UnitY()) *
                                                   AngleAxisd(n[0], Vector3d::UnitX())));
  } else {
    return unfit(Type::PoseStamped, message);
  }
  return writer_.write(pose);
}

Result<Pieces> Encoder::encode_twist(const Message& message) {
  constexpr std::uint64_t kNumbers = 6;
  if (message.header.row_numbers() * static_cast<std::uint64_t>(message.header.height) != kNumbers)
    return unfit(Type::Twist, message);
  const auto n = numbers_of(message);
  return writer_.write(Twist{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
}

Result<Pieces> Encoder::encode_joints(const Message& message) {
  const Header& header = message.header;
  const bool is_table = header.info.type == MatrixType::Table && !joints.empty() &&
                        header.row_numbers() == joints.size() && header.height >= 1 &&
                        header.height <= 3;
  if (header.info.type != MatrixType::Rotation && !is_table)
    return unfit(Type::JointState, message);
  JointState state{stamp_of(*this, message, 0), {}, {}, {}, {}};
  const auto n = numbers_of(message);
  if (is_table) {
    state.name = joints;
    std::vector<double>* const rows[] = {&state.position, &state.velocity, &state.effort};
    for (std::size_t i = 0; i < n.size(); ++i) rows[i / joints.size()]->push_back(n[i]);
    return writer_.write(state);
  }
  const std::size_t step = header.info.components;
  for (std::size_t i = 0; i < n.size() / step; ++i) {
    const std::string number = i == 0 ? "" : "_" + std::to_string(i);
    for (std::size_t k = 0; k < 3; ++k) {
      constexpr const char* kNames[] = {"roll", "tilt", "pan"};
      state.name.push_back(kNames[k] + number);
      state.position.push_back(n[i * step + k]);
      if (step > 3) state.velocity.push_back(n[i * step + 3 + k]);
    }
  }
  return writer_.write(state);
}

Result<Pieces> Encoder::encode_camera(const Message& message) {
  const Header& header = message.header;
  if (header.info.type != MatrixType::Table || header.width != 5 || header.height != 1 ||
      header.info.components != 1)
    return unfit(Type::CameraInfo, message);
  const auto n = numbers_of(message);  // fx, fy, cx, cy [px], baseline [m]
  CameraInfo camera;
  camera.header = stamp_of(*this, message, Coord::kLeftRectified);
  camera.height = camera_height;
  camera.width = camera_width;
  camera.distortion_model = "plumb_bob";
  camera.d.assign(5, 0.0);
  camera.k = {n[0], 0, n[2], 0, n[1], n[3], 0, 0, 1};
  camera.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  camera.p = {n[0], 0, n[2], 0, 0, n[1], n[3], 0, 0, 0, 1, 0};
  return writer_.write(camera);
}

Result<Pieces> Encoder::encode_text(const Message& message) {
  if (message.header.info.type != MatrixType::String) return unfit(Type::String, message);
  std::string_view text = message.text();
  if (message.header.height > 1 && !message.header.empty()) {  // R32
    const auto width = static_cast<std::size_t>(message.header.width);
    text_.clear();
    for (; !text.empty(); text.remove_prefix(width)) {
      auto row = text.substr(0, width);
      row = row.substr(0, row.find_last_not_of(' ') + 1);
      text_.append(text_.empty() && text.size() == message.elements.size() ? "" : "\n").append(row);
    }
    text = text_;
  }
  return writer_.write(String{{text}});
}

Result<Pieces> Encoder::encode_sound(const Message& message) {
  const Header& header = message.header;
  if (header.info.type != MatrixType::Sound) return unfit(Type::RawAudio, message);
  auto samples = message.elements;
  if (header.info.scalar != Scalar::I16) {
    samples_.clear();
    visit_scalar(header.info.scalar, [&](auto zero) {
      for (const auto each : view<decltype(zero)>(message)->numbers()) {
        const auto bytes = std::bit_cast<std::array<std::byte, 2>>(sample_of(each));
        samples_.insert(samples_.end(), bytes.begin(), bytes.end());
      }
    });
    samples = samples_;
  }
  return writer_.write(RawAudio{time_of(header.time),
                                {samples},
                                "pcm-s16",
                                sample_rate(header.coord),
                                header.info.components});
}

Pieces Encoder::encode(std::span<const Joint> list) {
  TfMessage message;
  for (const auto& [parent, child, t, r, time] : list)
    message.transforms.push_back(
        {{time_of(time), parent}, child, {{t[0], t[1], t[2]}, {r[0], r[1], r[2], r[3]}}});
  return writer_.write(message);
}

Pieces Encoder::encode_log(hc::Time time, const LogLine& line) {
  Log log;
  log.stamp = time_of(time);
  log.name = line.module;
  log.level = line.level == Level::Error     ? Log::kError
              : line.level == Level::Warning ? Log::kWarning
                                             : Log::kInfo;
  log.msg = line.text;
  return writer_.write(log);
}

Pieces Encoder::encode_matrix(const Message& message, std::uint32_t offset) {
  Matrix matrix{text(message.header), offset, 0, {}};
  if (offset > 0)
    matrix.size = static_cast<std::uint32_t>(message.elements.size());
  else
    matrix.elements.bytes = message.elements;
  return writer_.write(matrix);
}

}  // namespace hc::ros
