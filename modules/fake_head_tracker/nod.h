// SPDX-License-Identifier: Apache-2.0
#pragma once
// How a person turns the head to and fro, who is not there. Pure.

/// How far and how fast; from this its acceleration follows, speed² / amplitude, a little more in
/// the first seconds.
struct Nod {
  double amplitude = 0.7;  ///< of yaw, over 0 [rad]
  double speed = 1.047;    ///< greatest of yaw, over 0 [rad/s]
};

/// The angles of a head. [rad]
struct HeadAngles {
  double pitch = 0;  ///< > 0: looks down
  double yaw = 0;    ///< > 0: to the left
};

/// A sine of yaw and a smaller one of pitch, which begin at rest in the middle.
/// @param time  since the beginning; before it the head is in the middle [s].
HeadAngles angles_at(const Nod& nod, double time);
