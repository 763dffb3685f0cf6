// SPDX-License-Identifier: Apache-2.0
#include <ros/decode.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include <ros/messages.h>

#include <hc/mtp/matrix_view.h>

namespace hc::ros {
namespace {

/// A stamp before 1970 counts as none.
hc::Time moment_of(const Time& stamp) {
  const std::chrono::seconds whole(stamp.sec);
  return std::max(hc::Time(), hc::Time(whole + std::chrono::nanoseconds(stamp.nanosec)));
}

Error malformed(std::string why) {
  return {Code::Malformed, std::move(why)};
}

/// An empty message of a port's type. Errors: TooLarge.
Result<Draft> draft_for(const PortType& port, std::uint64_t width, std::uint64_t height,
                        hc::Time time) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
  if (width > kMost || height > kMost)
    return Error{Code::TooLarge,
                 "matrix of " + std::to_string(width) + " x " + std::to_string(height)};
  Header header;
  header.info = port.info;
  header.width = static_cast<std::int32_t>(width);
  header.height = static_cast<std::int32_t>(height);
  header.time = time;
  HC_TRY(check(header));
  return Draft::make(header);
}

/// A table or pose from its numbers, row by row.
Result<Message> matrix_of(const PortType& port, std::uint64_t width, std::uint64_t height,
                          hc::Time time, std::span<const double> numbers) {
  auto draft = HC_TRY(draft_for(port, width, height, time));
  std::ranges::copy(numbers, view<double>(draft).numbers().begin());
  return std::move(draft).finish();
}

/// An unaligned number.
template <typename T>
T number_at(std::span<const std::byte> bytes, std::size_t at) {
  T number;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

/// The layout of a pixel.
struct Pixel {
  std::string_view encoding;
  std::size_t bytes, red, green, blue;
};
constexpr Pixel kPixels[] = {{"rgb8", 3, 0, 1, 2},
                             {"bgr8", 3, 2, 1, 0},
                             {"rgba8", 4, 0, 1, 2},
                             {"bgra8", 4, 2, 1, 0},
                             {"mono8", 1, 0, 0, 0}};

/// Checks the size of the pixel data.
Status check_rows(const Image& image, std::size_t pixel) {
  const std::uint64_t row = std::uint64_t{image.width} * pixel;
  if (image.step < row)
    return malformed("a row of " + std::to_string(image.width) + " pixels has a step of " +
                     std::to_string(image.step) + " bytes");
  if (std::uint64_t{image.step} * image.height > image.data.bytes.size())
    return malformed("expected " + std::to_string(image.height) + " rows of " +
                     std::to_string(image.step) + " bytes, got " +
                     std::to_string(image.data.bytes.size()) + " bytes");
  return {};
}

Error unknown_encoding(const Image& image, const char* known) {
  return {Code::Unsupported, "image encoding \"" + image.encoding.substr(0, 32) +
                                 "\" is not supported; " + known + " are"};
}

Result<Message> decode_colours(const Image& image, const PortType& port) {
  const auto* pixel = std::ranges::find(kPixels, image.encoding, &Pixel::encoding);
  if (pixel == std::end(kPixels))
    return unknown_encoding(image, "rgb8, bgr8, rgba8, bgra8 and mono8");
  HC_TRY(check_rows(image, pixel->bytes));
  auto draft = HC_TRY(draft_for(port, image.width, image.height, moment_of(image.header.stamp)));
  auto* to = reinterpret_cast<std::uint8_t*>(draft.elements().data());
  const bool is_grey = port.info.components == 1;
  for (std::size_t y = 0; y < image.height; ++y) {
    const auto* from =
        reinterpret_cast<const std::uint8_t*>(image.data.bytes.data()) + y * image.step;
    for (std::size_t x = 0; x < image.width; ++x, from += pixel->bytes) {
      const int red = from[pixel->red], green = from[pixel->green], blue = from[pixel->blue];
      if (is_grey) {  // ITU-R BT.601
        *to++ = static_cast<std::uint8_t>((299 * red + 587 * green + 114 * blue + 500) / 1000);
      } else {
        *to++ = static_cast<std::uint8_t>(red);
        *to++ = static_cast<std::uint8_t>(green);
        *to++ = static_cast<std::uint8_t>(blue);
      }
    }
  }
  return std::move(draft).finish();
}

Result<Message> decode_depth(const Image& image, const PortType& port) {
  const bool is_metres = image.encoding == "32FC1";
  if (!is_metres && image.encoding != "16UC1") return unknown_encoding(image, "32FC1 and 16UC1");
  if (image.is_bigendian != 0) return Error{Code::Unsupported, "big-endian numbers"};
  const std::size_t size = is_metres ? sizeof(float) : sizeof(std::uint16_t);
  HC_TRY(check_rows(image, size));
  auto draft = HC_TRY(draft_for(port, image.width, image.height, moment_of(image.header.stamp)));
  auto to = view<float>(draft).numbers().begin();
  for (std::size_t y = 0; y < image.height; ++y)
    for (std::size_t x = 0; x < image.width; ++x) {
      const std::size_t at = y * image.step + x * size;
      constexpr float kMetre = 1000;  // [mm]
      const float depth =
          is_metres ? number_at<float>(image.data.bytes, at)
                    : static_cast<float>(number_at<std::uint16_t>(image.data.bytes, at)) / kMetre;
      *to++ = std::isfinite(depth) ? depth : 0;
    }
  return std::move(draft).finish();
}

Result<Message> convert(const Image& image, const PortType& port, const Choice&) {
  if (port.info.scalar == Scalar::F32) return decode_depth(image, port);
  return decode_colours(image, port);
}

/// Width and height of a JPEG image, from its frame header (ITU-T T.81, B.2.2).
std::optional<std::pair<std::uint32_t, std::uint32_t>> size_of_jpeg(
    std::span<const std::byte> bytes) {
  auto byte = [&](std::size_t at) { return std::to_integer<std::uint32_t>(bytes[at]); };
  auto word = [&](std::size_t at) { return byte(at) << 8 | byte(at + 1); };
  if (bytes.size() < 2 || word(0) != 0xFFD8) return std::nullopt;
  constexpr std::size_t kFrame = 9;  // marker, length, precision, height, width
  for (std::size_t at = 2; at + kFrame <= bytes.size(); at += 2 + word(at + 2)) {
    while (byte(at) == 0xFF && byte(at + 1) == 0xFF && at + kFrame < bytes.size()) ++at;
    if (byte(at) != 0xFF) return std::nullopt;
    const std::uint32_t marker = byte(at + 1);
    const bool is_frame =
        marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (is_frame) return std::pair{word(at + 7), word(at + 5)};
  }
  return std::nullopt;
}

Result<Message> convert(const CompressedImage& image, const PortType& port, const Choice&) {
  const auto size = size_of_jpeg(image.data.bytes);
  if (!size)
    return Error{Code::Unsupported,
                 "compressed image of format \"" + image.format.substr(0, 32) + "\" is not JPEG"};
  Message message;
  message.header.info = port.info;
  message.header.info.encoding = Encoding::Jpeg;
  message.header.width = static_cast<std::int32_t>(size->first);
  message.header.height = static_cast<std::int32_t>(size->second);
  message.header.time = moment_of(image.header.stamp);
  HC_TRY(check(message.header));
  message.elements = image.data.bytes;
  return message.keep();
}

Result<Message> convert(const PointCloud2& cloud, const PortType& port, const Choice&) {
  if (cloud.is_bigendian) return Error{Code::Unsupported, "big-endian numbers"};
  struct Place {
    std::uint32_t offset = 0;
    bool is_double = false;
  };
  std::array<Place, 3> places;
  constexpr std::string_view kNames[] = {"x", "y", "z"};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto field = std::ranges::find(cloud.fields, kNames[i], &PointField::name);
    const bool is_float = field != cloud.fields.end() && (field->datatype == PointField::kFloat32 ||
                                                          field->datatype == PointField::kFloat64);
    if (!is_float)
      return Error{Code::Unsupported,
                   "points have no " + std::string(kNames[i]) + " of float32 or float64"};
    const bool is_double = field->datatype == PointField::kFloat64;
    if (std::uint64_t{field->offset} + (is_double ? 8 : 4) > cloud.point_step)
      return malformed("field " + std::string(kNames[i]) + " exceeds the point's " +
                       std::to_string(cloud.point_step) + " bytes");
    places[i] = {field->offset, is_double};
  }
  if (std::uint64_t{cloud.width} * cloud.point_step > cloud.row_step && cloud.height > 1)
    return malformed("a row of " + std::to_string(cloud.width) + " points has a step of " +
                     std::to_string(cloud.row_step) + " bytes");
  // The last row need not be padded, and some writers do not set row_step of a single row.
  const std::uint64_t row = std::uint64_t{cloud.width} * cloud.point_step;
  const std::uint64_t all =
      cloud.height == 0 ? 0 : (cloud.height - std::uint64_t{1}) * cloud.row_step + row;
  if (all > cloud.data.bytes.size())
    return malformed("expected " + std::to_string(cloud.height) + " x " +
                     std::to_string(cloud.width) + " points, got " +
                     std::to_string(cloud.data.bytes.size()) + " bytes");
  auto draft = HC_TRY(draft_for(port, cloud.width, cloud.height, moment_of(cloud.header.stamp)));
  auto to = view<float>(draft).numbers().begin();
  for (std::size_t y = 0; y < cloud.height; ++y)
    for (std::size_t x = 0; x < cloud.width; ++x)
      for (const auto& [offset, is_double] : places) {
        const std::size_t at = y * cloud.row_step + x * cloud.point_step + offset;
        *to++ = is_double ? static_cast<float>(number_at<double>(cloud.data.bytes, at))
                          : number_at<float>(cloud.data.bytes, at);
      }
  return std::move(draft).finish();
}

Result<Message> convert(const CameraInfo& camera, const PortType& port, const Choice&) {
  const auto& p = camera.p;
  if (!(p[0] > 0)) return malformed("matrix P has no focal length: calibrate the camera");
  const double numbers[] = {p[0], p[5], p[2], p[6], -p[3] / p[0]};
  return matrix_of(port, 5, 1, moment_of(camera.header.stamp), numbers);
}

Result<Message> matrix_of(const PortType& port, const Pose& pose, hc::Time time) {
  const auto& [p, q] = pose;
  const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  constexpr double kTolerance = 0.01;
  if (!(std::abs(rotation.norm() - 1) < kTolerance))
    return malformed("orientation is not a unit quaternion");
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
    return malformed("position is not finite");
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation.normalized().toRotationMatrix();
  T.translation() = Eigen::Vector3d(p.x, p.y, p.z);
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> rows = T.matrix();
  return matrix_of(port, 4, 4, time, {rows.data(), 16});
}

Result<Message> convert(const PoseStamped& pose, const PortType& port, const Choice&) {
  return matrix_of(port, pose.pose, moment_of(pose.header.stamp));
}

Result<Message> convert(const TfMessage& message, const PortType& port, const Choice& choice) {
  // The last transform is the newest.
  const auto newest = std::find_if(
      message.transforms.rbegin(), message.transforms.rend(),
      [&](const TransformStamped& each) { return each.child_frame_id == choice.child; });
  if (newest != message.transforms.rend())
    return matrix_of(port, newest->transform, moment_of(newest->header.stamp));
  return Error{Code::NotFound, "no frame \"" + choice.child + "\" in the message"};
}

Result<Message> convert(const Twist& twist, const PortType& port, const Choice&) {
  const auto& [linear, angular] = twist;
  const double numbers[] = {linear.x, linear.y, linear.z, angular.x, angular.y, angular.z};
  return matrix_of(port, 6, 1, {}, numbers);
}

Result<Message> convert(const JointState& state, const PortType& port, const Choice& choice) {
  const std::size_t count = state.name.size();
  for (const auto* list : {&state.position, &state.velocity, &state.effort})
    if (!list->empty() && list->size() != count)
      return malformed("expected values of " + std::to_string(count) + " joints, got " +
                       std::to_string(list->size()));
  std::vector<std::size_t> order;
  for (const auto& name : choice.joints) {
    const auto found = std::ranges::find(state.name, name);
    if (found == state.name.end())
      return Error{Code::NotFound, "no joint \"" + name + "\" in the message"};
    order.push_back(static_cast<std::size_t>(found - state.name.begin()));
  }
  if (choice.joints.empty())
    for (std::size_t i = 0; i < count; ++i) order.push_back(i);
  const std::size_t rows = !state.effort.empty() ? 3 : !state.velocity.empty() ? 2 : 1;
  std::vector<double> numbers;
  for (const auto* list : {&state.position, &state.velocity, &state.effort}) {
    if (numbers.size() == rows * order.size()) break;
    for (const auto joint : order)
      numbers.push_back(list->empty() ? std::numeric_limits<double>::quiet_NaN() : (*list)[joint]);
  }
  return matrix_of(port, order.size(), rows, moment_of(state.header.stamp), numbers);
}

Result<Message> convert(const String& string, const PortType& port, const Choice&) {
  auto draft = HC_TRY(draft_for(port, string.data.text.size(), 1, {}));
  std::ranges::copy(std::as_bytes(std::span(string.data.text)), draft.elements().begin());
  return std::move(draft).finish();
}

Result<Message> convert(const MultiArray<double>& array, const PortType& port, const Choice&) {
  const std::uint64_t all = array.data.bytes.size() / sizeof(double);
  if (array.data_offset > all)
    return malformed("data begin at " + std::to_string(array.data_offset) + " of " +
                     std::to_string(all) + " numbers");
  const std::uint64_t count = all - array.data_offset;
  std::uint64_t width = count, height = 1;
  if (array.dim.size() == 2 || array.dim.size() == 3) {
    height = array.dim[0].size;
    width = array.dim[1].size;
    if (array.dim.size() == 3) width *= array.dim[2].size;  // below 2^64
    const bool fits = height == 0 ? count == 0 : count % height == 0 && count / height == width;
    if (!fits)
      return malformed("expected " + std::to_string(height) + " x " + std::to_string(width) +
                       " numbers, got " + std::to_string(count));
  }
  auto draft = HC_TRY(draft_for(port, width, height, {}));
  const auto from = array.data.bytes.subspan(array.data_offset * sizeof(double));
  std::ranges::copy(from, draft.elements().begin());
  return std::move(draft).finish();
}

template <typename T>
Result<Message> read_as(std::span<const std::byte> bytes, const PortType& port,
                        const Choice& choice) {
  auto message = HC_TRY(CdrReader::read<T>(bytes));
  return convert(message, port, choice);
}

}  // namespace

Result<Message> decode(Type type, std::span<const std::byte> bytes, const PortType& port,
                       const Choice& choice) {
  const auto matrix = port.info.type;
  const Scalar scalar = port.info.scalar;
  const bool is_image = matrix == MatrixType::IntensityImage ||
                        (matrix == MatrixType::RgbImage && port.info.components == 3);
  const bool is_table =
      matrix == MatrixType::Table && scalar == Scalar::F64 && port.info.components == 1;
  const bool is_pose = matrix == MatrixType::Transformation && scalar == Scalar::F64;
  if (type == Type::Image && is_image &&
      (scalar == Scalar::U8 || (scalar == Scalar::F32 && matrix == MatrixType::IntensityImage)))
    return read_as<Image>(bytes, port, choice);
  if (type == Type::CompressedImage && is_image && scalar == Scalar::U8)
    return read_as<CompressedImage>(bytes, port, choice);
  if (type == Type::PointCloud2 && matrix == MatrixType::Position && scalar == Scalar::F32 &&
      port.info.components == 3)
    return read_as<PointCloud2>(bytes, port, choice);
  if (type == Type::CameraInfo && is_table) return read_as<CameraInfo>(bytes, port, choice);
  if (type == Type::PoseStamped && is_pose) return read_as<PoseStamped>(bytes, port, choice);
  if (type == Type::TfMessage && is_pose) return read_as<TfMessage>(bytes, port, choice);
  if (type == Type::Twist && is_table) return read_as<Twist>(bytes, port, choice);
  if (type == Type::JointState && is_table) return read_as<JointState>(bytes, port, choice);
  if (type == Type::String && matrix == MatrixType::String)
    return read_as<String>(bytes, port, choice);
  if (type == Type::Float64MultiArray && is_table)
    return read_as<MultiArray<double>>(bytes, port, choice);
  return Error{Code::Unsupported, schema(type).name + " does not convert to " + in_words(port)};
}

}  // namespace hc::ros
