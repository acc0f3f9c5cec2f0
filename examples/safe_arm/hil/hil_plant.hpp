// SPDX-License-Identifier: Apache-2.0
/// @file
/// The arm as hardware behind a link: devices, watchdog relay, and the communication watchdog of the drives.
/// Its time line is that of the major frames of the kernel; without messages, that of its own clock.
///
/// @satisfies SWR-HIL-003      Design: docs/design/safe_arm.md#hardware-in-the-loop
#ifndef EXAMPLES_SAFE_ARM_HIL_HIL_PLANT_HPP
#define EXAMPLES_SAFE_ARM_HIL_HIL_PLANT_HPP

#include <cstdint>
#include <optional>

#include "hil_messages.hpp"
#include "mamori/ports/virtual_time/virtual_watchdog.hpp"
#include "mamori/simbody_sim/arm_plant.hpp"
#include "mamori/simbody_sim/fault_plan.hpp"
#include "run_record.hpp"

namespace safe_arm {

/// Thread safety: none. Time: one integration step of 1 ms per frame. Memory: that of plant and record.
class HilPlant final {
  public:
    /// @param[in] fault with `at` on the time line. All references must outlive this object.
    HilPlant(mamori::sim::ArmPlant& plant, const mamori::sim::FaultPlan& fault, RunRecord& record) noexcept
        : plant_(plant), fault_(fault), record_(record) {}

    /// Sample of all devices at the present instant.
    DeviceFrame answer();
    /// Takes the outputs of a frame and lets the time of this frame pass. Frames that are missing before it
    /// pass with the outputs of the last one.
    void take(const DriveFrame& frame);
    /// No DriveFrame came for kDriveSilenceMax: this time passes with the last outputs; then torque is
    /// removed and the brakes close, permanently.
    void lose_link();
    /// One frame passes without a message, after lose_link().
    void run_alone();

    /// Frames that have passed.
    std::uint64_t get_frame_count() const noexcept { return frame_count_; }
    /// True after the first take(), until lose_link().
    bool is_linked() const noexcept { return is_started_ && !lost_at_.has_value(); }
    /// End of the last frame with a message, once the link is lost.
    std::optional<mamori::Instant> get_lost_at() const noexcept { return lost_at_; }
    /// Instant at which torque and brake release were removed by lose_link().
    std::optional<mamori::Instant> get_closed_at() const noexcept { return closed_at_; }
    /// As the newest message reports them.
    std::uint32_t get_late_windows() const noexcept { return newest_.report.late_windows; }
    /// False once the state of the plant is no longer finite.
    bool is_sound() const noexcept { return is_sound_; }

  private:
    mamori::Instant get_now() const noexcept {
        return mamori::Instant{static_cast<std::int64_t>(frame_count_) * kFrame.ns};
    }
    void step();

    mamori::sim::ArmPlant& plant_;
    mamori::sim::FaultPlan fault_;
    RunRecord& record_;
    mamori::ports::virtual_time::VirtualWatchdog watchdog_{kWatchdogTimeout};
    std::uint32_t service_count_{0U};
    DriveFrame newest_{};
    std::uint64_t frame_count_{0U};
    std::optional<mamori::Instant> lost_at_{};
    std::optional<mamori::Instant> closed_at_{};
    bool is_started_{false};
    bool is_sound_{true};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_HIL_HIL_PLANT_HPP
