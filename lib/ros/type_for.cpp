// SPDX-License-Identifier: Apache-2.0
#include <ros/type_for.h>

#include <algorithm>
#include <iterator>

#include <hc/mtp/coords.h>

namespace hc::ros {
namespace {

bool is_metric(std::int32_t coord) {
  const Coord* known = find_coord(coord);
  return known != nullptr ? known->is_frame : coord >= 100 && coord < 1000;
}

}  // namespace

std::string_view pixel_encoding(const Info& info, std::int32_t coord) {
  struct Names {
    Scalar scalar;
    std::string_view grey, measure, rgb, rgba;
  };
  constexpr Names kNames[] = {{Scalar::U8, "mono8", "8UC1", "rgb8", "rgba8"},
                              {Scalar::I8, "8SC1", "8SC1", "", ""},
                              {Scalar::U16, "mono16", "16UC1", "rgb16", "rgba16"},
                              {Scalar::I16, "16SC1", "16SC1", "", ""},
                              {Scalar::I32, "32SC1", "32SC1", "", ""},
                              {Scalar::F32, "32FC1", "32FC1", "32FC3", "32FC4"},
                              {Scalar::F64, "64FC1", "64FC1", "64FC3", "64FC4"}};
  const auto* names = std::ranges::find(kNames, info.scalar, &Names::scalar);
  if (names == std::end(kNames)) return "";
  if (info.type == MatrixType::RgbImage) return info.components == 4 ? names->rgba : names->rgb;
  const bool is_measure =
      coord == Coord::kDepth || coord == Coord::kRightDepth || coord == Coord::kDisparity;
  return is_measure ? names->measure : names->grey;
}

std::optional<Type> type_for(const PortType& port) {
  const Info& info = port.info;
  if (info.encoding == Encoding::Jpeg) return Type::CompressedImage;
  if (info.encoding == Encoding::Zstd) return std::nullopt;
  const bool one = port.width == 1 && port.height == 1;
  const bool maybe_one = port.width <= 1 && port.height <= 1;
  const bool floats = info.scalar == Scalar::F32 || info.scalar == Scalar::F64;
  const auto array = static_cast<Type>(info.scalar);
  switch (info.type) {
    case MatrixType::RgbImage:
    case MatrixType::IntensityImage:
      return pixel_encoding(info, port.coord).empty() ? array : Type::Image;
    case MatrixType::Position:
      return one && info.components == 3 ? Type::PoseStamped : Type::PointCloud2;
    case MatrixType::VectorField:
      return floats && (info.components == 3 || info.components == 6) && is_metric(port.coord)
                 ? Type::PointCloud2
                 : array;
    case MatrixType::Rotation:
      if (port.coord == Coord::kGaze) return Type::JointState;
      return maybe_one ? Type::PoseStamped : array;
    case MatrixType::Transformation:
      return port.width == 4 && port.height == 4 ? Type::PoseStamped : array;
    case MatrixType::String:
      return Type::String;
    case MatrixType::Sound:
      return Type::RawAudio;
    case MatrixType::Table:
      return info.scalar == Scalar::F64 && info.components == 1 && port.width == 5 &&
                     port.height == 1 && port.coord == Coord::kLeftRectified
                 ? Type::CameraInfo
                 : array;
    default:
      return array;
  }
}

std::optional<Type> type_for(const PortDescription& output, bool jpeg) {
  if (output.types.size() != 1) return std::nullopt;
  PortType type = output.types.front();
  const auto& info = type.info;
  if (info.encoding == Encoding::Zstd) type.info.encoding = Encoding::Binary;
  const bool is_picture =
      (info.type == MatrixType::RgbImage || info.type == MatrixType::IntensityImage) &&
      info.scalar == Scalar::U8 && info.components != 4;
  if (is_picture && jpeg) type.info.encoding = Encoding::Jpeg;
  return type_for(type);
}

std::optional<Type> type_for(const Header& header) {
  return type_for(PortType{header.info, header.width, header.height, header.coord, false});
}

}  // namespace hc::ros
