// SPDX-License-Identifier: Apache-2.0
/// @file
/// The machine's own watchdog as Linux offers it (`/dev/watchdog`): once it is open it resets the machine
/// unless it is served again in time. It is told to stop by a deliberate disarm() only, never by an end of
/// the program.
///
/// @satisfies SWR-PRT-023, SWR-PRT-024      Design: docs/design/posix_rt.md#watchdog-device
/// Source:   Linux kernel, Documentation/watchdog/watchdog-api.rst
#ifndef MAMORI_PORTS_POSIX_RT_WATCHDOG_DEVICE_HPP
#define MAMORI_PORTS_POSIX_RT_WATCHDOG_DEVICE_HPP

#include <sys/types.h>

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/supervision/watchdog_gate.hpp"

namespace mamori::ports::posix_rt {

/// System calls that a device is driven by; each as the one of its name, with `errno` behind a failure.
struct WatchdogCalls {
    int (*open)(const char* path, int flags);
    int (*control)(int device, unsigned long request, void* argument);  ///< ioctl
    ssize_t (*write)(int device, const void* data, std::size_t size);
    int (*close)(int device);
};

/// Those of Linux; static storage.
const WatchdogCalls& get_linux_watchdog_calls() noexcept;

/// Why a device was not taken.
enum class WatchdogDeviceError : std::uint8_t {
    kNone,
    kCannotOpen,        ///< not there, or no permission
    kInUse,             ///< another program has it
    kNotAWatchdog,      ///< it does not answer as one
    kStopsOnClose,      ///< its driver stops it when the program ends, so also after a crash
    kDoesNotReset,      ///< it raises an alarm only
    kCannotSetTimeout,  ///< neither does the driver take the timeout nor is the one that it has short enough
};

/// A sentence for the user; never nullptr.
const char* describe(WatchdogDeviceError error) noexcept;

/// Owner of an open device.
///
/// Thread safety: none. Time: a system call for each member; most drivers write a register, one behind a slow
/// bus may wait for milliseconds. Memory: no heap.
class WatchdogDevice final : public safety::Watchdog {
  public:
    /// @param[in] calls must outlive the device.
    explicit WatchdogDevice(const WatchdogCalls& calls = get_linux_watchdog_calls()) noexcept
        : calls_(calls) {}
    WatchdogDevice(const WatchdogDevice&) = delete;
    WatchdogDevice& operator=(const WatchdogDevice&) = delete;
    /// Leaves the device running: whoever goes without disarm() has not ended in good order.
    ~WatchdogDevice();

    /// Opens the device, which **starts** it: from here on it wants to be served. One that is refused is
    /// stopped again; a driver that was built not to be stopped goes on and resets the machine.
    /// @param[in] path of the device, not nullptr. @param[in] timeout longest time without a service, from
    ///            1 s on; the driver counts whole seconds, a fraction is cut off.
    /// @return kOk; kBadParameter (path or timeout); kPreconditionNotMet (open already); kError (every other
    ///         cause): get_error() and get_system_error() tell it.
    Status open(const char* path, Duration timeout) noexcept;

    /// Restarts its time. @return kOk; kError (the driver refused, see get_system_error(), or it is closed).
    Status service(Instant now) noexcept override;

    /// Stops the device, at an orderly end: outputs closed, nothing left to watch.
    /// @return kOk; kPreconditionNotMet (closed); kError (the driver did not take it: it goes on, stays open
    ///         and can be served).
    Status disarm() noexcept;

    /// Asks the driver how long it still waits for a service. May be called beside service().
    /// @return whole seconds; kPreconditionNotMet (closed); kUnsupported (the driver does not tell); kError
    ///         (it failed to).
    Result<Duration> read_time_left() const noexcept;

    bool is_open() const noexcept { return device_ >= 0; }
    /// What the driver granted, not longer than what was asked for; 0 while closed.
    Duration get_timeout() const noexcept { return timeout_; }
    /// Whether this device has caused the last start of the machine, as far as the driver knows.
    bool has_reset_machine() const noexcept { return has_reset_machine_; }
    /// Cause of the last open() that failed; kNone before it, and after one that did not.
    WatchdogDeviceError get_error() const noexcept { return error_; }
    /// `errno` of the last call that failed; 0 where the system had no objection.
    int get_system_error() const noexcept { return system_error_; }

  private:
    WatchdogDeviceError take(int device, int seconds) noexcept;
    WatchdogDeviceError agree_on_timeout(int device, int seconds, bool can_set) noexcept;

    const WatchdogCalls& calls_;
    int device_{-1};
    int system_error_{0};
    Duration timeout_{0};
    WatchdogDeviceError error_{WatchdogDeviceError::kNone};
    bool has_reset_machine_{false};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_WATCHDOG_DEVICE_HPP
