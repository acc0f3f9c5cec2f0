// SPDX-License-Identifier: Apache-2.0
/// @file
/// The gate before the hardware watchdog: it is serviced on proven health only, and inside its time window.
/// A gate that was late once stays closed, so that the hardware finishes what the software could not.
///
/// @satisfies SWR-WDG-001, SWR-WDG-002, SWR-WDG-003      Design: docs/design/supervision.md#watchdog-gate
/// Source:   IEC 61508-2:2010 Table A.10 (watchdog with separate time base and time window)
#ifndef MAMORI_SAFETY_WATCHDOG_GATE_HPP
#define MAMORI_SAFETY_WATCHDOG_GATE_HPP

#include <cstdint>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/supervision/execution_supervisor.hpp"

namespace mamori::safety {

/// Hardware watchdog as a port offers it. When it is not serviced in its window, the drives lose their
/// torque.
class Watchdog {
  public:
    /// Restarts the watchdog's time. Must not block.
    /// @return kOk; kError (the device did not take the service).
    virtual Status service(Instant now) noexcept = 0;

  protected:
    ~Watchdog() = default;
};

/// Distance between two services. Range: 0 <= shortest < longest.
struct WatchdogWindow {
    Duration shortest{0};
    Duration longest{0};
};

/// True when everything that the watchdog stands for is proven.
/// @param[in] status              global status of this supervision cycle.
/// @param[in] is_state_consistent SafeStateMachine::is_consistent() of this cycle.
constexpr bool may_service_watchdog(GlobalStatus status, bool is_state_consistent) noexcept {
    return is_state_consistent && status == GlobalStatus::kOk;
}

/// What the gate did in one step.
enum class WatchdogOutcome : std::uint8_t {
    kServiced,
    kHeldBack,  ///< healthy, but too early for the window
    kRefused,   ///< health is not proven
    kFailed,    ///< the device did not take the service; tried again in the next step
    kClosed,    ///< the window was missed or the clock ran backwards: no service from here on
};

/// Services a watchdog on proven health.
///
/// Thread safety: none; call step() once per supervision cycle from one execution context.
/// Time:          O(1) plus the service itself. Memory: no heap.
class WatchdogGate final {
  public:
    /// @param[in] watchdog must outlive this object.
    /// @param[in] window   the watchdog's window, narrowed by the jitter of the calling context.
    constexpr WatchdogGate(Watchdog& watchdog, WatchdogWindow window) noexcept
        : watchdog_(watchdog), window_(window) {
        MAMORI_REQUIRE(1, window.shortest >= Duration{0} && window.shortest < window.longest);
    }

    /// Decides about one service and carries it out. The first service has no distance to keep.
    [[nodiscard]] WatchdogOutcome step(Instant now, GlobalStatus status, bool is_state_consistent) noexcept;

    /// Services that the device took, held at the largest number.
    std::uint32_t get_service_count() const noexcept { return service_count_; }
    /// Steps in which health was not proven, held at the largest number.
    std::uint32_t get_refusal_count() const noexcept { return refusal_count_; }
    bool is_closed() const noexcept { return is_closed_; }

  private:
    Watchdog& watchdog_;
    WatchdogWindow window_;
    Instant serviced_at_{};
    std::uint32_t service_count_{0U};
    std::uint32_t refusal_count_{0U};
    bool is_running_{false};
    bool is_closed_{false};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_WATCHDOG_GATE_HPP
