// SPDX-License-Identifier: Apache-2.0
/// @file
/// A simulated Linux watchdog driver. It behaves as the kernel documentation specifies but resets nothing.
/// One per process, since system calls have no object parameter.
#ifndef MAMORI_PORTS_POSIX_RT_FAKE_DRIVER_HPP
#define MAMORI_PORTS_POSIX_RT_FAKE_DRIVER_HPP

#include <linux/watchdog.h>

#include <atomic>
#include <cerrno>
#include <string>

#include "mamori/ports/posix_rt/watchdog_device.hpp"

namespace mamori::ports::posix_rt {

struct FakeDriver {
    // Properties.
    std::uint32_t options{WDIOF_SETTIMEOUT | WDIOF_MAGICCLOSE | WDIOF_KEEPALIVEPING};
    bool is_watchdog{true};
    bool can_stop{true};  ///< false: built with CONFIG_WATCHDOG_NOWAYOUT
    int longest_s{60};    ///< maximum timeout [s]
    int boot_status{0};
    int device{1000};  ///< number of the descriptor
    // Injected failures (errno); 0: none.
    int open_error{0};
    int set_error{0};
    int get_error{0};
    int left_error{0};
    std::atomic<int> write_error{0};
    // Observed calls.
    std::atomic<int> services{0};
    int opens{0};
    int other_writes{0};
    int timeout_s{30};
    int left_s{30};
    bool is_open{false};
    bool is_running{false};
    bool is_stop_allowed{false};
    std::string path{};

    static FakeDriver& get() {
        static FakeDriver driver;
        return driver;
    }
    static void reset() {
        get().~FakeDriver();
        new (&get()) FakeDriver{};
    }
};

namespace fake_driver {

inline int fail(int error) {
    errno = error;
    return -1;
}

inline int open(const char* path, int) {
    FakeDriver& driver = FakeDriver::get();
    ++driver.opens;
    driver.path = path;
    if (driver.open_error != 0) {
        return fail(driver.open_error);
    }
    driver.is_open = true;
    driver.is_running = driver.is_watchdog;
    return driver.device;
}

inline int control(int, unsigned long request, void* argument) {
    FakeDriver& driver = FakeDriver::get();
    if (!driver.is_watchdog) {
        return fail(ENOTTY);
    }
    switch (request) {
        case WDIOC_GETSUPPORT:
            static_cast<watchdog_info*>(argument)->options = driver.options;
            return 0;
        case WDIOC_GETBOOTSTATUS:
            *static_cast<int*>(argument) = driver.boot_status;
            return 0;
        case WDIOC_SETTIMEOUT: {
            if (driver.set_error != 0) {
                return fail(driver.set_error);
            }
            const int wanted = *static_cast<int*>(argument);
            driver.timeout_s = wanted < driver.longest_s ? wanted : driver.longest_s;
            return 0;
        }
        case WDIOC_GETTIMEOUT:
            if (driver.get_error != 0) {
                return fail(driver.get_error);
            }
            *static_cast<int*>(argument) = driver.timeout_s;
            return 0;
        case WDIOC_GETTIMELEFT:
            if (driver.left_error != 0) {
                return fail(driver.left_error);
            }
            *static_cast<int*>(argument) = driver.left_s;
            return 0;
        default:
            return fail(ENOTTY);
    }
}

inline ssize_t write(int, const void* data, std::size_t size) {
    FakeDriver& driver = FakeDriver::get();
    if (!driver.is_watchdog) {
        ++driver.other_writes;
        return static_cast<ssize_t>(size);
    }
    if (driver.write_error != 0) {
        return fail(driver.write_error);
    }
    driver.is_stop_allowed = *static_cast<const char*>(data) == 'V';
    driver.services += driver.is_stop_allowed ? 0 : 1;
    return static_cast<ssize_t>(size);
}

inline int close(int) {
    FakeDriver& driver = FakeDriver::get();
    driver.is_open = false;
    const bool stops = driver.is_stop_allowed || (driver.options & WDIOF_MAGICCLOSE) == 0U;
    const bool is_stopped = stops && driver.can_stop;
    driver.is_running = driver.is_running && !is_stopped;
    return 0;
}

}  // namespace fake_driver

inline constexpr WatchdogCalls kFakeCalls{&fake_driver::open, &fake_driver::control, &fake_driver::write,
                                          &fake_driver::close};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_FAKE_DRIVER_HPP
