// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/watchdog_device.hpp"

#include <fcntl.h>
#include <linux/watchdog.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <limits>

namespace mamori::ports::posix_rt {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
/// Non-blocking, so that a pipe or terminal is rejected without a wait.
constexpr int kFlags = O_WRONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;
/// This byte stops the device if it is written before close(). Any other byte is a service.
constexpr char kStop = 'V';
constexpr char kServe = '\0';

int open_device(const char* path, int flags) {
    return ::open(path, flags);
}
int control_device(int device, unsigned long request, void* argument) {
    return ::ioctl(device, request, argument);
}

constexpr WatchdogCalls kLinuxCalls{&open_device, &control_device, &::write, &::close};

}  // namespace

const WatchdogCalls& get_linux_watchdog_calls() noexcept {
    return kLinuxCalls;
}

const char* describe(WatchdogDeviceError error) noexcept {
    switch (error) {
        case WatchdogDeviceError::kNone:
            return "watches";
        case WatchdogDeviceError::kCannotOpen:
            return "cannot be opened for writing: check the path and its permissions";
        case WatchdogDeviceError::kInUse:
            return "is in use by another program: end that program, often a system service";
        case WatchdogDeviceError::kNotAWatchdog:
            return "is not a watchdog: specify a watchdog device";
        case WatchdogDeviceError::kStopsOnClose:
            return "stops when the program ends, also after a crash: use a driver with magic close";
        case WatchdogDeviceError::kDoesNotReset:
            return "raises an alarm but does not reset the computer: use another device";
        case WatchdogDeviceError::kCannotSetTimeout:
            return "rejects the timeout: use one that its driver supports";
    }
    return "failed for an unknown reason";  // reached with a corrupted value only
}

WatchdogDevice::~WatchdogDevice() {
    if (is_open()) {
        static_cast<void>(calls_.close(device_));
    }
}

Status WatchdogDevice::open(const char* path, Duration timeout) noexcept {
    if (is_open()) {
        return Status::kPreconditionNotMet;
    }
    const std::int64_t seconds = timeout.ns / kSecondNs;
    if (path == nullptr || seconds < 1 || seconds > std::numeric_limits<int>::max()) {
        return Status::kBadParameter;
    }
    system_error_ = 0;
    const int device = calls_.open(path, kFlags);
    if (device < 0) {
        system_error_ = errno;
        error_ = errno == EBUSY ? WatchdogDeviceError::kInUse : WatchdogDeviceError::kCannotOpen;
        return Status::kError;
    }
    error_ = take(device, static_cast<int>(seconds));
    if (error_ == WatchdogDeviceError::kNone) {
        device_ = device;
        return Status::kOk;
    }
    // The device is not in use yet, so it must not reset the computer. Nothing is written to a file that is
    // not a watchdog.
    if (error_ != WatchdogDeviceError::kNotAWatchdog) {
        static_cast<void>(calls_.write(device, &kStop, 1U));
    }
    static_cast<void>(calls_.close(device));
    timeout_ = Duration{0};
    return Status::kError;
}

/// Checks an open device.
WatchdogDeviceError WatchdogDevice::take(int device, int seconds) noexcept {
    watchdog_info info{};
    if (calls_.control(device, WDIOC_GETSUPPORT, &info) != 0) {
        system_error_ = errno;
        return WatchdogDeviceError::kNotAWatchdog;
    }
    if ((info.options & WDIOF_MAGICCLOSE) == 0U) {
        return WatchdogDeviceError::kStopsOnClose;
    }
    if ((info.options & WDIOF_ALARMONLY) != 0U) {
        return WatchdogDeviceError::kDoesNotReset;
    }
    int causes = 0;
    // Not every driver reports the last reset.
    has_reset_machine_ =
        calls_.control(device, WDIOC_GETBOOTSTATUS, &causes) == 0 && (causes & WDIOF_CARDRESET) != 0;
    return agree_on_timeout(device, seconds, (info.options & WDIOF_SETTIMEOUT) != 0U);
}

/// A driver may round the timeout, so the value that it reports afterwards is checked.
WatchdogDeviceError WatchdogDevice::agree_on_timeout(int device, int seconds, bool can_set) noexcept {
    int wanted = seconds;
    if (can_set && calls_.control(device, WDIOC_SETTIMEOUT, &wanted) != 0) {
        system_error_ = errno;
        return WatchdogDeviceError::kCannotSetTimeout;
    }
    int granted = 0;
    if (calls_.control(device, WDIOC_GETTIMEOUT, &granted) != 0) {
        system_error_ = errno;
        return WatchdogDeviceError::kCannotSetTimeout;
    }
    if (granted < 1 || granted > seconds) {
        return WatchdogDeviceError::kCannotSetTimeout;
    }
    timeout_ = Duration{granted * kSecondNs};
    return WatchdogDeviceError::kNone;
}

Status WatchdogDevice::service(Instant) noexcept {
    if (!is_open()) {
        return Status::kError;
    }
    if (calls_.write(device_, &kServe, 1U) != 1) {
        system_error_ = errno;
        return Status::kError;
    }
    return Status::kOk;
}

Result<Duration> WatchdogDevice::read_time_left() const noexcept {
    if (!is_open()) {
        return Status::kPreconditionNotMet;
    }
    int seconds = 0;
    if (calls_.control(device_, WDIOC_GETTIMELEFT, &seconds) != 0) {
        return errno == EOPNOTSUPP || errno == ENOTTY ? Status::kUnsupported : Status::kError;
    }
    return Duration{seconds * kSecondNs};
}

Status WatchdogDevice::disarm() noexcept {
    if (!is_open()) {
        return Status::kPreconditionNotMet;
    }
    if (calls_.write(device_, &kStop, 1U) != 1) {
        system_error_ = errno;
        return Status::kError;
    }
    static_cast<void>(calls_.close(device_));
    device_ = -1;
    timeout_ = Duration{0};
    return Status::kOk;
}

}  // namespace mamori::ports::posix_rt
