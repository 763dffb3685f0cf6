// SPDX-License-Identifier: Apache-2.0
#pragma once
// Cameras that may go and come back, by what their name is: aravis:NAME (GigE Vision and USB3
// Vision), a V4L2 device, an RTSP stream.

#include <optional>
#include <string>

#include "live.h"

/// Whether a source is one: "aravis:…", a number, "/dev/…", "rtsp://…".
bool is_live(const std::string& name);

/// How such a source is opened. @param pixel_format  of aravis: alone, see hc::aravis::Camera.
LiveCamera live_camera(const std::string& name, const std::string& pixel_format);
