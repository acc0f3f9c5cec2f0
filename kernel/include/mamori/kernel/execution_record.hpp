// SPDX-License-Identifier: Apache-2.0
/// @file
/// What an executive has seen of the runs of one component, against the time that each may take. Records lie
/// side by side at whoever supervises, so that noting a run is three comparisons and no call.
///
/// @satisfies SWR-KRN-030      Design: docs/design/kernel.md#observation
#ifndef MAMORI_KERNEL_EXECUTION_RECORD_HPP
#define MAMORI_KERNEL_EXECUTION_RECORD_HPP

#include <cstdint>
#include <limits>

#include "mamori/kernel/time.hpp"

namespace mamori {

/// Runs of one component: its first pass (on_execute) while Active, come through within the budget. One that
/// is Inactive, in Error or cut off leaves no trace here. The limits are the owner's; what was seen gathers
/// until the owner clears it, so no run hides another.
///
/// Thread safety: none; the executive writes while a window runs, the owner in the same execution context.
struct ExecutionRecord {
    static constexpr std::uint32_t kWithin = 1U;   ///< a run within the limits
    static constexpr std::uint32_t kOutside = 2U;  ///< a run that was too short or too long

    Duration shortest{0};                                        ///< shortest run allowed, >= 0
    Duration longest{std::numeric_limits<std::int64_t>::max()};  ///< longest run allowed, >= shortest
    std::uint32_t seen{0U};                                      ///< any of the above

    /// A run from `started` to `finished`. One that ended before it began, since the clock ran backwards, is
    /// outside.
    void note_run(Instant started, Instant finished) noexcept {
        // In unsigned arithmetic the time between two instants in order is exact, however far they are apart.
        const std::uint64_t used =
            static_cast<std::uint64_t>(finished.ns) - static_cast<std::uint64_t>(started.ns);
        if (finished >= started && used <= static_cast<std::uint64_t>(longest.ns) &&
            used >= static_cast<std::uint64_t>(shortest.ns)) {
            seen |= kWithin;
        } else {
            seen |= kOutside;
        }
    }
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_EXECUTION_RECORD_HPP
