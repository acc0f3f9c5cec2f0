// SPDX-License-Identifier: Apache-2.0
/// @file
/// A hardware watchdog in virtual time: once serviced for the first time it wants to be serviced again before
/// its time is over, and opens its relay for good when it is not.
///
/// @satisfies SWR-VTM-005      Design: docs/design/conformance.md#virtual-watchdog
#ifndef MAMORI_PORTS_VIRTUAL_TIME_VIRTUAL_WATCHDOG_HPP
#define MAMORI_PORTS_VIRTUAL_TIME_VIRTUAL_WATCHDOG_HPP

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/supervision/watchdog_gate.hpp"

namespace mamori::ports::virtual_time {

/// Thread safety: none. Time: O(1). Memory: no heap.
class VirtualWatchdog final : public safety::Watchdog {
  public:
    /// @param[in] timeout longest time without a service, > 0.
    constexpr explicit VirtualWatchdog(Duration timeout) noexcept : timeout_(timeout) {
        MAMORI_REQUIRE(1, timeout > Duration{0});
    }

    /// @return kOk; kError (the relay is open: nothing closes it again).
    Status service(Instant now) noexcept override;

    /// Lets the hardware's own time pass. To be called by the devices once per frame.
    void check(Instant now) noexcept;

    /// True once the relay has opened. It stays closed while the watchdog has not been started by a first
    /// service.
    bool has_expired() const noexcept { return has_expired_; }
    /// True from the first service on, until the relay opens.
    bool is_watching() const noexcept { return is_started_ && !has_expired_; }

  private:
    Duration timeout_;
    Instant serviced_at_{};
    bool is_started_{false};
    bool has_expired_{false};
};

}  // namespace mamori::ports::virtual_time

#endif  // MAMORI_PORTS_VIRTUAL_TIME_VIRTUAL_WATCHDOG_HPP
