// SPDX-License-Identifier: Apache-2.0
/// @file
/// When two channels agree, and for how long they may not: shared by the voters and by the cross comparison.
///
/// @satisfies SWR-RED-004, SWR-RED-007      Design: docs/design/redundancy.md#discrepancy-time
/// Source:   IEC 61508-7:2010 A.1.3 (comparator), A.1.4 (majority voter)
#ifndef MAMORI_SAFETY_REDUNDANCY_DISCREPANCY_HPP
#define MAMORI_SAFETY_REDUNDANCY_DISCREPANCY_HPP

#include <cstdint>
#include <limits>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"

namespace mamori::safety {

/// True for a tolerance that can be kept: finite, >= 0.
constexpr bool is_tolerance(double tolerance) noexcept {
    return tolerance >= 0.0 && tolerance <= std::numeric_limits<double>::max();
}

/// True when both are finite and |a - b| <= tolerance. What is not a number agrees with nothing, infinity
/// neither, also not with itself.
/// @param[in] tolerance absolute, in the unit of the values; is_tolerance().
constexpr bool agree(double a, double b, double tolerance) noexcept {
    const double difference = a - b;  // infinite when it overflows, and then above every tolerance
    return difference >= -tolerance && difference <= tolerance;
}

/// Judgement about a disagreement; ordered, the worst is the largest.
enum class Discrepancy : std::uint8_t {
    kNone,
    kTolerated,  ///< they disagree, and have done so for no longer than the discrepancy time
    kLatched,    ///< they disagreed for longer, or the clock ran backwards; kept until acknowledged
};

/// Latches a disagreement that lasts longer than its discrepancy time.
///
/// Thread safety: none; call step() once per cycle. Time: O(1), nothing blocks. Memory: no heap.
class DiscrepancyTimer final {
  public:
    /// @param[in] discrepancy_time from the first cycle of a disagreement, included: >= 0.
    explicit constexpr DiscrepancyTimer(Duration discrepancy_time) noexcept : limit_(discrepancy_time) {
        MAMORI_REQUIRE(1, discrepancy_time >= Duration{0});
    }

    /// One cycle in which they agree begins the time anew.
    /// @param[in] now not before that of the step before; if so, this is latched.
    Discrepancy step(bool do_disagree, Instant now) noexcept;

    /// Clears what is latched. Only for a deliberate act of a person.
    /// @return kOk (nothing is latched now); kPreconditionNotMet (they disagreed in the last step).
    Status acknowledge() noexcept;

    /// @return result of the last step(), and of acknowledge() since.
    constexpr Discrepancy get() const noexcept {
        if (is_latched_) {
            return Discrepancy::kLatched;
        }
        return is_present_ ? Discrepancy::kTolerated : Discrepancy::kNone;
    }

  private:
    Duration limit_;
    Instant since_{};
    Instant stepped_at_{std::numeric_limits<std::int64_t>::min()};
    bool is_present_{false};
    bool is_latched_{false};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_REDUNDANCY_DISCREPANCY_HPP
