// SPDX-License-Identifier: Apache-2.0
/// @file
/// Looks at all assumptions of use before the machine may move, and goes on while it moves. One that does not
/// hold, or is not known to hold in time, fails the self test and is named.
///
/// @satisfies SWR-AOU-001, SWR-AOU-003      Design: docs/design/assumptions.md#monitor
/// Source:   IEC 61508-3:2010 annex D (safety manual: constraints on the use)
#ifndef MAMORI_SAFETY_ASSUMPTIONS_ASSUMPTION_MONITOR_HPP
#define MAMORI_SAFETY_ASSUMPTIONS_ASSUMPTION_MONITOR_HPP

#include <cstddef>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/assumptions/assumption_table.hpp"
#include "mamori/safety/base/self_test_status.hpp"

namespace mamori::safety {

/// Monitor of a table of assumptions. Its status goes into SafeStateInputs::self_test, combined with that of
/// other tests.
///
/// Thread safety: none; call step() once per cycle. Time: O(rows), one check each. Memory: no heap.
class AssumptionMonitor final {
  public:
    /// @param[in] rows proven by checks_all(); must outlive this object; size >= 1.
    explicit constexpr AssumptionMonitor(Span<const AssumptionRow> rows) noexcept : rows_(rows) {
        MAMORI_REQUIRE(1, !rows.empty());
    }

    /// Checks all assumptions. The first call begins the times.
    /// @return kRunning while one is not known to hold; kPassed in a cycle in which all hold; kFailed from
    /// the
    ///         cycle on in which one does not hold, or is still not known after its time, for good.
    SelfTestStatus step(Instant now) noexcept;

    /// @return result of the last step(); kRunning before the first.
    constexpr SelfTestStatus get_status() const noexcept { return status_; }
    /// @return the assumption that failed first, of several in one cycle that of the first row; kNoAssumption
    ///         when none did.
    constexpr AssumptionIndex get_failed() const noexcept { return failed_.assumption; }
    /// @return its name as the table spells it; "" when none failed.
    constexpr const char* get_failed_name() const noexcept { return failed_.name; }

  private:
    Span<const AssumptionRow> rows_;
    AssumptionRow failed_{};
    Instant began_{};
    SelfTestStatus status_{SelfTestStatus::kRunning};
    bool has_begun_{false};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_ASSUMPTIONS_ASSUMPTION_MONITOR_HPP
