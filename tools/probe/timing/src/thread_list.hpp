// SPDX-License-Identifier: Apache-2.0
/// @file
/// Names the threads of a switch log, and records when a stopped process continued.
#ifndef MAMORI_TIMING_THREAD_LIST_HPP
#define MAMORI_TIMING_THREAD_LIST_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "mamori/timing/run_log.hpp"
#include "mamori/timing/switch_log.hpp"

namespace mamori::timing {

enum class ThreadKind : std::uint8_t {
    kOwn,     ///< thread of this process
    kOther,   ///< thread of another process
    kKernel,  ///< kernel thread
};

struct NamedThread {
    std::uint32_t thread{0U};
    std::uint32_t process{0U};
    ThreadKind kind{ThreadKind::kOther};
    int priority{0};   ///< fixed priority of an own thread, 0: none, or kUnknownPriority; 0 for all others
    std::string name;  ///< empty: the thread has ended
};

/// @return the threads of all kept slices, once each, in ascending order; without the idle thread and threads
/// of other processes that have ended.
std::vector<NamedThread> list_threads(const std::vector<const SwitchLog*>& logs);

/// Starts to record each SIGCONT of this process, which ends a stop. Replaces other handlers.
void watch_continuations() noexcept;
/// Restores the default action. @return readings of CLOCK_MONOTONIC [ns], at most 1024.
std::vector<std::int64_t> end_continuations();

}  // namespace mamori::timing

#endif  // MAMORI_TIMING_THREAD_LIST_HPP
