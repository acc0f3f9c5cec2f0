// SPDX-License-Identifier: Apache-2.0
/// @file
/// What assumptions of use ask of Linux, each answered from where it takes effect: the scheduler, the memory,
/// the processor, the watchdog. None of them believes what was asked for at the start.
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

/// A provision that tells "it is not" from "nobody can say", for the sentence that the user reads. To an
/// assumption both are alike: not in effect.
class LinuxProvision : public safety::Provision {
  public:
    /// @return kOk (in effect); kPreconditionNotMet (it is not); kUnsupported (the system does not say).
    virtual Status look() noexcept = 0;
    bool is_in_effect() noexcept final { return look() == Status::kOk; }

  protected:
    ~LinuxProvision() = default;
};

/// All memory of the process is locked: none of its pages has to be fetched in a window.
///
/// Thread safety: look() from one thread at a time. Time: open() opens a file; look() reads it, up to three
/// times, some ten microseconds each: Linux writes it anew. Memory: 4 KiB of the stack in look().
class MemoryLocked final : public LinuxProvision {
  public:
    static constexpr std::uint64_t kKernelBytes = 65536U;

    /// @param[in] unlockable mappings that Linux never locks [byte]: its own (vdso), and memory of devices
    /// and
    ///            huge pages, which the application knows.
    explicit constexpr MemoryLocked(std::uint64_t unlockable = kKernelBytes) noexcept
        : unlockable_(unlockable) {}
    MemoryLocked(const MemoryLocked&) = delete;
    MemoryLocked& operator=(const MemoryLocked&) = delete;
    ~MemoryLocked();

    /// Before the windows run. @return kOk; kPreconditionNotMet (open already); kUnsupported (no /proc here).
    Status open() noexcept;

    /// In effect: what is mapped is locked but for `unlockable`, and nothing is swapped out.
    /// @return as any; kUnsupported while not open, and for a file without these figures in its first 4 KiB,
    ///         as of a user in hundreds of groups.
    Status look() noexcept override;

  private:
    std::uint64_t unlockable_;
    int file_{-1};
};

/// Timers end to the microsecond, not to the tick of the kernel (1 to 10 ms): without them no window opens
/// and no budget ends when it should.
///
/// Thread safety: any thread. Time: one system call. Memory: a word.
class PreciseTimers final : public LinuxProvision {
  public:
    /// @param[in] clock behind the time line; another one than Linux's monotonic clock is for tests.
    explicit constexpr PreciseTimers(clockid_t clock = CLOCK_MONOTONIC) noexcept : clock_(clock) {}
    /// @return as any; kUnsupported when the clock does not tell its resolution.
    Status look() noexcept override;

  private:
    clockid_t clock_;
};

/// The floating-point unit rounds to nearest and keeps denormal numbers **on the calling thread**, which is
/// where Linux keeps its mode; so ask on the thread that calculates. The operations of the unit are the
/// business of safety::CpuCheck.
///
/// Thread safety: any thread. Time: some operations. Memory: none.
class FloatingPointMode final : public LinuxProvision {
  public:
    /// @return kOk; kPreconditionNotMet.
    Status look() noexcept override;
};

/// The guard of budgets can stop the caller: its thread, the one that runs the windows, has a fixed priority
/// above that of the caller's thread, which does the work of a window.
///
/// Thread safety: any thread. Time: two system calls. Memory: a word.
class GuardAbove final : public LinuxProvision {
  public:
    /// Called by the thread that runs the windows, before it does: CoreRunner's.
    void set_guard() noexcept;
    /// @return as any; kPreconditionNotMet also before set_guard() and when that thread has ended;
    ///         kUnsupported when the system lets nobody ask.
    Status look() noexcept override;

  private:
    std::atomic<pid_t> guard_{0};
};

/// The software watchdog is armed: it was served, has not expired and is not closed.
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

/// The machine's watchdog counts down. Wants a timeout of 2 s or more: devices count whole seconds, and 0
/// left is taken for one that stands.
///
/// Thread safety: not beside open() and disarm() of the device. Time: one system call, that of a driver.
class DeviceWatchdogArmed final : public LinuxProvision {
  public:
    /// @param[in] device must outlive this object.
    explicit constexpr DeviceWatchdogArmed(const WatchdogDevice& device) noexcept : device_(device) {}
    /// @return as any; kUnsupported when the driver does not tell the time that is left, as many do not: then
    ///         the assumption is one of the integrator.
    Status look() noexcept override;

  private:
    const WatchdogDevice& device_;
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_PROVISIONS_HPP
