// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a process asks of Linux to keep its times: a fixed priority, a processor, memory that stays in place.
/// Each may be refused; the process goes on, and what was refused goes into the evidence.
///
/// @satisfies SWR-PRT-002, SWR-PRT-037      Design: docs/design/posix_rt.md#rights
#ifndef MAMORI_PORTS_POSIX_RT_REAL_TIME_RIGHTS_HPP
#define MAMORI_PORTS_POSIX_RT_REAL_TIME_RIGHTS_HPP

#include <pthread.h>

#include <cstddef>

namespace mamori::ports::posix_rt {

/// A right that was asked for. `system_error` is the `errno` of the refusal, 0 when it was granted.
struct Right {
    bool is_granted{false};
    int system_error{0};
};

/// Of two rights that are needed together: granted only when both are, else the first refusal.
constexpr Right combine(const Right& first, const Right& second) noexcept {
    return first.is_granted ? second : first;
}

/// Where a thread shall run.
struct ThreadPlace {
    static constexpr int kAnyProcessor = -1;

    int priority{0};               ///< of SCHED_FIFO, 1 .. 99; 0: no fixed priority is asked for
    int processor{kAnyProcessor};  ///< number of the processor, 0, 1, ...
};

/// Gives a thread a fixed priority (SCHED_FIFO). @param[in] priority 0: it gets the ordinary policy back.
/// @return refused without the right for it (EPERM), or for a priority that Linux does not have (EINVAL).
Right set_priority(pthread_t thread, int priority) noexcept;

/// Binds a thread to one processor. @return refused when there is none of that number, or it is not ours
/// (EINVAL); granted for kAnyProcessor, which changes nothing.
Right set_processor(pthread_t thread, int processor) noexcept;

/// Locks all memory of the process, now and later, and touches `stack_size` bytes of the stack of the caller,
/// so that no page has to be fetched in a window.
/// @param[in] stack_size [byte] at most 1 MiB is touched.
/// @return refused without the right for that much memory and 64 MiB more, which the stacks of threads that
/// are started later take (EPERM, ENOMEM); then nothing is locked.
Right lock_memory(std::size_t stack_size) noexcept;

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_REAL_TIME_RIGHTS_HPP
