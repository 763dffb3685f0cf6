// SPDX-License-Identifier: Apache-2.0
#pragma once
// Live cameras, which may disconnect and reconnect: aravis:NAME (GigE Vision and USB3 Vision), V4L2
// devices, RTSP streams.

#include <optional>
#include <string>

#include "live.h"
#include "v4l2.h"

/// Whether a name is of a live camera: "aravis:…", a number, "/dev/…", "rtsp://…".
bool is_live(const std::string& name);

/// How to open a live camera. @param mode  requested mode; aravis uses only the pixel format and
/// rate (see hc::aravis::Camera), RTSP nothing.
LiveCamera live_camera(const std::string& name, const CaptureMode& mode);
