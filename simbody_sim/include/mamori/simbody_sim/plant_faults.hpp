// SPDX-License-Identifier: Apache-2.0
/// @file
/// What can be wrong with the simulated devices right now. Written by whoever runs the fault plan, read by
/// the plant.
///
/// @satisfies SWR-SIM-012      Design: docs/design/simulation.md#fault-plan
#ifndef MAMORI_SIMBODY_SIM_PLANT_FAULTS_HPP
#define MAMORI_SIMBODY_SIM_PLANT_FAULTS_HPP

#include <array>
#include <optional>

#include "mamori/safety/arm/arm_device.hpp"

namespace mamori::sim {

/// State of one encoder channel; the bias is added before a bit is flipped. Default: sound.
struct EncoderFault {
    bool frozen{false};                     ///< keeps the last sound count
    double bias_rad{0.0};                   ///< added to the position
    std::optional<unsigned> flipped_bit{};  ///< 0 .. 31, inverted in the count
};

/// State of all devices. Default: sound.
struct PlantFaults {
    std::array<EncoderFault, safety::kArmJointCount> encoder_a{};
    std::array<EncoderFault, safety::kArmJointCount> encoder_b{};
    /// The drive delivers this fraction of its torque limit, -1 .. 1, whatever it is told.
    std::array<std::optional<double>, safety::kArmJointCount> torque_runaway{};
    /// Fraction of its torque that the brake has lost, 0 .. 1.
    safety::JointVector brake_fade{};
    /// Speed at which the closed brake yields to its load [rad/s], >= 0.
    safety::JointVector brake_creep_rad_s{};
    /// The brake stays open once it is open; its contact says so.
    std::array<bool, safety::kArmJointCount> brake_stuck_open{};
    bool power_lost{false};
    bool sto_ignored{false};  ///< the drives keep their torque when their safe-torque-off input demands none
    bool relay_stuck{false};  ///< the relay stays closed once it is closed; its contact says so
    std::array<bool, 2U> emergency_stop_open{};   ///< circuit of the channel: pushed, or a broken wire
    std::array<bool, 2U> protective_stop_open{};  ///< circuit of the channel
    std::array<bool, 2U> enabling_open{};         ///< circuit of the channel: released, or a broken wire
    bool enabling_squeezed{false};                ///< opens both circuits, too
    bool run_released{false};                     ///< the hold-to-run button is not held
    std::size_t mode{0U};                         ///< contact of the mode selector that is closed
    bool start_stuck{false};                      ///< the button stays pushed once it is pushed
    bool reset_stuck{false};                      ///< likewise
};

}  // namespace mamori::sim

#endif  // MAMORI_SIMBODY_SIM_PLANT_FAULTS_HPP
