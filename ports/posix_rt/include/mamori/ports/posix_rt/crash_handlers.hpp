// SPDX-License-Identifier: Apache-2.0
/// @file
/// Handlers of a crash. They close the outputs, write a crash record after the flight recorder, and then let
/// the process end as without handlers: with the same status and core file.
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

/// Signals of a crash. A failed check of the kernel raises SIGILL or SIGTRAP, depending on the processor.
inline constexpr std::array<int, 6U> kCrashSignals{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP};

/// Actions after a crash.
struct CrashPlan {
    /// Removes torque and brake current permanently: until the process has ended, other threads can still
    /// send commands. Called at most once, in a signal handler on any thread. Use system calls and stores
    /// only: no lock, no heap, no wait.
    void (*close_outputs)(void* context) noexcept;
    void* context{nullptr};  ///< argument of close_outputs
    /// Complete mapped file of a flight recorder with space for a crash record (crash_note.hpp). Empty: no
    /// crash record.
    Span<std::byte> file{};
    std::uint32_t session{0U};  ///< session of this recorder
    FrameClock clock;           ///< time line of the session
};

/// Handlers of this process. If a second thread crashes or fails a check meanwhile, it waits at most 1 s
/// until the first thread has ended the process. A crash inside the handlers ends the process immediately. A
/// crash while another thread handles a failed check closes the outputs according to the plan and waits at
/// most 1 s for that handler.
///
/// Calling context: any thread, before the first deadline. Memory: no heap.
class CrashHandlers final {
  public:
    constexpr CrashHandlers() noexcept = default;
    CrashHandlers(const CrashHandlers&) = delete;
    CrashHandlers& operator=(const CrashHandlers&) = delete;
    ~CrashHandlers() { remove(); }

    /// Activates the plan. Each thread needs a CrashStack: without it, a stack overflow of the thread ends
    /// the process without the actions of the plan.
    /// @param[in] plan close_outputs not nullptr; file empty, or page-aligned with space for a crash record.
    /// @return kOk; kBadParameter (the plan); kPreconditionNotMet (this process has handlers already).
    Status install(const CrashPlan& plan) noexcept;
    /// Replaces the plan for later crashes. A plan is active at each instant. A handler that has begun uses
    /// the previous plan; do not call replace() again while such a handler can run.
    /// @return kOk; kBadParameter (the plan); kPreconditionNotMet (not installed).
    Status replace(const CrashPlan& plan) noexcept;
    /// Restores the previous signal actions. Without handlers, the call has no effect. No thread may crash
    /// during the call.
    void remove() noexcept;

  private:
    std::array<struct sigaction, kCrashSignals.size()> previous_{};
    bool is_installed_{false};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_CRASH_HANDLERS_HPP
