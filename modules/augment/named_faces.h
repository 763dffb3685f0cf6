// SPDX-License-Identifier: Apache-2.0
#pragma once
// Known people, by name, and the places of their faces, from the messages of `faces`. No
// ports.

#include <chrono>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <hc/base/result.h>
#include <hc/base/time.h>
#include <hc/mtp/matrix_view.h>

/// A person's face.
struct NamedFace {
  std::string name;
  Eigen::Vector3d p_world;  ///< the middle between the eyes [m]
};

class NamedFaces {
 public:
  /// A row of the table of faces.
  struct Face {
    int person = 0;
    Eigen::Vector3d p_head;  ///< the middle between the eyes, in the head's frame [m]
  };

  static constexpr std::size_t kMostFaces = 16;  ///< that are shown, the nearest
  static constexpr std::size_t kMostNames = 1000;
  static constexpr std::size_t kMostLetters = 24;         ///< of a name; the others become "..."
  static constexpr std::chrono::milliseconds kLife{500};  ///< how long a face stays

  /// The faces in a table, the nearest first; without those of unknown persons, and those
  /// in places where no head can be.
  static std::vector<Face> read(const hc::MatrixView<const double>& table);
  /// Takes all faces of a time.
  void see(hc::Time time, const std::vector<Face>& faces, const Eigen::Isometry3d& T_world_head);
  /// Takes the names of all persons, in lines "PERSON NAME".
  ///
  /// Errors: Malformed (a line is none of these, which is left out; or more than kMostNames).
  hc::Status name(std::string_view lines);

  /// The faces of persons with a name at a time, where they were last seen.
  [[nodiscard]] std::vector<NamedFace> at(hc::Time time) const;

 private:
  struct Seen {
    int person = 0;
    Eigen::Vector3d p_world;
  };
  hc::Time time_;
  std::vector<Seen> seen_;
  std::map<int, std::string> names_;  // of persons
};
