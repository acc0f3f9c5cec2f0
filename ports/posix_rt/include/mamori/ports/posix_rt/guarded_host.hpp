// SPDX-License-Identifier: Apache-2.0
/// @file
/// Clock and budget guard of one core in real time. Each window has a thread of its own that does its work;
/// the thread that runs the executive only waits for it, at a higher priority and never beyond the deadline.
/// So a budget is enforced without the help of the code that exceeds it, and a hang costs its window alone.
///
/// @satisfies SWR-PRT-003, SWR-PRT-004, SWR-PRT-035, SWR-PRT-040, SWR-PRT-041, SWR-PRT-042, SWR-PRT-060
/// @satisfies SWR-PRT-080
///     Design: docs/design/posix_rt.md#guard, docs/design/posix_rt.md#stacks
#ifndef MAMORI_PORTS_POSIX_RT_GUARDED_HOST_HPP
#define MAMORI_PORTS_POSIX_RT_GUARDED_HOST_HPP

#include <pthread.h>
#include <semaphore.h>

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/component/window_host.hpp"
#include "mamori/kernel/table/window_row.hpp"
#include "mamori/ports/posix_rt/crash_stack.hpp"
#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/ports/posix_rt/real_time_rights.hpp"

namespace mamori::ports::posix_rt {

/// Thread of one window. Storage and the size of its stack: GuardedHost starts and uses it.
///
/// Work that hangs for ever keeps its thread, so this must have static storage.
class WindowThread final {
  public:
    WindowThread() noexcept = default;
    WindowThread(const WindowThread&) = delete;
    WindowThread& operator=(const WindowThread&) = delete;

    /// Sets the stack of the thread for the next GuardedHost::open(). It holds the frames of all components
    /// of the window and up to kThreadStackMin of the C library and a signal frame.
    /// @param[in] size [byte]; the thread gets at least kThreadStackMin and whole pages. 0 (initially): the
    ///            size in the ThreadPlace of the host.
    /// @return kOk; kPreconditionNotMet (the thread runs).
    Status set_stack_size(std::size_t size) noexcept;
    /// Limits the processor time of each instance of the window, in addition to its deadline: for a
    /// background window, which is preempted. Instances differ in their deadlines.
    /// @param[in] budget WindowRow::execution_budget; 0 (initially): no limit.
    /// @return kOk; kBadParameter (negative); kPreconditionNotMet (the thread runs).
    Status set_execution_budget(Duration budget) noexcept;
    /// @return the size that was set [byte]; 0: that of the host.
    std::size_t get_stack_size() const noexcept { return stack_size_; }

  private:
    friend class GuardedHost;
    static void* serve(void* argument) noexcept;
    void work_off() noexcept;
    bool is_exhausted(std::int64_t used_ns) const noexcept {
        return execution_budget_ > Duration{0} && used_ns > used_max_ns_;
    }
    bool is_out() const noexcept { return done_.load(std::memory_order_acquire) != asked_; }

    const FrameClock* clock_{nullptr};
    pthread_t thread_{};
    sem_t wanted_{};
    sem_t returned_{};  ///< may be posted once too often: only done_ tells
    CrashStack crash_stack_{};
    WindowHost::Work work_{};
    Instant deadline_{};
    Duration execution_budget_{};
    std::int64_t used_max_ns_{0};          ///< processor time of the thread at the end of this budget
    std::uint32_t asked_{0U};              ///< pieces of work so far
    std::atomic<std::uint32_t> done_{0U};  ///< the last of them that has come back
    std::atomic<std::size_t> finished_count_{0U};
    std::atomic<bool> is_ending_{false};
    std::size_t stack_size_{0U};
    int priority_{0};  ///< in force while the thread is not demoted
    bool is_open_{false};
    bool is_demoted_{false};
};

/// Calling context: the thread that runs the windows of the core, and before and after it the thread that
/// opens and closes the host and calls actions outside windows (ActionGuard). Time: two switches of threads
/// per piece of work. Memory: none of its own.
class GuardedHost final : public WindowHost {
  public:
    /// @param[in] threads one per window of the system table; must outlive the host, and for ever when work
    ///            of one hangs. @param[in] clock must outlive the host, and those threads.
    /// @param[in] place of the threads of the windows, and the stack of each that has no size of its own
    ///            (WindowThread::set_stack_size()). A fixed priority must be lower than that of the thread
    ///            that runs the windows; each gets it or, when it is denied, none. With priority 0 the
    ///            windows run in ordinary threads, whatever the thread has that opens the host.
    GuardedHost(Span<WindowThread> threads, const FrameClock& clock, ThreadPlace place) noexcept
        : threads_(threads), clock_(clock), place_(place) {}
    GuardedHost(const GuardedHost&) = delete;
    GuardedHost& operator=(const GuardedHost&) = delete;
    ~GuardedHost() = default;

    /// The same for one executive of a system: starts only the threads of its windows. @param[in] windows of
    /// the system, one per thread; must outlive the host. @param[in] core the executive.
    GuardedHost(Span<WindowThread> threads, Span<const WindowRow> windows, std::size_t core,
                const FrameClock& clock, ThreadPlace place) noexcept
        : threads_(threads), windows_(windows), core_(core), clock_(clock), place_(place) {}

    /// Starts the threads; the calling thread is the one that will run the windows.
    /// @return kOk; kPreconditionNotMet (open already); kOutOfResources (no thread, or none with its stack);
    ///         kBadParameter (the windows have a fixed priority that is not below that of the thread that
    ///         runs them, so a window that hangs would stop its own guard). On an error none of the threads
    ///         that it started is left.
    Status open() noexcept;
    /// The same when another thread will run the windows. @param[in] runner_priority fixed priority that this
    /// thread has or will have, 1 .. 99; 0: none.
    Status open(int runner_priority) noexcept;
    /// Ends the threads. @return kOk; kPreconditionNotMet (work of a window is out: its thread goes on, the
    /// others have ended; call it again when the work has come back).
    Status close() noexcept;

    /// What the threads have, the worst of all: granted only when each of them has it. The priority is lost
    /// (EPERM) when the thread that runs the windows is not above it, or when a thread did not get it back.
    Right get_priority_right() const noexcept { return priority_right_; }
    Right get_processor_right() const noexcept { return processor_right_; }

    Instant get_now() const noexcept override { return clock_.get_now(); }
    Instant get_step_end() const noexcept override { return clock_.get_now(); }
    /// Work that is not back by the deadline, or that has exhausted its processor time, is aborted. Until it
    /// is back its thread has no fixed priority; an ordinary thread runs in SCHED_IDLE, where the process may
    /// end that again. So a hang takes no time from another window. When the calling thread is not above the
    /// windows (it has lost its priority, say), all windows lose theirs: the guard comes first.
    std::size_t run_within(const Work& work, Instant deadline) noexcept override;
    bool has_returned(std::size_t window) const noexcept override { return !threads_[window].is_out(); }

  private:
    Status start(WindowThread& thread) noexcept;
    Status start_all() noexcept;
    void stay_below(int runner_priority) noexcept;
    Instant calc_next_look(const WindowThread& thread) const noexcept;
    void demote(WindowThread& thread) noexcept;
    void promote(WindowThread& thread) noexcept;

    /// Whether this host starts, uses and ends the thread of `window`.
    bool is_own(std::size_t window) const noexcept {
        return windows_.empty() || windows_[window].core == core_;
    }

    Span<WindowThread> threads_;
    Span<const WindowRow> windows_{};
    std::size_t core_{0U};
    const FrameClock& clock_;
    ThreadPlace place_;
    Right priority_right_{};
    Right processor_right_{};
    int window_priority_{0};  ///< highest fixed priority of the threads; 0: none has one
    bool may_idle_{false};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_GUARDED_HOST_HPP
