// SPDX-License-Identifier: Apache-2.0
/// @file
/// The watchdog device of the computer (`/dev/watchdog`). Once open, it resets the computer unless it is
/// serviced in time. Only disarm() stops it; the end of the program does not.
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

/// System calls for a device. Each behaves like the Linux call and sets `errno` on failure.
struct WatchdogCalls {
    int (*open)(const char* path, int flags);
    int (*control)(int device, unsigned long request, void* argument);  ///< ioctl
    ssize_t (*write)(int device, const void* data, std::size_t size);
    int (*close)(int device);
};

/// The Linux system calls; static storage.
const WatchdogCalls& get_linux_watchdog_calls() noexcept;

/// Cause of a failed open().
enum class WatchdogDeviceError : std::uint8_t {
    kNone,
    kCannotOpen,        ///< does not exist, or permission missing
    kInUse,             ///< another program uses the device
    kNotAWatchdog,      ///< the device is not a watchdog
    kStopsOnClose,      ///< the driver stops the device at the end of the program, also after a crash
    kDoesNotReset,      ///< the device raises an alarm only
    kCannotSetTimeout,  ///< the driver rejects the timeout, and its current timeout is longer
};

/// Message for the user; never nullptr.
const char* describe(WatchdogDeviceError error) noexcept;

/// Owner of an open device.
///
/// Thread safety: none. Time: one system call per function. Most drivers write a register; a driver for a
/// device on a slow bus can wait for milliseconds. Memory: no heap.
class WatchdogDevice final : public safety::Watchdog {
  public:
    /// @param[in] calls must outlive the device.
    explicit WatchdogDevice(const WatchdogCalls& calls = get_linux_watchdog_calls()) noexcept
        : calls_(calls) {}
    WatchdogDevice(const WatchdogDevice&) = delete;
    WatchdogDevice& operator=(const WatchdogDevice&) = delete;
    /// Leaves the device running, because an end without disarm() is not an orderly end.
    ~WatchdogDevice();

    /// Opens and **starts** the device: it must be serviced from now on. If open() fails, it stops the device
    /// again. If the driver does not permit a stop, the device then resets the computer.
    /// @param[in] path path of the device, not nullptr.
    /// @param[in] timeout maximum time without a service, at least 1 s; rounded down to seconds.
    /// @return kOk; kBadParameter (path or timeout); kPreconditionNotMet (open already); kError (every other
    ///         cause). get_error() and get_system_error() return the cause.
    Status open(const char* path, Duration timeout) noexcept;

    /// Restarts the timeout. @return kOk; kError (closed, or rejected by the driver, see get_system_error()).
    Status service(Instant now) noexcept override;

    /// Stops the device for an orderly end. Close the outputs before the call.
    /// @return kOk; kPreconditionNotMet (closed); kError (the driver rejected the stop; the device continues,
    ///         stays open and can be serviced).
    Status disarm() noexcept;

    /// Reads the remaining time from the driver. May be called concurrently with service().
    /// @return remaining time in complete seconds; kPreconditionNotMet (closed); kUnsupported (the driver
    ///         does not report it); kError (the call failed).
    Result<Duration> read_time_left() const noexcept;

    bool is_open() const noexcept { return device_ >= 0; }
    /// Timeout that the driver accepted, at most the requested one; 0 while closed.
    Duration get_timeout() const noexcept { return timeout_; }
    /// True if the driver reports that this device caused the last reset of the computer.
    bool has_reset_machine() const noexcept { return has_reset_machine_; }
    /// Cause of the failure of the last open(); kNone if it succeeded or was not called.
    WatchdogDeviceError get_error() const noexcept { return error_; }
    /// `errno` of the last failed call; 0 if no system call failed.
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
