// SPDX-License-Identifier: Apache-2.0
/// @file
/// Extended robot types for the plane, and colour: names, field order and wire form are those of OpenRTM.
/// Units: metres, seconds, radians. TimedX is X with a time stamp. No decoder checks ranges.
///
/// @satisfies SWR-CDR-005      Design: docs/design/data_flow.md#timed-types
/// Source:   OpenRTM-aist, ExtendedDataTypes.idl (module RTC)
#ifndef MAMORI_KERNEL_EXTENDED_TYPES_2D_HPP
#define MAMORI_KERNEL_EXTENDED_TYPES_2D_HPP

#include "mamori/kernel/payload/fields.hpp"
#include "mamori/kernel/payload/timed_types.hpp"

namespace mamori::rtc {

/// Colour; each component 0.0 (none) .. 1.0 (full).
struct RGBColour {
    double r{0.0}, g{0.0}, b{0.0};
};

/// Position in the plane [m].
struct Point2D {
    double x{0.0}, y{0.0};
};

/// Vector in the plane [m].
struct Vector2D {
    double x{0.0}, y{0.0};
};

/// Position and direction.
struct Pose2D {
    Point2D position{};   ///< [m]
    double heading{0.0};  ///< [rad]
};

/// Velocity in the plane.
struct Velocity2D {
    double vx{0.0};  ///< [m/s]
    double vy{0.0};  ///< [m/s]
    double va{0.0};  ///< yaw rate [rad/s]
};

/// Acceleration in the plane [m/s^2].
struct Acceleration2D {
    double ax{0.0}, ay{0.0};
};

/// Pose and velocity.
struct PoseVel2D {
    Pose2D pose{};
    Velocity2D velocities{};
};

/// Size [m].
struct Size2D {
    double l{0.0};  ///< length
    double w{0.0};  ///< width
};

/// Pose of a device relative to its parent, and its size relative to its base point.
struct Geometry2D {
    Pose2D pose{};
    Size2D size{};
};

/// Covariance of a pose (x, y, heading): upper triangle by rows
/// [m^2, m rad, rad^2].
struct Covariance2D {
    double xx{0.0}, xy{0.0}, xt{0.0};
    double yy{0.0}, yt{0.0};
    double tt{0.0};
};

/// Covariance of a point (x, y): upper triangle by rows [m^2].
struct PointCovariance2D {
    double xx{0.0}, xy{0.0};
    double yy{0.0};
};

/// Command to a robot with car-like steering.
struct Carlike {
    double speed{0.0};           ///< [m/s]
    double steering_angle{0.0};  ///< [rad]; IDL: steeringAngle
};

/// Command to a robot that can move in any direction.
struct SpeedHeading2D {
    double speed{0.0};    ///< [m/s]
    double heading{0.0};  ///< from the x axis [rad]
};

using TimedRGBColour = Timed<RGBColour>;
using TimedPoint2D = Timed<Point2D>;
using TimedVector2D = Timed<Vector2D>;
using TimedPose2D = Timed<Pose2D>;
using TimedVelocity2D = Timed<Velocity2D>;
using TimedAcceleration2D = Timed<Acceleration2D>;
using TimedPoseVel2D = Timed<PoseVel2D>;
using TimedSize2D = Timed<Size2D>;
using TimedGeometry2D = Timed<Geometry2D>;
using TimedCovariance2D = Timed<Covariance2D>;
using TimedPointCovariance2D = Timed<PointCovariance2D>;
using TimedCarlike = Timed<Carlike>;
using TimedSpeedHeading2D = Timed<SpeedHeading2D>;

}  // namespace mamori::rtc

MAMORI_FIELDS(mamori::rtc::RGBColour, r, g, b)
MAMORI_FIELDS(mamori::rtc::Point2D, x, y)
MAMORI_FIELDS(mamori::rtc::Vector2D, x, y)
MAMORI_FIELDS(mamori::rtc::Pose2D, position, heading)
MAMORI_FIELDS(mamori::rtc::Velocity2D, vx, vy, va)
MAMORI_FIELDS(mamori::rtc::Acceleration2D, ax, ay)
MAMORI_FIELDS(mamori::rtc::PoseVel2D, pose, velocities)
MAMORI_FIELDS(mamori::rtc::Size2D, l, w)
MAMORI_FIELDS(mamori::rtc::Geometry2D, pose, size)
MAMORI_FIELDS(mamori::rtc::Covariance2D, xx, xy, xt, yy, yt, tt)
MAMORI_FIELDS(mamori::rtc::PointCovariance2D, xx, xy, yy)
MAMORI_FIELDS(mamori::rtc::Carlike, speed, steering_angle)
MAMORI_FIELDS(mamori::rtc::SpeedHeading2D, speed, heading)

#endif  // MAMORI_KERNEL_EXTENDED_TYPES_2D_HPP
