// SPDX-License-Identifier: Apache-2.0
// The tables [hosts.NAME], [modes], [workspace] and [frames.NAME].
#include <cmath>
#include <numbers>

#include <graph/file/tables.h>

namespace hc::internal {
namespace {

using Angles = std::array<double, 3>;

/// A rotation by roll, pitch and yaw [deg] as a unit quaternion (x, y, z, w), about fixed axes,
/// roll about x first, so that R = Rz(yaw) Ry(pitch) Rx(roll).
std::array<double, 4> quaternion_of(const Angles& degrees) {
  auto half = [&](std::size_t axis) { return degrees[axis] * std::numbers::pi / 360; };
  const double cx = std::cos(half(0)), sx = std::sin(half(0));
  const double cy = std::cos(half(1)), sy = std::sin(half(1));
  const double cz = std::cos(half(2)), sz = std::sin(half(2));
  std::array<double, 4> quaternion = {cz * cy * sx - sz * sy * cx, cz * sy * cx + sz * cy * sx,
                                      sz * cy * cx - cz * sy * sx, cz * cy * cx + sz * sy * sx};
  // Exact for right angles: 0.5, not 0.5000000000000001.
  for (double& part : quaternion) part = std::round(part * 1e15) / 1e15;
  return quaternion;
}

void read_frame(const Fields& fields, const Node& node, Graph& graph) {
  GraphFrame frame;
  frame.name = node.key;
  frame.place = node.place;
  fields.check_name(node, "frame", node.key);
  Angles angles{};
  std::optional<Lined<std::string>> mover;
  fields.read(node, "in frame " + node.key,
              {{"parent", fields.text(frame.parent), true},
               {"translation", fields.numbers(frame.translation)},
               {"rotation", fields.numbers(angles)},
               {"moved_by", fields.text(mover)},
               {"coord", fields.integer(frame.coord, 1, 999)}});
  if (node.table() == nullptr) return;
  if (!frame.parent.value.empty())
    fields.check_name(*node.find("parent"), "frame", frame.parent.value);
  frame.rotation = quaternion_of(angles);
  if (mover) {
    if (auto port = parse_port(mover->value, false))
      frame.moved_by = Lined<GraphPort>{*port, mover->place};
    else
      fields.add(*node.find("moved_by"), port.error().detail);
    for (const char* key : {"translation", "rotation"})
      if (const Node* also = node.find(key))
        fields.add(*also, "a frame with \"moved_by\" has no " + quoted_name(key));
  }
  graph.frames.push_back(std::move(frame));
}

void read_host(const Fields& fields, const Node& node, Graph& graph) {
  GraphHost host;
  host.name = node.key;
  host.place = node.place;
  host.program.value = "hc";
  fields.check_name(node, "host", node.key);
  fields.read(node, "in host " + node.key,
              {{"ssh", fields.texts(host.ssh), true},
               {"hc", fields.text(host.program)},
               {"address", fields.text(host.address)}});
  // The destination must not look like an option of ssh.
  const Node* ssh = node.table() == nullptr ? nullptr : node.find("ssh");
  if (ssh != nullptr &&
      (host.ssh.empty() || host.ssh.back().value.empty() || host.ssh.back().value.starts_with("-")))
    fields.add(*ssh,
               R"("ssh" must be a destination, such as "pi@robot", or a list that ends with it)");
  graph.hosts.push_back(std::move(host));
}

}  // namespace

Fields::Take read_hosts(const Fields& fields, Graph& graph) {
  return fields.each([&](const Node& node) { read_host(fields, node, graph); });
}

Fields::Take read_modes(const Fields& fields, Graph& graph) {
  return fields.each([&](const Node& node) {
    Lined<std::int64_t> number;
    fields.check_name(node, "mode", node.key);
    fields.integer(number, 1, 2147483647)(node);
    if (number.value != 0) graph.modes.push_back({node.key, number.value, node.place});
  });
}

Fields::Take read_workspace(const Fields& fields, Graph& graph) {
  return [&](const Node& node) {
    auto& workspace = graph.workspaces.emplace_back();  // empty if wrong
    workspace.place = node.place;
    fields.read(node, "in the workspace", {{"module", fields.text(workspace), true}});
  };
}

Fields::Take read_frames(const Fields& fields, Graph& graph) {
  return fields.each([&](const Node& node) { read_frame(fields, node, graph); });
}

}  // namespace hc::internal
