// SPDX-License-Identifier: Apache-2.0
#pragma once
// Cameras that may go and come back, by what their name is: aravis:NAME (GigE Vision and USB3
// Vision), a V4L2 device, an RTSP stream.

#include <optional>
#include <string>

#include "live.h"
#include "v4l2.h"

/// Whether a source is one: "aravis:…", a number, "/dev/…", "rtsp://…".
bool is_live(const std::string& name);

/// How such a source is opened. @param mode  what it is asked for: of aravis: the pixel format
/// and rate (see hc::aravis::Camera), of an RTSP stream nothing.
LiveCamera live_camera(const std::string& name, const CaptureMode& mode);
