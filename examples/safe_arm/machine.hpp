// SPDX-License-Identifier: Apache-2.0
/// @file
/// Everything around the safety software in a simulated run: the plant behind the process image, the
/// operator's start button, the hardware watchdog, and the faults of the plan at their instants.
#ifndef EXAMPLES_SAFE_ARM_MACHINE_HPP
#define EXAMPLES_SAFE_ARM_MACHINE_HPP

#include "mamori/ports/virtual_time/frame_runner.hpp"
#include "mamori/simbody_sim/arm_plant.hpp"
#include "mamori/simbody_sim/fault_plan.hpp"
#include "run_record.hpp"

namespace safe_arm {

/// The operator presses start once, long after the self test can have passed.
bool is_start_pressed(mamori::Instant now) noexcept;

/// Devices of the run; calls the recorder after each frame. All references must outlive it.
class Machine final : public mamori::Devices {
  public:
    /// @param[in] fault with `at` in simulated time.
    Machine(mamori::sim::ArmPlant& plant, mamori::ports::virtual_time::VirtualHost& host,
            const mamori::sim::FaultPlan& fault, RunRecord& record) noexcept
        : plant_(plant), host_(host), fault_(fault), record_(record) {}

    void sample(std::uint64_t frame, mamori::Instant now) noexcept override;
    void apply(std::uint64_t frame, mamori::Instant now, mamori::Duration length) noexcept override;

    /// False once the plant's state is no longer finite.
    bool is_plant_sound() const noexcept { return is_plant_sound_; }

  private:
    void apply_software_faults(mamori::Instant now) noexcept;

    mamori::sim::ArmPlant& plant_;
    mamori::ports::virtual_time::VirtualHost& host_;
    mamori::sim::FaultPlan fault_;
    RunRecord& record_;
    bool is_plant_sound_{true};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_MACHINE_HPP
