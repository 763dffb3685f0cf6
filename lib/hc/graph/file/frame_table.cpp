// SPDX-License-Identifier: Apache-2.0
// The table [frames.NAME].
#include <cmath>
#include <numbers>

#include <hc/graph/file/tables.h>

namespace hc::internal {
namespace {

/// A turn by roll, pitch and yaw [deg] as a unit quaternion (x, y, z, w): about axes that stand
/// still, roll about x first, so that R = Rz(yaw) Ry(pitch) Rx(roll).
std::array<double, 4> quaternion_of(const std::vector<double>& degrees) {
  auto half = [&](std::size_t axis) { return degrees[axis] * std::numbers::pi / 360; };
  const double cx = std::cos(half(0)), sx = std::sin(half(0));
  const double cy = std::cos(half(1)), sy = std::sin(half(1));
  const double cz = std::cos(half(2)), sz = std::sin(half(2));
  return {cz * cy * sx - sz * sy * cx, cz * sy * cx + sz * cy * sx, sz * cy * cx - cz * sy * sx,
          cz * cy * cx + sz * sy * sx};
}

void read_rotation(const Fields& fields, const Node& table, GraphFrame& frame) {
  auto angles = fields.numbers(table, "rotation", 3);
  auto quaternion = fields.numbers(table, "quaternion", 4);
  if (angles) frame.rotation = quaternion_of(*angles);
  if (!quaternion) return;
  constexpr double kTolerance = 1e-3;  // of its length
  double length = std::hypot(std::hypot((*quaternion)[0], (*quaternion)[1]),
                             std::hypot((*quaternion)[2], (*quaternion)[3]));
  if (angles)
    return fields.add(*table.find("quaternion"),
                      R"(a frame has "rotation" or "quaternion", not both)");
  if (std::abs(length - 1) > kTolerance)
    return fields.add(*table.find("quaternion"), R"("quaternion" has the length 1)");
  for (std::size_t i = 0; i < 4; ++i) frame.rotation[i] = (*quaternion)[i] / length;
}

void read_frame(const Fields& fields, const std::string& name, const Node& node, Graph& graph) {
  GraphFrame frame;
  frame.name = name;
  frame.place = node.place;
  if (!is_name(name)) fields.add(node, "a frame's name is snake_case, not " + quoted_name(name));
  if (node.table() == nullptr) return fields.add(node, "a frame is a table [frames." + name + "]");
  fields.check_keys(node, {"parent", "translation", "rotation", "quaternion", "moved_by", "coord"},
                    "in frame " + name);
  if (auto parent = fields.text(node, "parent")) {
    frame.parent = *parent;
    if (!is_name(parent->value))
      fields.add(*node.find("parent"),
                 "a frame's name is snake_case, not " + quoted_name(parent->value));
  }
  if (auto translation = fields.numbers(node, "translation", 3))
    std::copy(translation->begin(), translation->end(), frame.translation.begin());
  read_rotation(fields, node, frame);
  if (auto mover = fields.text_if_there(node, "moved_by")) {
    const Node& at = *node.find("moved_by");
    if (auto port = fields.port(at, mover->value, false))
      frame.moved_by = Lined<GraphPort>{*port, at.place};
    for (const char* key : {"translation", "rotation", "quaternion"})
      if (const Node* also = node.find(key))
        fields.add(*also, "a frame that is moved has no " + quoted_name(key));
  }
  if (const Node* number = node.find("coord")) {
    const auto* coord = number->as<std::int64_t>();
    if (coord == nullptr || *coord < 1 || *coord > 999)
      fields.add(*number, "\"coord\" is a whole number from 1 to 999");
    else
      frame.coord = {*coord, number->place};
  }
  graph.frames.push_back(std::move(frame));
}

}  // namespace

void read_frames(const Fields& fields, const Node& root, Graph& graph) {
  fields.each(root, "frames", [&](const std::string& name, const Node& node) {
    read_frame(fields, name, node, graph);
  });
}

}  // namespace hc::internal
