// SPDX-License-Identifier: Apache-2.0
#pragma once
// Tags with people's names over their heads. No ports. For the thread that made the renderer.

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <graphics/overlay.h>
#include <graphics/renderer.h>

#include "named_faces.h"
#include "pair.h"

/// A plate with a name for each face: upright, above the head, facing the eyes.
class Tags {
 public:
  static constexpr double kCapital = 0.06;  ///< height of a capital letter [m]
  static constexpr double kAbove = 0.22;    ///< middle of the plate, above the eyes [m]
  static constexpr double kNearest = 0.3;   ///< a nearer plate is not shown [m]
  static constexpr std::size_t kMostPlates = 2 * NamedFaces::kMostFaces;  ///< that are kept

  /// @param renderer  must outlive the tags.
  explicit Tags(hc::graphics::Renderer& renderer) : renderer_(renderer) {}

  void place(const std::vector<NamedFace>& faces, const Sight& sight);
  [[nodiscard]] const std::vector<hc::graphics::Body>& bodies() const { return placed_; }
  /// Number of plates that are kept.
  [[nodiscard]] std::size_t plates() const { return plates_.size(); }

 private:
  /// Makes room for new plates.
  void drop_unused(const std::vector<NamedFace>& faces);
  const hc::graphics::Body& plate(const std::string& name);

  hc::graphics::Renderer& renderer_;
  std::map<std::string, hc::graphics::Body> plates_;
  std::vector<hc::graphics::Body> placed_;
};
