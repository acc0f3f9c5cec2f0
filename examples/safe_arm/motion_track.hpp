// SPDX-License-Identifier: Apache-2.0
/// @file
/// A joint motion on the control grid: position, velocity and acceleration for every path time. Read from the
/// canonical motion table that `./mamori` writes after it has checked the user's file.
///
/// @satisfies SWR-SAF-011      Design: docs/design/safe_arm.md#motion
#ifndef EXAMPLES_SAFE_ARM_MOTION_TRACK_HPP
#define EXAMPLES_SAFE_ARM_MOTION_TRACK_HPP

#include <string>
#include <vector>

#include "mamori/safety/arm/arm_device.hpp"

namespace safe_arm {

using mamori::safety::JointVector;

/// Point of a path: rad, rad/s, rad/s^2.
struct PathPoint {
    JointVector position_rad{};
    JointVector velocity_rad_s{};
    JointVector acceleration_rad_s2{};
};

/// Motion resampled to one point per control period. Host only: it owns heap memory.
///
/// Thread safety: const members may be called from anywhere. Time: calc_point is O(joints).
class MotionTrack final {
  public:
    /// Reads `path`: lines of `time q1 .. q7` [s, rad], times from 0 and strictly rising; `#` begins a
    /// comment.
    /// @param[in] period_s control period, > 0.
    /// @param[out] error one line with file, line and reason; untouched on success.
    /// @return false when the file cannot be used; the track is unchanged then.
    bool read(const std::string& path, double period_s, std::string& error);

    /// Point at `path_time_s`, held at both ends (velocity and acceleration are zero there).
    PathPoint calc_point(double path_time_s) const;

    double get_duration_s() const;

  private:
    double period_s_{0.0};
    std::vector<PathPoint> points_{PathPoint{}};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_MOTION_TRACK_HPP
