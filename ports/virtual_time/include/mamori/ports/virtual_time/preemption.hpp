// SPDX-License-Identifier: Apache-2.0
/// @file
/// Preemption in virtual time: work of a background window waits while an ordinary window of its core
/// takes its modelled time.
///
/// @satisfies SWR-VTM-010, SWR-VTM-011      Design: docs/design/conformance.md#preemption
#ifndef MAMORI_PORTS_VIRTUAL_TIME_PREEMPTION_HPP
#define MAMORI_PORTS_VIRTUAL_TIME_PREEMPTION_HPP

#include <cstddef>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/run/frame_schedule.hpp"
#include "mamori/ports/virtual_time/virtual_host.hpp"

namespace mamori::ports::virtual_time {

/// One instance of a background window. The modelled times in force at its start count, and each start of an
/// ordinary window whose context is running counts, at most with its budget.
///
/// Thread safety: none. Time: O(window starts until the deadline). Memory: a schedule; refers to the rest.
class Preemption final : public ModelledProcessor {
  public:
    /// @param[in] executive, clock of the ordinary windows. @param[in] next their next window starts.
    /// @param[in] budget processor time of the background window. References must outlive this object.
    Preemption(Executive& executive, const VirtualHost& clock, const FrameSchedule& next,
               Duration budget) noexcept
        : executive_(executive), clock_(clock), next_(next), budget_left_(budget) {}

    /// @return the first instant from `at` on at which no ordinary window runs.
    Instant calc_start(Instant at) noexcept;
    StepEnd run_step(Instant from, Duration duration, Instant deadline) noexcept override;

  private:
    Duration calc_time(std::size_t window) const noexcept;

    Executive& executive_;
    const VirtualHost& clock_;
    FrameSchedule next_;
    Duration budget_left_;
};

}  // namespace mamori::ports::virtual_time

#endif  // MAMORI_PORTS_VIRTUAL_TIME_PREEMPTION_HPP
