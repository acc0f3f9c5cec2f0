// SPDX-License-Identifier: Apache-2.0
/// @file
/// The last acts of a process that crashes: outputs closed, a note behind the flight recorder, then the end
/// that it would have come to anyway, with its status and its core.
///
/// @satisfies SWR-PRT-026, SWR-PRT-027      Design: docs/design/posix_rt.md#crash-handlers
#ifndef MAMORI_PORTS_POSIX_RT_CRASH_HANDLERS_HPP
#define MAMORI_PORTS_POSIX_RT_CRASH_HANDLERS_HPP

#include <signal.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/ports/posix_rt/frame_clock.hpp"

namespace mamori::ports::posix_rt {

/// Signals of a crash. A check of the kernel that fails ends in SIGILL or SIGTRAP, as the processor has it.
inline constexpr std::array<int, 6U> kCrashSignals{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP};

/// What a crash leads to.
struct CrashPlan {
    /// Takes torque and brake current away for good: threads that have not crashed may give commands until
    /// the process is gone. Called in a signal handler, on any thread, at most once: system calls and stores
    /// only, no lock, no heap, nothing that waits.
    void (*close_outputs)(void* context) noexcept;
    void* context{nullptr};  ///< handed to it
    /// Mapped file of a flight recorder with room for a note (crash_note.hpp), from its first byte on; empty:
    /// no note.
    Span<std::byte> file{};
    std::uint32_t session{0U};  ///< of that recorder
    FrameClock clock;           ///< time line of the session
};

/// Handlers of this process. A crash or a failed check of a second thread in the meantime waits for the first
/// to end the process, a second at most; one inside the handlers ends it at once. A crash while another
/// thread handles a failed check closes the outputs by the plan, and waits for that handler likewise.
///
/// Calling context: any thread, before the first deadline. Memory: no heap.
class CrashHandlers final {
  public:
    constexpr CrashHandlers() noexcept = default;
    CrashHandlers(const CrashHandlers&) = delete;
    CrashHandlers& operator=(const CrashHandlers&) = delete;
    ~CrashHandlers() { remove(); }

    /// From here on a crash follows the plan. Threads want a CrashStack each, or the end of their stack is
    /// the end without a plan.
    /// @param[in] plan close_outputs not nullptr; file empty or a page's begin with room for a note.
    /// @return kOk; kBadParameter (the plan); kPreconditionNotMet (this process has handlers already).
    Status install(const CrashPlan& plan) noexcept;
    /// A later crash follows another plan. A plan is in force at each instant. A handler that has begun
    /// follows the previous plan. Not to be called again while it may.
    /// @return kOk; kBadParameter (the plan); kPreconditionNotMet (not installed).
    Status replace(const CrashPlan& plan) noexcept;
    /// Signals do again what they did before; without handlers it does nothing. No thread may crash
    /// meanwhile.
    void remove() noexcept;

  private:
    std::array<struct sigaction, kCrashSignals.size()> previous_{};
    bool is_installed_{false};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_CRASH_HANDLERS_HPP
