// SPDX-License-Identifier: Apache-2.0
/// @file
/// Extended robot types for space: names, field order and wire form are those of OpenRTM. Units: metres,
/// seconds, radians. TimedX is X with a time stamp. No decoder checks ranges.
///
/// @satisfies SWR-CDR-005      Design: docs/design/data_flow.md#timed-types
/// Source:   OpenRTM-aist, ExtendedDataTypes.idl (module RTC)
#ifndef MAMORI_KERNEL_EXTENDED_TYPES_3D_HPP
#define MAMORI_KERNEL_EXTENDED_TYPES_3D_HPP

#include "mamori/kernel/payload/fields.hpp"
#include "mamori/kernel/payload/timed_types.hpp"

namespace mamori::rtc {

/// Position in space [m].
struct Point3D {
    double x{0.0}, y{0.0}, z{0.0};
};

/// Vector in space [m].
struct Vector3D {
    double x{0.0}, y{0.0}, z{0.0};
};

/// Orientation as angles [rad].
struct Orientation3D {
    double r{0.0};  ///< roll
    double p{0.0};  ///< pitch
    double y{0.0};  ///< yaw
};

/// Position [m] and orientation [rad].
struct Pose3D {
    Point3D position{};
    Orientation3D orientation{};
};

/// Velocity in space.
struct Velocity3D {
    double vx{0.0};  ///< [m/s]
    double vy{0.0};  ///< [m/s]
    double vz{0.0};  ///< [m/s]
    double vr{0.0};  ///< roll rate [rad/s]
    double vp{0.0};  ///< pitch rate [rad/s]
    double va{0.0};  ///< yaw rate [rad/s]
};

/// Angular velocity around each axis [rad/s].
struct AngularVelocity3D {
    double avx{0.0}, avy{0.0}, avz{0.0};
};

/// Acceleration in space [m/s^2].
struct Acceleration3D {
    double ax{0.0}, ay{0.0}, az{0.0};
};

/// Angular acceleration around each axis [rad/s^2].
struct AngularAcceleration3D {
    double aax{0.0}, aay{0.0}, aaz{0.0};
};

/// Pose and velocity.
struct PoseVel3D {
    Pose3D pose{};
    Velocity3D velocities{};
};

/// Size [m].
struct Size3D {
    double l{0.0};  ///< length
    double w{0.0};  ///< width
    double h{0.0};  ///< height
};

/// Pose of a device relative to its parent, and its size relative to its base point.
struct Geometry3D {
    Pose3D pose{};
    Size3D size{};
};

/// Covariance of a pose (x, y, z, roll, pitch, yaw): upper triangle by rows
/// [m^2, m rad, rad^2].
struct Covariance3D {
    double xx{0.0}, xy{0.0}, xz{0.0}, xr{0.0}, xp{0.0}, xa{0.0};
    double yy{0.0}, yz{0.0}, yr{0.0}, yp{0.0}, ya{0.0};
    double zz{0.0}, zr{0.0}, zp{0.0}, za{0.0};
    double rr{0.0}, rp{0.0}, ra{0.0};
    double pp{0.0}, pa{0.0};
    double aa{0.0};
};

/// Command to a robot that can move in any direction.
struct SpeedHeading3D {
    double speed{0.0};  ///< [m/s]
    Orientation3D direction{};
};

/// Orientation, approach and position vectors.
struct OAP {
    Vector3D orientation{};
    Vector3D approach{};
    Vector3D position{};
};

/// Orientation as a unit quaternion; w is the real part. The value-initialised quaternion (all zero) is
/// invalid.
struct Quaternion {
    double x{0.0}, y{0.0}, z{0.0}, w{0.0};
};

using TimedPoint3D = Timed<Point3D>;
using TimedVector3D = Timed<Vector3D>;
using TimedOrientation3D = Timed<Orientation3D>;
using TimedPose3D = Timed<Pose3D>;
using TimedVelocity3D = Timed<Velocity3D>;
using TimedAngularVelocity3D = Timed<AngularVelocity3D>;
using TimedAcceleration3D = Timed<Acceleration3D>;
using TimedAngularAcceleration3D = Timed<AngularAcceleration3D>;
using TimedPoseVel3D = Timed<PoseVel3D>;
using TimedSize3D = Timed<Size3D>;
using TimedGeometry3D = Timed<Geometry3D>;
using TimedCovariance3D = Timed<Covariance3D>;
using TimedSpeedHeading3D = Timed<SpeedHeading3D>;
using TimedOAP = Timed<OAP>;
using TimedQuaternion = Timed<Quaternion>;

}  // namespace mamori::rtc

MAMORI_FIELDS(mamori::rtc::Point3D, x, y, z)
MAMORI_FIELDS(mamori::rtc::Vector3D, x, y, z)
MAMORI_FIELDS(mamori::rtc::Orientation3D, r, p, y)
MAMORI_FIELDS(mamori::rtc::Pose3D, position, orientation)
MAMORI_FIELDS(mamori::rtc::Velocity3D, vx, vy, vz, vr, vp, va)
MAMORI_FIELDS(mamori::rtc::AngularVelocity3D, avx, avy, avz)
MAMORI_FIELDS(mamori::rtc::Acceleration3D, ax, ay, az)
MAMORI_FIELDS(mamori::rtc::AngularAcceleration3D, aax, aay, aaz)
MAMORI_FIELDS(mamori::rtc::PoseVel3D, pose, velocities)
MAMORI_FIELDS(mamori::rtc::Size3D, l, w, h)
MAMORI_FIELDS(mamori::rtc::Geometry3D, pose, size)
MAMORI_FIELDS(mamori::rtc::Covariance3D, xx, xy, xz, xr, xp, xa, yy, yz, yr, yp, ya, zz, zr, zp, za, rr, rp,
              ra, pp, pa, aa)
MAMORI_FIELDS(mamori::rtc::SpeedHeading3D, speed, direction)
MAMORI_FIELDS(mamori::rtc::OAP, orientation, approach, position)
MAMORI_FIELDS(mamori::rtc::Quaternion, x, y, z, w)

#endif  // MAMORI_KERNEL_EXTENDED_TYPES_3D_HPP
