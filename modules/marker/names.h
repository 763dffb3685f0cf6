// SPDX-License-Identifier: Apache-2.0
#pragma once
// Parameters of single markers, e.g. "aruco:23=101 apriltag:7=102 colour:300=103". Pure.

#include <optional>
#include <string>
#include <vector>

#include <hc/base/result.h>
#include <vision/marker.h>

/// The value for one marker.
struct NamedMarker {
  hc::vision::MarkerKind kind = hc::vision::MarkerKind::Aruco;
  int id = 0;  ///< for colour the hue [degree]
  double value = 0;
};

/// Reads words KIND:ID=VALUE, separated by blanks or commas.
///
/// @param least, most  range of a value.
/// @param whole  values are whole numbers.
/// Errors: Invalid.
hc::Result<std::vector<NamedMarker>> read_names(const std::string& text, double least, double most,
                                                bool whole);

/// The value for a marker, if any. A hue matches the closest one within 20 degrees.
std::optional<NamedMarker> find_name(const std::vector<NamedMarker>& names,
                                     hc::vision::MarkerKind kind, int id);
