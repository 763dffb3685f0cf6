// SPDX-License-Identifier: Apache-2.0
#pragma once
// The simulated motion of a person's head. Pure.

/// The maximum acceleration is speed² / amplitude, slightly more in the first seconds.
struct Nod {
  double amplitude = 0.7;  ///< of yaw, > 0 [rad]
  double speed = 1.047;    ///< maximum of yaw, > 0 [rad/s]
};

/// Angles of a head [rad].
struct HeadAngles {
  double pitch = 0;  ///< > 0: down
  double yaw = 0;    ///< > 0: left
};

/// A sine of yaw and a smaller one of pitch, starting at rest in the centre.
/// @param time  since the start; negative: in the centre [s].
HeadAngles angles_at(const Nod& nod, double time);
