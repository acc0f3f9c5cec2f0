// SPDX-License-Identifier: Apache-2.0
/// @file
/// Virtual time for one core: a clock that jumps, and execution times that are modelled instead of measured.
/// A component can be made slow or made to hang at a chosen instant, and the same run gives the same bytes
/// again.
///
/// @satisfies SWR-VTM-001, SWR-VTM-002      Design: docs/design/conformance.md#execution-times
#ifndef MAMORI_PORTS_VIRTUAL_TIME_VIRTUAL_HOST_HPP
#define MAMORI_PORTS_VIRTUAL_TIME_VIRTUAL_HOST_HPP

#include <cstddef>
#include <cstdint>
#include <limits>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/window_host.hpp"

namespace mamori::ports::virtual_time {

/// Modelled execution time of a component that never returns.
inline constexpr Duration kNever{std::numeric_limits<std::int64_t>::max()};

/// Clock and execution-time model of one simulated core.
///
/// Thread safety: none. Time: O(1) per call. Memory: none of its own; refers to the durations.
class VirtualHost final : public WindowHost {
  public:
    /// @param[in] durations one modelled execution time per component of the system table, each >= 0 or
    ///            kNever; must outlive this object. A component without an entry takes no time.
    explicit VirtualHost(Span<Duration> durations) noexcept : durations_(durations) {}

    Instant get_now() const noexcept override { return now_; }
    /// The modelled end of the step; for one that is cut off an instant after its deadline.
    Instant get_step_end() const noexcept override { return step_end_; }

    /// Work whose modelled time fits runs and the clock moves on by it. Work that does not fit is cut off at
    /// the deadline: a late one still has its effect on its component, a hanging one has none.
    /// The modelled time is that of the first pass, and of a mode step in its place; the second takes none.
    std::size_t run_within(const Work& work, Instant deadline) noexcept override;
    /// Always: work that is cut off has returned, or never began.
    bool has_returned(std::size_t) const noexcept override { return true; }

    /// Lets time pass without work. @param[in] instant not before get_now(); an earlier one is an own bug.
    void advance_to(Instant instant) noexcept;

    /// Changes the modelled execution time from the next cycle on.
    /// @param[in] component index in the system table. @param[in] duration >= 0, or kNever: it hangs.
    /// @return kOk; kBadParameter (no such entry, or a negative duration).
    Status set_duration(std::size_t component, Duration duration) noexcept;

  private:
    Span<Duration> durations_;
    Instant now_{};
    Instant step_end_{};
};

}  // namespace mamori::ports::virtual_time

#endif  // MAMORI_PORTS_VIRTUAL_TIME_VIRTUAL_HOST_HPP
