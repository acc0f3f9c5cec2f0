// SPDX-License-Identifier: Apache-2.0
/// @file
/// Environment of the safety software in a simulated run: the plant with its process image, the start button
/// of the operator, the hardware watchdog, and the injected faults of the plan.
///
/// @satisfies SWR-SAF-050      Design: docs/design/simulation.md#fault-plan
#ifndef EXAMPLES_SAFE_ARM_MACHINE_HPP
#define EXAMPLES_SAFE_ARM_MACHINE_HPP

#include "mamori/ports/virtual_time/frame_runner.hpp"
#include "mamori/simbody_sim/arm_plant.hpp"
#include "mamori/simbody_sim/fault_plan.hpp"
#include "run_record.hpp"
#include "wrong_controller.hpp"

namespace safe_arm {

/// Buttons of the operator.
struct Buttons {
    bool start{false};
    bool reset{false};
};
/// The operator pushes start after the self test. After a stop that the operator demanded by the fault plan
/// (`emergency_stop`, `enabling_squeezed`), the operator pushes reset and, when the next self test has ended,
/// start; after `protective_stop`, `enabling_released` and `run_released`, only start. With `brake_creep`,
/// the first start comes that late.
Buttons calc_buttons(const mamori::sim::FaultPlan& fault, mamori::Instant now) noexcept;

/// Devices of the run. Calls the recorder after each major frame. All references must outlive this object.
class Machine final : public mamori::Devices {
  public:
    /// @param[in] fault with `at` in simulated time.
    Machine(mamori::sim::ArmPlant& plant, mamori::ports::virtual_time::VirtualHost& host,
            const mamori::sim::FaultPlan& fault, RunRecord& record) noexcept
        : plant_(plant),
          host_(host),
          fault_(fault),
          wrong_(static_cast<std::uint64_t>(fault.magnitude)),
          record_(record) {}

    void sample(std::uint64_t frame, mamori::Instant now) noexcept override;
    void apply(std::uint64_t frame, mamori::Instant now, mamori::Duration length) noexcept override;

    /// False after the state of the plant has become infinite or not-a-number.
    bool is_plant_sound() const noexcept { return is_plant_sound_; }

  private:
    void apply_software_faults(mamori::Instant now) noexcept;
    mamori::Duration calc_true_time(mamori::Instant now, mamori::Duration length) noexcept;

    mamori::sim::ArmPlant& plant_;
    mamori::ports::virtual_time::VirtualHost& host_;
    mamori::sim::FaultPlan fault_;
    WrongController wrong_;  ///< of the fault plan
    RunRecord& record_;
    mamori::safety::ArmOutputs applied_{};  ///< those of the frame before once the processor has stopped
    mamori::Duration owed_{};               ///< time of the plant that is shorter than one of its steps
    bool is_plant_sound_{true};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_MACHINE_HPP
