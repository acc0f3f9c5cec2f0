// SPDX-License-Identifier: Apache-2.0
/// @file
/// Platform properties of Linux that assumptions of use require. Each is read where it takes effect: from the
/// scheduler, the memory, the processor or the watchdog, not from the settings requested at the start.
///
/// @satisfies SWR-AOU-011, SWR-AOU-012, SWR-AOU-013, SWR-AOU-014, SWR-AOU-015, SWR-AOU-016
/// Design:   docs/design/assumptions.md#linux
#ifndef MAMORI_PORTS_POSIX_RT_PROVISIONS_HPP
#define MAMORI_PORTS_POSIX_RT_PROVISIONS_HPP

#include <sys/types.h>
#include <time.h>

#include <atomic>
#include <cstdint>

#include "mamori/kernel/base/status.hpp"
#include "mamori/ports/posix_rt/software_watchdog.hpp"
#include "mamori/ports/posix_rt/watchdog_device.hpp"
#include "mamori/safety/assumptions/assumption_checks.hpp"

namespace mamori::ports::posix_rt {

/// Platform property that distinguishes "not in effect" from "not known" for the message to the user. An
/// assumption treats both as not in effect.
class LinuxProvision : public safety::Provision {
  public:
    /// @return kOk (in effect); kPreconditionNotMet (not in effect); kUnsupported (the system does not report
    ///         it).
    virtual Status look() noexcept = 0;
    bool is_in_effect() noexcept final { return look() == Status::kOk; }

  protected:
    ~LinuxProvision() = default;
};

/// All memory of the process is locked, so that no window waits for a page.
///
/// Thread safety: look() from one thread at a time. Time: open() opens a file; look() reads it up to three
/// times, some ten microseconds each, since Linux generates it for each reading. Memory: 4 KiB of the stack
/// in look().
class MemoryLocked final : public LinuxProvision {
  public:
    static constexpr std::uint64_t kKernelBytes = 65536U;

    /// @param[in] unlockable size of mappings that Linux never locks [byte]: those of the kernel (vdso), and
    /// device memory and huge pages, which the application knows.
    explicit constexpr MemoryLocked(std::uint64_t unlockable = kKernelBytes) noexcept
        : unlockable_(unlockable) {}
    MemoryLocked(const MemoryLocked&) = delete;
    MemoryLocked& operator=(const MemoryLocked&) = delete;
    ~MemoryLocked();

    /// Call it before the windows run.
    /// @return kOk; kPreconditionNotMet (open already); kUnsupported (no /proc).
    Status open() noexcept;

    /// In effect if all mapped memory except `unlockable` is locked, and no page is swapped out.
    /// @return as LinuxProvision; kUnsupported also while not open, and if the first 4 KiB of the file lack
    ///         these figures (a user in hundreds of groups).
    Status look() noexcept override;

  private:
    std::uint64_t unlockable_;
    int file_{-1};
};

/// High-resolution timers: they expire within microseconds, not at the next tick of the kernel (1 to 10 ms).
/// Without them, windows start late and budgets end late.
///
/// Thread safety: any thread. Time: one system call. Memory: one integer.
class PreciseTimers final : public LinuxProvision {
  public:
    /// @param[in] clock clock of the time line; clocks other than CLOCK_MONOTONIC are for tests.
    explicit constexpr PreciseTimers(clockid_t clock = CLOCK_MONOTONIC) noexcept : clock_(clock) {}
    /// @return as LinuxProvision; kUnsupported if the clock does not report its resolution.
    Status look() noexcept override;

  private:
    clockid_t clock_;
};

/// The floating-point unit rounds to nearest and keeps denormal numbers **on the calling thread**. Linux
/// stores this mode per thread, so call look() on the thread that calculates. safety::CpuCheck tests the
/// operations of the unit.
///
/// Thread safety: any thread. Time: a few floating-point operations. Memory: none.
class FloatingPointMode final : public LinuxProvision {
  public:
    /// @return kOk; kPreconditionNotMet.
    Status look() noexcept override;
};

/// The guard of the budgets can preempt the work of a window: the thread that runs the windows has a fixed
/// priority above that of the calling thread, which does the work.
///
/// Thread safety: any thread. Time: two system calls. Memory: one integer.
class GuardAbove final : public LinuxProvision {
  public:
    /// Call it on the thread of the CoreRunner, before it runs the windows.
    void set_guard() noexcept;
    /// @return as LinuxProvision; kPreconditionNotMet also before set_guard() and after that thread has
    ///         ended; kUnsupported if the system denies the query.
    Status look() noexcept override;

  private:
    std::atomic<pid_t> guard_{0};
};

/// The software watchdog is armed: it was serviced, has not expired and is not closed.
///
/// Thread safety: any thread. Time: one reading of the clock. Memory: a reference.
class SoftwareWatchdogArmed final : public LinuxProvision {
  public:
    /// @param[in] watchdog must outlive this object.
    explicit constexpr SoftwareWatchdogArmed(const SoftwareWatchdog& watchdog) noexcept
        : watchdog_(watchdog) {}
    /// @return kOk; kPreconditionNotMet.
    Status look() noexcept override;

  private:
    const SoftwareWatchdog& watchdog_;
};

/// The watchdog device of the computer counts down. Requires a timeout of at least 2 s: devices count in
/// seconds, and a remaining time of 0 counts as stopped.
///
/// Thread safety: not concurrently with open() and disarm() of the device. Time: one system call of a driver.
class DeviceWatchdogArmed final : public LinuxProvision {
  public:
    /// @param[in] device must outlive this object.
    explicit constexpr DeviceWatchdogArmed(const WatchdogDevice& device) noexcept : device_(device) {}
    /// @return as LinuxProvision; kUnsupported if the driver does not report the remaining time, as many do
    ///         not. Then the integrator must show that the assumption holds.
    Status look() noexcept override;

  private:
    const WatchdogDevice& device_;
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_PROVISIONS_HPP
