// SPDX-License-Identifier: Apache-2.0
/// @file
/// Result of the runs of one component, compared with the limits of its run time. The supervisor stores all
/// records in one array. Recording a run takes three comparisons and no call.
///
/// @satisfies SWR-KRN-030      Design: docs/design/kernel.md#observation
#ifndef MAMORI_KERNEL_EXECUTION_RECORD_HPP
#define MAMORI_KERNEL_EXECUTION_RECORD_HPP

#include <atomic>
#include <cstdint>
#include <limits>

#include "mamori/kernel/base/time.hpp"

namespace mamori {

/// Runs of one component: its first pass (on_execute) while Active, completed within the budget. A component
/// that is Inactive, in Error or aborted is not recorded. The owner sets the limits. The flags accumulate
/// until the owner clears them, so no run hides another run.
///
/// Thread safety: the executive writes while a window runs; the owner reads and clears in the same execution
///                context. A run that the platform host aborts at that moment may also write, on another
///                thread. Its flag may then be lost, or a cleared flag may be set again; the overrun is
///                reported anyway.
/// Time:          O(1), nothing blocks. Memory: two durations and a word.
class ExecutionRecord final {
  public:
    static constexpr std::uint32_t kWithin = 1U;   ///< at least one run within the limits
    static constexpr std::uint32_t kOutside = 2U;  ///< at least one run too short or too long

    /// No limits: every run is within the limits.
    constexpr ExecutionRecord() noexcept = default;
    /// @param[in] shortest minimum duration of a run, >= 0. @param[in] longest maximum duration, >= shortest.
    ///                     Neither is checked: the owner is responsible.
    constexpr ExecutionRecord(Duration shortest, Duration longest) noexcept
        : shortest_(shortest), longest_(longest) {}

    /// Limits as in the constructor; the flags do not change.
    void set_limits(Duration shortest, Duration longest) noexcept {
        shortest_ = shortest;
        longest_ = longest;
    }

    /// Records a run from `started` to `finished`. A run whose end is before its start (the clock went
    /// backwards) is outside.
    void note_run(Instant started, Instant finished) noexcept {
        // The unsigned difference of ordered instants is exact for all values.
        const std::uint64_t used =
            static_cast<std::uint64_t>(finished.ns) - static_cast<std::uint64_t>(started.ns);
        if (finished >= started && used <= static_cast<std::uint64_t>(longest_.ns) &&
            used >= static_cast<std::uint64_t>(shortest_.ns)) {
            note(kWithin);
        } else {
            note(kOutside);
        }
    }
    /// Flags kWithin and kOutside of all runs since the last take_seen().
    std::uint32_t get_seen() const noexcept { return seen_.load(std::memory_order_relaxed); }
    /// Returns the flags and clears them.
    std::uint32_t take_seen() noexcept {
        const std::uint32_t seen = get_seen();
        seen_.store(0U, std::memory_order_relaxed);
        return seen;
    }

  private:
    /// A plain load and store: an atomic exchange would take longer than the complete recording.
    void note(std::uint32_t flag) noexcept { seen_.store(get_seen() | flag, std::memory_order_relaxed); }

    Duration shortest_{0};
    Duration longest_{std::numeric_limits<std::int64_t>::max()};
    std::atomic<std::uint32_t> seen_{0U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_EXECUTION_RECORD_HPP
