// SPDX-License-Identifier: Apache-2.0
#pragma once
// The objects to draw and their poses, parsed from a parameter. Pure, except load().
//
//     cube at world 2 0 0.8 size 0.3; robot.glb at 101 0 0 0 90 0 0; stick.obj at 101 to 102

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <graphics/model.h>
#include <hc/base/result.h>

/// A frame of the graph or of a marker.
struct NamedFrame {
  std::string name;
  int number = 0;  ///< if given by number, else 0
};

/// A model at a place.
struct Object {
  std::string model;                ///< "cube", "ball", or a file: .obj, .stl, .gltf, .glb
  NamedFrame frame;                 ///< parent frame
  std::optional<NamedFrame> other;  ///< if given, the parent is between_points() of both frames
  Eigen::Isometry3d T_frame_object = Eigen::Isometry3d::Identity();
  double size = 0;    ///< of its longest side [m]; 0: as in the model
  bool fits = false;  ///< its longest side spans the distance between the two frames
};

/// Reads objects separated by ;, each
/// `MODEL at FRAME [to FRAME] [X Y Z [ROLL PITCH YAW]] [size METRES|fit]`, in metres and degrees as
/// in a graph's [frames]. Errors: Invalid.
hc::Result<std::vector<Object>> read_objects(std::string_view text);

/// The frame of an object held at two points: origin at their midpoint, x from one to the other, y
/// horizontal, z up. If x is vertical, y is the world's y axis.
Eigen::Isometry3d between_points(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// A cube or ball of 1 m, or the model in a file. Errors: as hc::graphics::read_model().
hc::Result<std::vector<hc::graphics::Part>> load(const std::string& model);
