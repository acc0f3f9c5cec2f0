// SPDX-License-Identifier: Apache-2.0
#include "gravity_model.hpp"

#include "mamori/safety/arm/guards.hpp"

namespace safe_arm {
namespace {

struct Vector {
    double x{0.0};
    double y{0.0};
    double z{0.0};
};

constexpr Vector operator+(const Vector& a, const Vector& b) noexcept {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vector operator*(double factor, const Vector& a) noexcept {
    return {factor * a.x, factor * a.y, factor * a.z};
}

/// A joint and the link that it moves. Joints 1, 3, 5 and 7 turn about z, the others about x.
struct Link {
    Vector offset_m{};  ///< from the joint before
    double mass_kg{0.0};
    double center_m{0.0};  ///< of mass, along z
};

constexpr double kGravityMS2 = 9.80665;
constexpr double kGripperKg = 1.0;
constexpr double kFlangeKg = 0.24;
/// Source: simbody_sim/models/pa10_like.yaml, which names the origin of each figure. The last link carries
/// the gripper.
constexpr std::array<Link, kArmJointCount> kLinks{
    {{{0.0, 0.0, 0.2}, 9.78, 0.14818},
     {{0.0, 0.0, 0.115}, 8.41, 0.06175},
     {{0.0, 0.0, 0.28}, 3.52, 0.077141},
     {{0.0, 0.0, 0.17}, 4.31, 0.04459},
     {{0.0, 0.0, 0.25}, 3.45, 0.08375},
     {{-0.0025, 0.0, 0.25}, 1.46, -0.0315},
     {{0.0, 0.0, 0.08},
      kFlangeKg + kGripperKg,
      (kFlangeKg * -0.0305 + kGripperKg * 0.125) / (kFlangeKg + kGripperKg)}}};

struct Turn {
    double sine{0.0};
    double cosine{1.0};
};

/// Taylor series within a quarter turn around a multiple of it: error below 1e-13. The safety partition has
/// no mathematical library. An angle beyond 1e6 rad, which no encoder delivers, counts as 0.
constexpr Turn make_turn(double angle_rad) noexcept {
    constexpr double kQuarter = 1.5707963267948966;
    if (!mamori::safety::is_within(angle_rad, 1.0e6)) {
        return {};
    }
    const auto quarters = static_cast<std::int32_t>(angle_rad / kQuarter + (angle_rad < 0.0 ? -0.5 : 0.5));
    const double x = angle_rad - static_cast<double>(quarters) * kQuarter;
    const double s = x * x;
    const double sine =
        x *
        (1.0 -
         s / 6.0 *
             (1.0 - s / 20.0 * (1.0 - s / 42.0 * (1.0 - s / 72.0 * (1.0 - s / 110.0 * (1.0 - s / 156.0))))));
    const double cosine =
        1.0 -
        s / 2.0 *
            (1.0 -
             s / 12.0 *
                 (1.0 -
                  s / 30.0 * (1.0 - s / 56.0 * (1.0 - s / 90.0 * (1.0 - s / 132.0 * (1.0 - s / 182.0))))));
    switch (static_cast<std::uint32_t>(quarters) % 4U) {
        case 1U:
            return {cosine, -sine};
        case 2U:
            return {-sine, -cosine};
        case 3U:
            return {-cosine, sine};
        default:
            return {sine, cosine};
    }
}

/// Unit vectors of a link in the frame of the base.
struct Frame {
    Vector x{1.0, 0.0, 0.0};
    Vector y{0.0, 1.0, 0.0};
    Vector z{0.0, 0.0, 1.0};
};

Frame turn(const Frame& frame, bool is_about_z, double angle_rad) noexcept {
    const auto [s, c] = make_turn(angle_rad);
    if (is_about_z) {
        return {c * frame.x + s * frame.y, c * frame.y + -s * frame.x, frame.z};
    }
    return {frame.x, c * frame.y + s * frame.z, c * frame.z + -s * frame.y};
}

}  // namespace

JointVector calc_gravity_torque(const JointVector& position_rad) noexcept {
    std::array<Vector, kArmJointCount> axes{};
    std::array<Vector, kArmJointCount> places{};
    std::array<Vector, kArmJointCount> moments{};  // mass * place of the centre of mass [kg m]
    Frame frame{};
    Vector place{};
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        const Link& link = kLinks[j];
        const bool is_about_z = j % 2U == 0U;
        place = place + link.offset_m.x * frame.x + link.offset_m.y * frame.y + link.offset_m.z * frame.z;
        axes[j] = is_about_z ? frame.z : frame.x;
        frame = turn(frame, is_about_z, position_rad[j]);
        places[j] = place;
        moments[j] = link.mass_kg * (place + link.center_m * frame.z);
    }
    JointVector torque_nm{};
    double mass_kg = 0.0;
    Vector moment{};
    for (std::size_t n = 0U; n < kArmJointCount; ++n) {
        const std::size_t j = kArmJointCount - 1U - n;
        mass_kg += kLinks[j].mass_kg;
        moment = moment + moments[j];
        const Vector lever = moment + -mass_kg * places[j];
        torque_nm[j] = kGravityMS2 * (axes[j].x * lever.y - axes[j].y * lever.x);
    }
    return torque_nm;
}

}  // namespace safe_arm
