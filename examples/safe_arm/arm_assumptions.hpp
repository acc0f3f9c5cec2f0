// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the safety software of the arm takes for granted about the machine that it runs on, each with its
/// check. The supervisor looks at all of them before the arm may move, and while it moves.
///
/// @satisfies SWR-SAF-021      Design: docs/design/safe_arm.md#assumptions-of-use
#ifndef EXAMPLES_SAFE_ARM_ARM_ASSUMPTIONS_HPP
#define EXAMPLES_SAFE_ARM_ARM_ASSUMPTIONS_HPP

#include "arm_limits.hpp"
#include "mamori/ports/virtual_time/virtual_watchdog.hpp"
#include "mamori/safety/assumptions/assumption_checks.hpp"
#include "mamori/safety/self_test/cpu_check.hpp"

namespace safe_arm {

/// Numbers are arguments of the event kAssumptionFailed; they are never reused, and a new one comes last.
enum class ArmAssumption : mamori::safety::AssumptionIndex {
    kWatchdog,   ///< it watches: without it a hung supervisor would leave the torque on
    kProcessor,  ///< operations and mode of the floating-point unit are those that the guards count on
};

/// The watchdog was served and has not opened its relay.
class WatchdogArmed final : public mamori::safety::Provision {
  public:
    /// @param[in] device must outlive this object.
    explicit constexpr WatchdogArmed(const mamori::ports::virtual_time::VirtualWatchdog& device) noexcept
        : device_(device) {}
    bool is_in_effect() noexcept override { return device_.is_watching(); }

  private:
    const mamori::ports::virtual_time::VirtualWatchdog& device_;
};

/// The checks of one program, in static storage.
struct ArmChecks {
    /// @param[in] device must outlive this object.
    explicit constexpr ArmChecks(const mamori::ports::virtual_time::VirtualWatchdog& device) noexcept
        : armed(device) {}
    ArmChecks(const ArmChecks&) = delete;
    ArmChecks& operator=(const ArmChecks&) = delete;

    WatchdogArmed armed;
    mamori::safety::ProvisionCheck watchdog{armed};
    mamori::safety::CpuCheck<mamori::safety::NativeCpu> patterns{};
    mamori::safety::SelfTestCheck processor{patterns};
};

/// Rows of the table of one program.
constexpr auto make_arm_assumptions(ArmChecks& checks) noexcept {
    using mamori::safety::assume;
    return mamori::parts(assume(ArmAssumption::kWatchdog, "watchdog", checks.watchdog, kSelfTestTime),
                         assume(ArmAssumption::kProcessor, "processor", checks.processor, kSelfTestTime));
}

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_ARM_ASSUMPTIONS_HPP
