// SPDX-License-Identifier: Apache-2.0
/// @file
/// A watchdog without a device: a thread with the highest priority closes the outputs if it is not serviced
/// in time. A watchdog device, if present, supervises this thread.
///
/// @satisfies SWR-PRT-020, SWR-PRT-021, SWR-PRT-022, SWR-PRT-025, SWR-PRT-040, SWR-PRT-041
/// Design: docs/design/posix_rt.md#watchdog
#ifndef MAMORI_PORTS_POSIX_RT_SOFTWARE_WATCHDOG_HPP
#define MAMORI_PORTS_POSIX_RT_SOFTWARE_WATCHDOG_HPP

#include <pthread.h>
#include <semaphore.h>

#include <atomic>
#include <cstdint>
#include <limits>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/ports/posix_rt/crash_stack.hpp"
#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/ports/posix_rt/real_time_rights.hpp"
#include "mamori/ports/posix_rt/watchdog_device.hpp"
#include "mamori/safety/supervision/watchdog_gate.hpp"

namespace mamori::ports::posix_rt {

/// Reaction of the watchdog. It runs once, on the watchdog thread.
struct WatchdogReaction {
    /// Removes torque and brake current permanently: later commands must not restore them. Must not block and
    /// must not wait for a lock of the supervised code.
    void (*close_outputs)(void* context) noexcept;
    void* context{nullptr};    ///< argument of close_outputs
    bool ends_process{false};  ///< call abort() afterwards, so that the crash handlers record it
};

/// Why a watchdog expired.
enum class WatchdogCause : std::uint8_t {
    kNone,    ///< the watchdog has not expired
    kLate,    ///< not serviced in time
    kEarly,   ///< serviced before the service window: a runaway loop
    kDevice,  ///< the device rejected a service, so this watchdog is unsupervised
};

/// Inactive until the first service. Then each service must occur within the service window after the
/// previous one. An expired watchdog stays expired until the program is restarted.
///
/// Thread safety: service() from one context, has_expired(), get_cause() and is_watching() from any, all
///                other functions before and after use. Time: service() reads the clock and does one atomic
///                exchange, the first call also a system call; it never waits. Memory: no heap; the thread
///                and its alternate signal stack.
class SoftwareWatchdog final : public safety::Watchdog {
  public:
    /// @param[in] clock clock of the watchdog, must outlive it; the times that callers pass are not used.
    /// @param[in] window   0 <= shortest < longest.
    /// @param[in] reaction close_outputs not nullptr.
    SoftwareWatchdog(const FrameClock& clock, safety::WatchdogWindow window,
                     WatchdogReaction reaction) noexcept
        : clock_(clock), window_(window), reaction_(reaction) {
        MAMORI_REQUIRE(1, window.shortest >= Duration{0} && window.shortest < window.longest);
        MAMORI_REQUIRE(2, reaction.close_outputs != nullptr);
    }
    SoftwareWatchdog(const SoftwareWatchdog&) = delete;
    SoftwareWatchdog& operator=(const SoftwareWatchdog&) = delete;
    /// Destruction while open is a contract violation: the supervision would end unnoticed.
    ~SoftwareWatchdog() { MAMORI_REQUIRE(3, !is_open_); }

    /// Starts the thread. @param[in] place priority above all supervised threads.
    /// @param[in] device nullptr, or an open device that stays open until close(). The thread services it
    ///            four times per timeout until this watchdog expires.
    /// @return kOk; kPreconditionNotMet (open already, or the device is closed); kOutOfResources (no thread);
    ///         kBadParameter (priority not above the fixed priority of the calling thread: the watchdog could
    ///         not run while this thread hangs).
    Status open(ThreadPlace place, WatchdogDevice* device = nullptr) noexcept;
    /// Ends the supervision deliberately. Close the outputs before the call. The owner of a device disarms
    /// it. An expired watchdog stays expired. @return kOk; kPreconditionNotMet (closed already).
    Status close() noexcept;

    /// @return kOk; kError (closed, or expired, also if this service is late or early).
    Status service(Instant now) noexcept override;

    /// True as soon as the time has elapsed, also if the thread has not reacted yet.
    bool has_expired() const noexcept;
    WatchdogCause get_cause() const noexcept;
    /// True from the first service until the watchdog expires or is closed.
    bool is_watching() const noexcept;

    /// Result of the request for a priority in open().
    Right get_priority_right() const noexcept { return priority_right_; }

  private:
    // Values of state_ other than the instant of the last service. No clock of this port reaches them.
    static constexpr std::int64_t kClosed = std::numeric_limits<std::int64_t>::min();
    static constexpr std::int64_t kSilent = kClosed + 1;
    static constexpr std::int64_t kExpired = std::numeric_limits<std::int64_t>::max() - 3;  ///< plus cause

    static void* serve(void* argument) noexcept;
    void watch() noexcept;
    void watch_until_expired() noexcept;
    WatchdogCause evaluate(std::int64_t state, Instant now) const noexcept;
    bool is_device_lost(Instant now) noexcept;
    void wait_for_change(std::int64_t state) noexcept;
    bool has_expired_in(std::int64_t state) const noexcept { return state > kExpired; }

    const FrameClock& clock_;
    safety::WatchdogWindow window_;
    WatchdogReaction reaction_;
    std::atomic<std::int64_t> state_{kClosed};
    std::atomic<bool> is_ending_{false};
    WatchdogDevice* device_{nullptr};
    Instant device_due_{};
    Right priority_right_{};
    pthread_t thread_{};
    sem_t changed_{};  ///< posted at the first service, expiry by a service, and end
    CrashStack crash_stack_{};
    bool is_open_{false};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_SOFTWARE_WATCHDOG_HPP
