// SPDX-License-Identifier: Apache-2.0
#include <ros/schema.h>

#include <algorithm>
#include <set>
#include <vector>

#include <hc/base/check.h>

namespace hc::ros {
namespace {

/// A definition, without those of its parts.
struct Definition {
  std::string_view name;  ///< such as "sensor_msgs/Image"
  std::string_view text;
};

/// Types that occur only as parts of others.
constexpr Definition kParts[] = {
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    {"std_msgs/MultiArrayDimension", "string label\nuint32 size\nuint32 stride\n"},
    {"std_msgs/MultiArrayLayout", "std_msgs/MultiArrayDimension[] dim\nuint32 data_offset\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"},
    {"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    {"geometry_msgs/Transform",
     "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
    {"sensor_msgs/PointField",
     "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\n"
     "uint8 FLOAT32=7\nuint8 FLOAT64=8\n"
     "string name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
    {"sensor_msgs/RegionOfInterest",
     "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n"},
};

/// In the order of Type.
constexpr Definition kTypes[] = {
    {"std_msgs/UInt8MultiArray", "std_msgs/MultiArrayLayout layout\nuint8[] data\n"},
    {"std_msgs/Int8MultiArray", "std_msgs/MultiArrayLayout layout\nint8[] data\n"},
    {"std_msgs/UInt16MultiArray", "std_msgs/MultiArrayLayout layout\nuint16[] data\n"},
    {"std_msgs/Int16MultiArray", "std_msgs/MultiArrayLayout layout\nint16[] data\n"},
    {"std_msgs/UInt32MultiArray", "std_msgs/MultiArrayLayout layout\nuint32[] data\n"},
    {"std_msgs/Int32MultiArray", "std_msgs/MultiArrayLayout layout\nint32[] data\n"},
    {"std_msgs/UInt64MultiArray", "std_msgs/MultiArrayLayout layout\nuint64[] data\n"},
    {"std_msgs/Int64MultiArray", "std_msgs/MultiArrayLayout layout\nint64[] data\n"},
    {"std_msgs/Float32MultiArray", "std_msgs/MultiArrayLayout layout\nfloat32[] data\n"},
    {"std_msgs/Float64MultiArray", "std_msgs/MultiArrayLayout layout\nfloat64[] data\n"},
    {"sensor_msgs/Image",
     "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\n"
     "uint32 step\nuint8[] data\n"},
    {"sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"},
    {"sensor_msgs/PointCloud2",
     "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n"
     "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"},
    {"sensor_msgs/CameraInfo",
     "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] d\n"
     "float64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\nuint32 binning_y\n"
     "sensor_msgs/RegionOfInterest roi\n"},
    {"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
    {"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
    {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    {"sensor_msgs/JointState",
     "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
     "float64[] effort\n"},
    {"std_msgs/String", "string data\n"},
    {"foxglove_msgs/RawAudio",
     "builtin_interfaces/Time timestamp\nuint8[] data\nstring format\nuint32 sample_rate\n"
     "uint32 number_of_channels\n"},
    {"rcl_interfaces/Log",
     "byte DEBUG=10\nbyte INFO=20\nbyte WARN=30\nbyte ERROR=40\nbyte FATAL=50\n"
     "builtin_interfaces/Time stamp\nuint8 level\nstring name\nstring msg\nstring file\n"
     "string function\nuint32 line\n"},
    {"hypercolumn_msgs/Matrix",
     "# A message of MTP/1. Its header line, without the line end:\nstring header\n"
     "# Where its elements are in the message of the same sequence on the topic beside; 0: here.\n"
     "uint32 offset\nuint32 size\nuint8[] elements\n"},
};

const Definition& find_part(std::string_view name) {
  const auto* found = std::ranges::find(kParts, name, &Definition::name);
  HC_CHECK(found != std::end(kParts), name);
  return *found;
}

/// Adds the names of a definition's parts, each before its own parts.
void add_parts(const Definition& definition, std::vector<std::string_view>& parts) {
  std::vector<std::string_view> own;
  for (std::string_view rest = definition.text; !rest.empty();) {
    const auto line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(line.size() + 1);
    const auto name = line.substr(0, line.find_first_of(" ["));
    if (name.find('/') == std::string_view::npos || std::ranges::count(parts, name) > 0) continue;
    parts.push_back(name);
    own.push_back(name);
  }
  for (const auto name : own) add_parts(find_part(name), parts);
}

std::vector<Schema> make_schemas() {
  std::vector<Schema> all;
  for (std::size_t i = 0; i < std::size(kTypes); ++i) {
    const Definition& definition = kTypes[i];
    Schema each{static_cast<Type>(i), std::string(definition.name), std::string(definition.text)};
    each.name.insert(each.name.find('/'), "/msg");
    std::vector<std::string_view> parts;
    add_parts(definition, parts);
    for (const auto part : parts)
      each.text += std::string(80, '=') + "\nMSG: " + std::string(part) + "\n" +
                   std::string(find_part(part).text);
    all.push_back(std::move(each));
  }
  return all;
}

}  // namespace

std::span<const Schema> schemas() {
  static const std::vector<Schema> kAll = make_schemas();
  return kAll;
}

const Schema& schema(Type type) {
  return schemas()[static_cast<std::size_t>(type)];
}

std::optional<Type> type_of(std::string_view name) {
  const auto all = schemas();
  const auto found = std::ranges::find(all, name, &Schema::name);
  if (found == all.end()) return std::nullopt;
  return found->type;
}

}  // namespace hc::ros
