// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a peer sends of each type, and what it gets back when a graph has taken it as its own
// message and published that. Written once for what idlc and what fastddsgen make of ros.idl: M()
// is how a member is named, TYPE() how a type.

#include <cstdint>
#include <cstdio>
#include <memory>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "access.h"  // M(), TYPE(), resize(), length(), item(), set_text(), text_of()

/// Sets members.
struct Fill {
  static constexpr bool kIsBack = false;

  template <typename T, typename V>
  void number(const char*, T& member, V value) {
    member = static_cast<T>(value);
  }
  template <typename T>
  void text(const char*, T& member, const char* value) {
    set_text(member, value);
  }
  template <typename T>
  void size(const char*, T& list, std::size_t size) {
    resize(list, size);
  }
};

/// Compares members; what differs is said.
struct Check {
  static constexpr bool kIsBack = true;

  template <typename T, typename V>
  void number(const char* name, T& member, V value) {
    if (member != static_cast<T>(value))
      wrong += std::string(" ") + name + "=" + std::to_string(member) + " not " +
               std::to_string(value) + ";";
  }
  template <typename T>
  void text(const char* name, T& member, const char* value) {
    if (text_of(member) != value)
      wrong += std::string(" ") + name + "=" + text_of(member) + " not " + value + ";";
  }
  template <typename T>
  void size(const char* name, T& list, std::size_t size) {
    if (length(list) == size) return;
    wrong += std::string(" ") + name + " has " + std::to_string(length(list)) + " not " +
             std::to_string(size) + ";";
    resize(list, size);
  }
  std::string wrong;
};

template <typename V, typename List, typename Value>
void numbers(V& v, const char* name, List& list, const std::vector<Value>& values) {
  v.size(name, list, values.size());
  for (std::size_t i = 0; i < values.size(); ++i) v.number(name, item(list, i), values[i]);
}

template <typename V, typename List>
void array(V& v, const char* name, List& list, const std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) v.number(name, list[i], values[i]);
}

template <typename V, typename H>
void header(V& v, H& header, const char* frame) {
  v.number("sec", header.M(stamp).M(sec), 1700000000);
  v.number("nanosec", header.M(stamp).M(nanosec), 123456789);
  v.text("frame_id", header.M(frame_id), frame);
}

template <typename V, typename T>
void xyz(V& v, T& vector, double x, double y, double z) {
  v.number("x", vector.M(x), x);
  v.number("y", vector.M(y), y);
  v.number("z", vector.M(z), z);
}

/// A turn of 180 degrees about y, and where to.
template <typename V, typename P, typename Q>
void pose(V& v, P& position, Q& rotation) {
  xyz(v, position, 1, -2, 3.5);
  xyz(v, rotation, 0, 1, 0);
  v.number("w", rotation.M(w), 0);
}

template <typename V>
void visit(V& v, TYPE(sensor_msgs, Image) & m) {
  header(v, m.M(header), V::kIsBack ? "left_eye" : "camera");
  v.number("height", m.M(height), 2);
  v.number("width", m.M(width), 3);
  v.text("encoding", m.M(encoding), V::kIsBack ? "rgb8" : "bgr8");
  v.number("is_bigendian", m.M(is_bigendian), 0);
  v.number("step", m.M(step), V::kIsBack ? 9 : 10);
  using Bytes = std::vector<int>;
  numbers(v, "data", m.M(data),
          V::kIsBack ? Bytes{2, 1, 0, 5, 4, 3, 8, 7, 6, 12, 11, 10, 15, 14, 13, 18, 17, 16}
                     : Bytes{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19});
}

/// 8 x 8 grey pixels of 128.
inline const std::vector<int> kJpeg = {
    0xff, 0xd8, 0xff, 0xe0, 0x00, 0x10, 0x4a, 0x46, 0x49, 0x46, 0x00, 0x01, 0x01, 0x00, 0x00, 0x01,
    0x00, 0x01, 0x00, 0x00, 0xff, 0xdb, 0x00, 0x43, 0x00, 0x10, 0x0b, 0x0c, 0x0e, 0x0c, 0x0a, 0x10,
    0x0e, 0x0d, 0x0e, 0x12, 0x11, 0x10, 0x13, 0x18, 0x28, 0x1a, 0x18, 0x16, 0x16, 0x18, 0x31, 0x23,
    0x25, 0x1d, 0x28, 0x3a, 0x33, 0x3d, 0x3c, 0x39, 0x33, 0x38, 0x37, 0x40, 0x48, 0x5c, 0x4e, 0x40,
    0x44, 0x57, 0x45, 0x37, 0x38, 0x50, 0x6d, 0x51, 0x57, 0x5f, 0x62, 0x67, 0x68, 0x67, 0x3e, 0x4d,
    0x71, 0x79, 0x70, 0x64, 0x78, 0x5c, 0x65, 0x67, 0x63, 0xff, 0xc0, 0x00, 0x0b, 0x08, 0x00, 0x08,
    0x00, 0x08, 0x01, 0x01, 0x11, 0x00, 0xff, 0xc4, 0x00, 0x14, 0x00, 0x01, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xff, 0xc4, 0x00, 0x14,
    0x10, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0xff, 0xda, 0x00, 0x08, 0x01, 0x01, 0x00, 0x00, 0x3f, 0x00, 0x3f, 0xff, 0xd9};

template <typename V>
void visit(V& v, TYPE(sensor_msgs, CompressedImage) & m) {
  header(v, m.M(header), V::kIsBack ? "left_eye" : "camera");
  v.text("format", m.M(format), "jpeg");
  if (!V::kIsBack) return numbers(v, "data", m.M(data), kJpeg);
  const std::size_t size = length(m.M(data));
  if (size < 4) return v.size("data", m.M(data), kJpeg.size());
  v.number("data[0]", item(m.M(data), 0), 0xFF);  // compressed again: its ends are known
  v.number("data[1]", item(m.M(data), 1), 0xD8);
  v.number("data[-2]", item(m.M(data), size - 2), 0xFF);
  v.number("data[-1]", item(m.M(data), size - 1), 0xD9);
}

template <typename V>
void visit(V& v, TYPE(sensor_msgs, PointCloud2) & m) {
  header(v, m.M(header), V::kIsBack ? "head" : "lidar");
  v.number("height", m.M(height), 1);
  v.number("width", m.M(width), 2);
  const unsigned fields = V::kIsBack ? 3 : 4, step = 4 * fields;
  v.size("fields", m.M(fields), fields);
  const char* names[] = {"x", "y", "z", "intensity"};
  for (unsigned i = 0; i < fields; ++i) {
    auto& field = item(m.M(fields), i);
    v.text("name", field.M(name), names[i]);
    v.number("offset", field.M(offset), 4 * i);
    v.number("datatype", field.M(datatype), 7);
    v.number("count", field.M(count), 1);
  }
  v.number("is_bigendian", m.M(is_bigendian), false);
  v.number("point_step", m.M(point_step), step);
  v.number("row_step", m.M(row_step), 2 * step);
  std::vector<int> bytes;
  for (unsigned point = 0; point < 2; ++point)
    for (unsigned i = 0; i < fields; ++i) {
      constexpr int kOnes[] = {0x3F, 0x40, 0xC0, 0x41};  // highest bytes: 0.5, 2, -2, 8
      bytes.insert(bytes.end(), {0, static_cast<int>(point), 0, kOnes[i]});
    }
  numbers(v, "data", m.M(data), bytes);
  v.number("is_dense", m.M(is_dense), !V::kIsBack);
}

template <typename V>
void visit(V& v, TYPE(sensor_msgs, CameraInfo) & m) {
  constexpr bool kBack = V::kIsBack;
  header(v, m.M(header), kBack ? "left_eye" : "camera");
  v.number("height", m.M(height), kBack ? 0 : 480);
  v.number("width", m.M(width), kBack ? 0 : 640);
  v.text("distortion_model", m.M(distortion_model), kBack ? "plumb_bob" : "equidistant");
  using Numbers = std::vector<double>;
  numbers(v, "d", m.M(d), kBack ? Numbers(5, 0.) : Numbers{.1, .2, .3, .4});
  const Numbers nine = {1.5, 2, 3, 4, 5, 6, 7, 8, 9};
  array(v, "k", m.M(k), kBack ? Numbers{500, 0, 320, 0, 510, 240, 0, 0, 1} : nine);
  array(v, "r", m.M(r), kBack ? Numbers{1, 0, 0, 0, 1, 0, 0, 0, 1} : nine);
  array(v, "p", m.M(p),
        kBack ? Numbers{500, 0, 320, 0, 0, 510, 240, 0, 0, 0, 1, 0}
              : Numbers{500, 0, 320, -50, 0, 510, 240, 0, 0, 0, 1, 0});
  v.number("binning_x", m.M(binning_x), kBack ? 0 : 2);
  v.number("binning_y", m.M(binning_y), kBack ? 0 : 3);
  auto& roi = m.M(roi);
  v.number("x_offset", roi.M(x_offset), kBack ? 0 : 4);
  v.number("y_offset", roi.M(y_offset), kBack ? 0 : 5);
  v.number("roi.height", roi.M(height), kBack ? 0 : 6);
  v.number("roi.width", roi.M(width), kBack ? 0 : 7);
  v.number("do_rectify", roi.M(do_rectify), !kBack);
}

template <typename V>
void visit(V& v, TYPE(geometry_msgs, PoseStamped) & m) {
  header(v, m.M(header), V::kIsBack ? "robot" : "map");
  pose(v, m.M(pose).M(position), m.M(pose).M(orientation));
}

template <typename V>
void visit(V& v, TYPE(geometry_msgs, Twist) & m) {
  xyz(v, m.M(linear), 0.25, -0.5, 1e-300);
  xyz(v, m.M(angular), 4, 5, -6.75);
}

template <typename V>
void visit(V& v, TYPE(tf2_msgs, TFMessage) & m) {
  v.size("transforms", m.M(transforms), V::kIsBack ? 1 : 2);
  auto& mine = item(m.M(transforms), 0);
  header(v, mine.M(header), V::kIsBack ? "robot" : "odom");
  v.text("child_frame_id", mine.M(child_frame_id), V::kIsBack ? "head" : "base_link");
  pose(v, mine.M(transform).M(translation), mine.M(transform).M(rotation));
  if (V::kIsBack) return;
  auto& other = item(m.M(transforms), 1);
  header(v, other.M(header), "base_link");
  v.text("child_frame_id", other.M(child_frame_id), "arm");
  xyz(v, other.M(transform).M(translation), 7, 8, 9);
  xyz(v, other.M(transform).M(rotation), 0, 0, 0);
  v.number("w", other.M(transform).M(rotation).M(w), 1);
}

template <typename V>
void visit(V& v, TYPE(sensor_msgs, JointState) & m) {
  header(v, m.M(header), V::kIsBack ? "" : "base");
  v.size("name", m.M(name), 2);
  v.text("name[0]", item(m.M(name), 0), V::kIsBack ? "tilt" : "pan");
  v.text("name[1]", item(m.M(name), 1), V::kIsBack ? "pan" : "tilt");
  using Numbers = std::vector<double>;
  numbers(v, "position", m.M(position), V::kIsBack ? Numbers{2, 1} : Numbers{1, 2});
  numbers(v, "velocity", m.M(velocity), V::kIsBack ? Numbers{4, 3} : Numbers{3, 4});
  numbers(v, "effort", m.M(effort), V::kIsBack ? Numbers{6, 5} : Numbers{5, 6});
}

template <typename V>
void visit(V& v, TYPE(std_msgs, String) & m) {
  v.text("data", m.M(data),
         "gr\xC3\xB6\xC3\x9F"
         "er");
}

template <typename V>
void visit(V& v, TYPE(std_msgs, Float64MultiArray) & m) {
  auto& layout = m.M(layout);
  const char* names[] = {"height", "width", "components"};
  const unsigned sizes[] = {2, 3, 1}, strides[] = {6, 3, 1};
  const std::size_t dimensions = V::kIsBack ? 3 : 2;
  v.size("dim", layout.M(dim), dimensions);
  for (std::size_t i = 0; i < dimensions; ++i) {
    v.text("label", item(layout.M(dim), i).M(label), names[i]);
    v.number("size", item(layout.M(dim), i).M(size), sizes[i]);
    v.number("stride", item(layout.M(dim), i).M(stride), strides[i]);
  }
  v.number("data_offset", layout.M(data_offset), V::kIsBack ? 0 : 1);
  using Numbers = std::vector<double>;
  numbers(v, "data", m.M(data),
          V::kIsBack ? Numbers{1, 2, 3, 4, 5, 6.5} : Numbers{99, 1, 2, 3, 4, 5, 6.5});
}

/// Says a line, once.
inline void say(const std::string& line) {
  static std::set<std::string> said;
  if (!said.insert(line).second) return;
  std::printf("%s\n", line.c_str());
  std::fflush(stdout);
}

template <typename T>
void say_whether_right(const std::string& name, T& got) {
  Check check;
  visit(check, got);
  say(name + (check.wrong.empty() ? " ok" : " wrong:" + check.wrong));
}

struct Topic {
  virtual ~Topic() = default;
  virtual void write() = 0;
  virtual void read() = 0;
};

/// Calls a function with each type, as ROS's package and name.
#define FOR_EACH_TYPE(call)                                                                        \
  call(sensor_msgs, Image) call(sensor_msgs, CompressedImage) call(sensor_msgs, PointCloud2)       \
      call(sensor_msgs, CameraInfo) call(sensor_msgs, JointState) call(geometry_msgs, PoseStamped) \
          call(geometry_msgs, Twist) call(tf2_msgs, TFMessage) call(std_msgs, String)              \
              call(std_msgs, Float64MultiArray)
