// SPDX-License-Identifier: Apache-2.0
/// @file
/// A watchdog that needs no device: a thread above all others that closes the outputs when it is not served
/// in time. Where the machine has a device, that one watches over this thread.
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

/// What the watchdog does, once, on its own thread.
struct WatchdogReaction {
    /// Takes torque and brake current away for good: commands that come later must not give them back. Must
    /// neither block nor wait for a lock of the code that is watched.
    void (*close_outputs)(void* context) noexcept;
    void* context{nullptr};    ///< handed to it
    bool ends_process{false};  ///< abort() afterwards, so that the crash handlers tell of it
};

/// Why a watchdog expired.
enum class WatchdogCause : std::uint8_t {
    kNone,    ///< it has not
    kLate,    ///< no service in time
    kEarly,   ///< a service before the window was open: a loop that runs wild
    kDevice,  ///< the device behind it did not take a service, so nothing watches over this watchdog
};

/// Silent until its first service; from then on each must come in its window after the one before. Expired,
/// it stays so: whoever wants to go on starts the program again.
///
/// Thread safety: service() from one context, has_expired(), get_cause() and is_watching() from any, the
///                rest before and after. Time: service() is a reading of the clock and one exchange, at its
///                first call a system call too; it never waits. Memory: no heap; the thread, and its second
///                stack.
class SoftwareWatchdog final : public safety::Watchdog {
  public:
    /// @param[in] clock    the watchdog's own, must outlive it; what callers take for the time is not asked.
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
    /// One that is still open is an own bug: nobody would watch from here on.
    ~SoftwareWatchdog() { MAMORI_REQUIRE(3, !is_open_); }

    /// Starts the thread. @param[in] place priority above everything that is watched.
    /// @param[in] device nullptr, or open and to be left so until close(); served by the thread four times in
    ///            its timeout, as long as this watchdog has not expired.
    /// @return kOk; kPreconditionNotMet (open already, or the device is closed); kOutOfResources (no thread);
    ///         kBadParameter (the calling thread has a fixed priority that `place` is not above: the watchdog
    ///         could not run while this thread hangs).
    Status open(ThreadPlace place, WatchdogDevice* device = nullptr) noexcept;
    /// Ends the watching, on purpose and with the outputs closed. A device is disarmed by its owner. An
    /// expired watchdog stays expired. @return kOk; kPreconditionNotMet (closed already).
    Status close() noexcept;

    /// @return kOk; kError (expired, by this service too if it is late or early; or closed).
    Status service(Instant now) noexcept override;

    /// True from the instant on at which the time is over, be it that the thread is only about to react.
    bool has_expired() const noexcept;
    WatchdogCause get_cause() const noexcept;
    /// True from the first service on, as long as it has neither expired nor been closed.
    bool is_watching() const noexcept;

    /// What the thread was given in open().
    Right get_priority_right() const noexcept { return priority_right_; }

  private:
    // What state_ says beside the instant of the last service, where no clock of this port comes to.
    static constexpr std::int64_t kClosed = std::numeric_limits<std::int64_t>::min();
    static constexpr std::int64_t kSilent = kClosed + 1;
    static constexpr std::int64_t kExpired = std::numeric_limits<std::int64_t>::max() - 3;  ///< plus cause

    static void* serve(void* argument) noexcept;
    void watch() noexcept;
    void watch_until_expired() noexcept;
    WatchdogCause judge(std::int64_t state, Instant now) const noexcept;
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
    sem_t changed_{};  ///< first service, expired by a service, ending
    CrashStack crash_stack_{};
    bool is_open_{false};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_SOFTWARE_WATCHDOG_HPP
