// SPDX-License-Identifier: Apache-2.0
#pragma once
// What is to be drawn and where, as a parameter says it. Pure, but for reading models.
//
//     cube at world 2 0 0.8 size 0.3; robot.glb at 101 0 0 0 90 0 0; stick.obj at 101 to 102

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <graphics/model.h>
#include <hc/base/result.h>

/// A frame of the graph, or a marker's.
struct NamedFrame {
  std::string name;
  int number = 0;  ///< the same, where it is said by number; 0: by name
};

/// A model at a place.
struct Object {
  std::string model;                ///< "cube", "ball", or a file: .obj, .stl, .gltf, .glb
  NamedFrame frame;                 ///< in which it is
  std::optional<NamedFrame> other;  ///< of two, it is in the frame of between_points()
  Eigen::Isometry3d T_frame_object = Eigen::Isometry3d::Identity();
  double size = 0;    ///< of its longest side [m]; 0: as the model has it
  bool fits = false;  ///< its longest side is as long as the two frames are apart
};

/// Reads objects with ; between them, each
/// `MODEL at FRAME [to FRAME] [X Y Z [ROLL PITCH YAW]] [size METRES|fit]`: metres and degrees, as
/// in a graph's [frames].
///
/// Errors: Invalid, with the object that is wrong.
hc::Result<std::vector<Object>> read_objects(std::string_view text);

/// The frame of what is held at two points: origin in their middle, x from one to the other, y
/// level, z as far up as that lets it. Where x is upright, y is the world's.
Eigen::Isometry3d between_points(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// A cube or a ball, 1 m wide, or what a file has. Errors: as hc::graphics::read_model().
hc::Result<std::vector<hc::graphics::Part>> load(const std::string& model);
