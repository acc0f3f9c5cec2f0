// SPDX-License-Identifier: Apache-2.0
/// @file
/// What an executive has seen of the runs of one component, against the time that each may take. Records lie
/// side by side at whoever supervises, so that noting a run is three comparisons and no call.
///
/// @satisfies SWR-KRN-030      Design: docs/design/kernel.md#observation
#ifndef MAMORI_KERNEL_EXECUTION_RECORD_HPP
#define MAMORI_KERNEL_EXECUTION_RECORD_HPP

#include <atomic>
#include <cstdint>
#include <limits>

#include "mamori/kernel/base/time.hpp"

namespace mamori {

/// Runs of one component: its first pass (on_execute) while Active, come through within the budget. One that
/// is Inactive, in Error or cut off leaves no trace here. The limits are the owner's; what was seen gathers
/// until the owner clears it, so no run hides another.
///
/// Thread safety: the executive writes while a window runs, the owner in the same execution context. A run
///                that its host cuts off in the same moment, on another thread, may write as well: its flag
///                is lost then, or a flag that was just taken comes back, and the overrun tells of it anyway.
/// Time:          O(1), nothing blocks. Memory: two durations and a word.
class ExecutionRecord final {
  public:
    static constexpr std::uint32_t kWithin = 1U;   ///< a run within the limits
    static constexpr std::uint32_t kOutside = 2U;  ///< a run that was too short or too long

    /// Without limits every run is within them.
    constexpr ExecutionRecord() noexcept = default;
    /// @param[in] shortest run allowed, >= 0. @param[in] longest one, >= shortest. Neither is checked: the
    ///            owner sees to it.
    constexpr ExecutionRecord(Duration shortest, Duration longest) noexcept
        : shortest_(shortest), longest_(longest) {}

    /// As the constructor; what was seen stays.
    void set_limits(Duration shortest, Duration longest) noexcept {
        shortest_ = shortest;
        longest_ = longest;
    }

    /// A run from `started` to `finished`. One that ended before it began, since the clock ran backwards, is
    /// outside.
    void note_run(Instant started, Instant finished) noexcept {
        // In unsigned arithmetic the time between two instants in order is exact, however far they are apart.
        const std::uint64_t used =
            static_cast<std::uint64_t>(finished.ns) - static_cast<std::uint64_t>(started.ns);
        if (finished >= started && used <= static_cast<std::uint64_t>(longest_.ns) &&
            used >= static_cast<std::uint64_t>(shortest_.ns)) {
            note(kWithin);
        } else {
            note(kOutside);
        }
    }
    /// Any of the above, since the owner last took it.
    std::uint32_t get_seen() const noexcept { return seen_.load(std::memory_order_relaxed); }
    /// The same, and nothing is seen from then on.
    std::uint32_t take_seen() noexcept {
        const std::uint32_t seen = get_seen();
        seen_.store(0U, std::memory_order_relaxed);
        return seen;
    }

  private:
    /// A plain load and store: exchanging would cost more than the whole note.
    void note(std::uint32_t flag) noexcept { seen_.store(get_seen() | flag, std::memory_order_relaxed); }

    Duration shortest_{0};
    Duration longest_{std::numeric_limits<std::int64_t>::max()};
    std::atomic<std::uint32_t> seen_{0U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_EXECUTION_RECORD_HPP
