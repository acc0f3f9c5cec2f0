// SPDX-License-Identifier: Apache-2.0
/// @file
/// Real-time privileges of a process: fixed priority, processor and locked memory. Linux can deny each of
/// them. The process then continues, and the evidence states which privilege was denied.
///
/// @satisfies SWR-PRT-002, SWR-PRT-037, SWR-PRT-040, SWR-PRT-046, SWR-PRT-060
///     Design: docs/design/posix_rt.md#rights, docs/design/posix_rt.md#stacks
#ifndef MAMORI_PORTS_POSIX_RT_REAL_TIME_RIGHTS_HPP
#define MAMORI_PORTS_POSIX_RT_REAL_TIME_RIGHTS_HPP

#include <pthread.h>

#include <cstddef>

#include "mamori/kernel/base/status.hpp"

namespace mamori::ports::posix_rt {

/// Result of a request for a privilege. `system_error` is the `errno` of a denial, 0 if the privilege was
/// granted.
struct Right {
    bool is_granted{false};
    int system_error{0};
};

/// Combines two privileges that are required together.
/// @return granted if both are granted, else the first denial.
constexpr Right combine(const Right& first, const Right& second) noexcept {
    return first.is_granted ? second : first;
}

/// Stack of a thread of this port [byte], unless its ThreadPlace or WindowThread states another size. The
/// default of Linux (8 MiB, ulimit -s) would be locked completely for each thread.
inline constexpr std::size_t kThreadStack{std::size_t{256U} * 1024U};
/// Minimum stack [byte]: data of the C library and one signal frame with all registers.
inline constexpr std::size_t kThreadStackMin{std::size_t{32U} * 1024U};
/// Inaccessible memory below the stack [byte]. An overflow is a SIGSEGV there; also one by a function whose
/// frame is larger than a page.
inline constexpr std::size_t kThreadStackGuard{std::size_t{64U} * 1024U};

/// Scheduling and stack size of a thread.
struct ThreadPlace {
    static constexpr int kAnyProcessor = -1;

    int priority{0};               ///< of SCHED_FIFO, 1 .. 99; 0: an ordinary thread (SCHED_OTHER)
    int processor{kAnyProcessor};  ///< number of the processor, 0, 1, ...
    /// [byte]; the thread gets at least this size and at least kThreadStackMin. The C library may reuse a
    /// larger stack of a thread that has ended.
    std::size_t stack_size{kThreadStack};
};

/// Gives a thread a fixed priority (SCHED_FIFO). @param[in] priority 0: the thread gets SCHED_OTHER.
/// @return denied without the privilege (EPERM) and for an invalid priority (EINVAL).
Right set_priority(pthread_t thread, int priority) noexcept;

/// Lets a thread run only while no thread of another policy wants its processor (SCHED_IDLE).
/// set_priority() takes that back, which may need a privilege: see may_leave_idle().
Right set_idle(pthread_t thread) noexcept;

/// Tries on a thread of its own whether this process may give a thread in SCHED_IDLE its policy back.
bool may_leave_idle() noexcept;

/// @return fixed priority of the calling thread (SCHED_FIFO, SCHED_RR), 1 .. 99; 0: it has none. One system
///         call, so a priority that another process has changed counts as well.
int get_own_priority() noexcept;

/// Privileges that a thread got of its ThreadPlace. `priority` is granted for priority 0 too.
struct ThreadRights {
    Right priority{};
    Right processor{};
};

/// Starts a thread that has the scheduling and the stack of `place` and inherits neither policy nor priority
/// of the caller. A privilege that is denied does not prevent the start: the thread is an ordinary one then.
/// @return kOk; kOutOfResources (no thread, or no memory for its stack; `thread` and `rights` are unchanged).
Status start_thread(pthread_t& thread, void* (*run)(void*), void* argument, ThreadPlace place,
                    ThreadRights& rights) noexcept;

/// Binds a thread to one processor.
/// @return denied if the processor does not exist or is not permitted for this process (EINVAL); granted for
///         kAnyProcessor, which changes nothing: a new thread has the processors of the thread that started
///         it.
Right set_processor(pthread_t thread, int processor) noexcept;

/// Locks all current and future memory of the process and touches `stack_size` bytes of the stack of the
/// caller, so that no window waits for a page.
/// @param[in] stack_size [byte] at most 1 MiB is touched, and never more than the stack of the caller has
/// left.
/// @return denied (EPERM, ENOMEM) if the limit permits less than this memory plus 64 MiB for stacks of later
///         threads; then nothing is locked.
Right lock_memory(std::size_t stack_size) noexcept;

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_REAL_TIME_RIGHTS_HPP
