// SPDX-License-Identifier: Apache-2.0
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "figure_reader.hpp"
#include "mamori/simbody_sim/arm_model.hpp"
#include "number_text.hpp"

namespace mamori::sim {
namespace {

using detail::FigureReader;
using detail::kAny;
using detail::kDelay;
using detail::kNotNegative;
using detail::kPositive;
using detail::ReadError;
using detail::to_text;

constexpr const char* kSchema = "mamori.arm_model/1";

Duration to_duration(double seconds) {
    return {std::llround(seconds * 1.0e9)};
}

/// Determinant and leading minors say whether a symmetric 3x3 matrix (xx, yy, zz, xy, xz, yz) is positive
/// (semi-)definite: each must exceed `limit` to its power.
bool is_positive(const std::array<double, 6U>& m, double tolerance) {
    const auto [xx, yy, zz, xy, xz, yz] = m;
    const double scale = std::abs(xx) + std::abs(yy) + std::abs(zz);
    const double limit = tolerance * scale;
    const double minor_xy = xx * yy - xy * xy;
    const double minor_xz = xx * zz - xz * xz;
    const double minor_yz = yy * zz - yz * yz;
    const double determinant = xx * minor_yz - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    return std::min({xx, yy, zz}) > limit && std::min({minor_xy, minor_xz, minor_yz}) > limit * scale &&
           determinant > limit * scale * scale;
}

/// A body has a real mass distribution when its inertia is positive definite and its principal moments obey
/// the triangle inequality. The latter holds when (trace / 2) * identity - inertia is positive semi-definite.
std::string find_inertia_defect(const std::array<double, 6U>& inertia) {
    if (!is_positive(inertia, 0.0)) {
        return "is not positive definite, so no body has it";
    }
    const double half = 0.5 * (inertia[0] + inertia[1] + inertia[2]);
    const std::array<double, 6U> density{half - inertia[0], half - inertia[1], half - inertia[2],
                                         -inertia[3],       -inertia[4],       -inertia[5]};
    constexpr double kFlatBodyTolerance = -1.0e-9;  // a flat plate meets the inequality with equality
    if (!is_positive(density, kFlatBodyTolerance)) {
        return "breaks the triangle inequality of moments of inertia, so no body has it";
    }
    return {};
}

BodyModel read_body(const FigureReader& reader) {
    BodyModel body;
    body.mass_kg = reader.read_number("mass_kg", kPositive);
    body.center_of_mass_m = reader.read_numbers<3U>("center_of_mass_m", kAny);
    body.inertia_kg_m2 = reader.read_numbers<6U>("inertia_kg_m2", kAny);
    const std::string defect = find_inertia_defect(body.inertia_kg_m2);
    if (!defect.empty()) {
        reader.refuse("inertia_kg_m2", defect);
    }
    return body;
}

BrakeModel read_brake(const FigureReader& joint) {
    const FigureReader reader = joint.read_map(
        "brake", "brake",
        {"torque_nm", "closing_delay_s", "opening_delay_s", "stiffness_nm_rad", "damping_nm_s_rad"});
    BrakeModel brake;
    brake.torque_nm = reader.read_number("torque_nm", kPositive);
    brake.closing_delay = to_duration(reader.read_number("closing_delay_s", kDelay));
    brake.opening_delay = to_duration(reader.read_number("opening_delay_s", kDelay));
    brake.stiffness_nm_rad = reader.read_number("stiffness_nm_rad", kPositive);
    brake.damping_nm_s_rad = reader.read_number("damping_nm_s_rad", kNotNegative);
    return brake;
}

/// Explicit torques of stiffness k and damping d on an inertia m are stable in a semi-implicit Euler step h
/// when 2 h d / m + h^2 k / m < 4 (Jury's criterion). The armature is the smallest inertia that a joint can
/// show; a quarter of the bound is asked for, so that the motion is also resolved.
void check_stiffness(const FigureReader& reader, const JointModel& joint) {
    const double h = to_seconds(kPlantSubstep);
    const double armature = calc_armature(joint);
    const double back_emf = joint.torque_limit_nm / joint.speed_limit_rad_s;
    const double damping = joint.viscous_friction_nm_s_rad + back_emf;
    const auto calc_load = [h, armature](double k, double d) { return (2.0 * h * d + h * h * k) / armature; };
    if (!(calc_load(joint.brake.stiffness_nm_rad, damping + joint.brake.damping_nm_s_rad) < 1.0)) {
        reader.refuse("brake", "is too stiff for the integration step and this rotor inertia");
    }
    if (!(calc_load(joint.stop_stiffness_nm_rad, damping) < 1.0)) {
        reader.refuse("end_stop", "is too stiff for the integration step and this rotor inertia");
    }
}

void read_range(const FigureReader& reader, JointModel& joint) {
    const auto [min, max] = reader.read_numbers<2U>("position_range_rad", kAny);
    if (!(min < max)) {
        reader.refuse("position_range_rad", "must grow from " + to_text(min) + " to " + to_text(max));
    }
    joint.position_min_rad = min;
    joint.position_max_rad = max;
}

double read_resolution(const FigureReader& reader, const char* key, const JointModel& joint) {
    const double counts_per_rad = reader.read_number(key, kPositive);
    const double reach = std::max(std::abs(joint.position_min_rad), std::abs(joint.position_max_rad));
    constexpr double kCountLimit =
        1073741824.0;  // half of the 31-bit range: a joint past its stop still has a count
    if (!(reach * counts_per_rad < kCountLimit)) {
        reader.refuse(key, "does not fit the position range into the 32-bit count");
    }
    return counts_per_rad;
}

void read_axis(const FigureReader& reader, JointModel& joint) {
    joint.axis = reader.read_numbers<3U>("axis", kAny);
    const auto [x, y, z] = joint.axis;
    if (!(std::abs(x * x + y * y + z * z - 1.0) < 1.0e-9)) {
        reader.refuse("axis", "must be a vector of length 1");
    }
}

JointModel read_joint(const YAML::Node& node, const std::string& file, std::size_t index) {
    const bool named = node.IsMap() && node["name"].IsDefined() && node["name"].IsScalar();
    const std::string place =
        "joint " + (named ? node["name"].Scalar() : "number " + std::to_string(index + 1U));
    const FigureReader reader(node, file, place,
                              {"name", "axis", "offset_m", "mass_kg", "center_of_mass_m", "inertia_kg_m2",
                               "position_range_rad", "speed_limit_rad_s", "torque_limit_nm",
                               "rotor_inertia_kg_m2", "gear_ratio", "viscous_friction_nm_s_rad", "brake",
                               "end_stop", "encoder_a_counts_per_rad", "encoder_b_counts_per_rad"});
    JointModel joint;
    joint.name = reader.read_text("name");
    read_axis(reader, joint);
    joint.offset_m = reader.read_numbers<3U>("offset_m", kAny);
    joint.link = read_body(reader);
    read_range(reader, joint);
    joint.speed_limit_rad_s = reader.read_number("speed_limit_rad_s", kPositive);
    joint.torque_limit_nm = reader.read_number("torque_limit_nm", kPositive);
    joint.rotor_inertia_kg_m2 = reader.read_number("rotor_inertia_kg_m2", kPositive);
    joint.gear_ratio = reader.read_number("gear_ratio", kPositive);
    joint.viscous_friction_nm_s_rad = reader.read_number("viscous_friction_nm_s_rad", kNotNegative);
    joint.brake = read_brake(reader);
    const FigureReader stop =
        reader.read_map("end_stop", "end_stop", {"stiffness_nm_rad", "dissipation_s_rad"});
    joint.stop_stiffness_nm_rad = stop.read_number("stiffness_nm_rad", kPositive);
    joint.stop_dissipation_s_rad = stop.read_number("dissipation_s_rad", kNotNegative);
    joint.encoder_a_counts_per_rad = read_resolution(reader, "encoder_a_counts_per_rad", joint);
    joint.encoder_b_counts_per_rad = read_resolution(reader, "encoder_b_counts_per_rad", joint);
    check_stiffness(reader, joint);
    return joint;
}

ArmModel read_model(const YAML::Node& root, const std::string& file) {
    const FigureReader reader(
        root, file, "",
        {"schema", "name", "gravity_m_s2", "motion_columns_ignored", "drive", "joints", "gripper"});
    if (reader.read_text("schema") != kSchema) {
        reader.refuse("schema", std::string("must be '") + kSchema + "'");
    }
    ArmModel model;
    model.name = reader.read_text("name");
    model.gravity_m_s2 = reader.read_numbers<3U>("gravity_m_s2", kAny);
    const double ignored = reader.read_number("motion_columns_ignored", {0.0, true, 1000.0});
    if (ignored != std::floor(ignored)) {
        reader.refuse("motion_columns_ignored", "must be a whole number");
    }
    model.motion_columns_ignored = static_cast<std::size_t>(ignored);
    model.sto_delay =
        to_duration(reader.read_map("drive", "drive", {"sto_delay_s"}).read_number("sto_delay_s", kDelay));
    const YAML::Node joints = reader.read_sequence("joints", kArmJointCount);
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        model.joints[i] = read_joint(joints[i], file, i);
        for (std::size_t k = 0U; k < i; ++k) {
            if (model.joints[k].name == model.joints[i].name) {
                reader.refuse("joints", "the name '" + model.joints[i].name + "' is given to two joints");
            }
        }
    }
    model.gripper =
        read_body(reader.read_map("gripper", "gripper", {"mass_kg", "center_of_mass_m", "inertia_kg_m2"}));
    return model;
}

}  // namespace

LoadedModel parse_arm_model(const std::string& text, const std::string& name) {
    try {
        return {read_model(YAML::Load(text), name), {}};
    } catch (const ReadError& error) {
        return {std::nullopt, error.what()};
    } catch (const YAML::Exception& error) {
        return {std::nullopt,
                name + ":" + std::to_string(error.mark.line + 1) + ": not readable as YAML: " + error.msg};
    }
}

LoadedModel load_arm_model(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    if (!file || !(text << file.rdbuf())) {
        return {std::nullopt, path + ": cannot be read or is empty; give the path of an arm model file"};
    }
    return parse_arm_model(text.str(), path);
}

}  // namespace mamori::sim
