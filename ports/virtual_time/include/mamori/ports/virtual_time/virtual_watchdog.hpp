// SPDX-License-Identifier: Apache-2.0
/// @file
/// A hardware watchdog in virtual time. From its first service, it opens its relay permanently if it is not
/// serviced again within its timeout.
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
    /// @param[in] timeout maximum time without a service, > 0.
    constexpr explicit VirtualWatchdog(Duration timeout) noexcept : timeout_(timeout) {
        MAMORI_REQUIRE(1, timeout > Duration{0});
    }

    /// @return kOk; kError (the relay is open permanently).
    Status service(Instant now) noexcept override;

    /// Advances the time of the hardware. The devices call it once per major frame.
    void check(Instant now) noexcept;

    /// True after the relay has opened. Before the first service, the relay stays closed.
    bool has_expired() const noexcept { return has_expired_; }
    /// True from the first service until the relay opens.
    bool is_watching() const noexcept { return is_started_ && !has_expired_; }

  private:
    Duration timeout_;
    Instant serviced_at_{};
    bool is_started_{false};
    bool has_expired_{false};
};

}  // namespace mamori::ports::virtual_time

#endif  // MAMORI_PORTS_VIRTUAL_TIME_VIRTUAL_WATCHDOG_HPP
