// SPDX-License-Identifier: Apache-2.0
#pragma once
// Markers by name in parameters, as in "aruco:23=101 apriltag:7=102 colour:300=103". Pure.

#include <optional>
#include <string>
#include <vector>

#include <hc/base/result.h>
#include <vision/marker.h>

/// What is said of one marker.
struct NamedMarker {
  hc::vision::MarkerKind kind = hc::vision::MarkerKind::Aruco;
  int id = 0;  ///< of a coloured one, its hue [degree]
  double value = 0;
};

/// Reads words KIND:ID=VALUE with blanks or commas between them.
///
/// @param least, most  what a value may be.
/// @param whole  a value is a whole number.
/// Errors: Invalid, with the word that is wrong.
hc::Result<std::vector<NamedMarker>> read_names(const std::string& text, double least, double most,
                                                bool whole);

/// The value for a marker, where there is one. Hues are alike that differ by 20 degrees at most;
/// the closest is taken.
std::optional<NamedMarker> find_name(const std::vector<NamedMarker>& names,
                                     hc::vision::MarkerKind kind, int id);
