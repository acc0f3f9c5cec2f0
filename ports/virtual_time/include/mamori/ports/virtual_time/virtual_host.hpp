// SPDX-License-Identifier: Apache-2.0
/// @file
/// Virtual time for one core: a clock that jumps, and execution times that are modelled instead of measured.
/// A component can be made slow or made to hang at a chosen instant, and the same run gives the same bytes
/// again.
///
/// @satisfies SWR-VTM-001, SWR-VTM-002, SWR-KRN-065      Design: docs/design/conformance.md#execution-times
#ifndef MAMORI_PORTS_VIRTUAL_TIME_VIRTUAL_HOST_HPP
#define MAMORI_PORTS_VIRTUAL_TIME_VIRTUAL_HOST_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/component/window_host.hpp"
#include "mamori/kernel/table/index_of.hpp"
#include "mamori/kernel/table/modelled_time_row.hpp"

namespace mamori::ports::virtual_time {

/// Modelled execution time of a component that never returns.
inline constexpr Duration kNever{std::numeric_limits<std::int64_t>::max()};

/// End of a modelled step, or the instant at which it is aborted.
struct StepEnd {
    Instant at{};
    bool is_in_time{false};
};

/// Model of a processor that does not execute work all the time.
class ModelledProcessor {
  public:
    /// @param[in] from >= the last result. @param[in] duration >= 0, or kNever.
    /// @return when a step ends that begins at `from` and takes `duration` of processor time, or when it is
    ///         aborted: from `from` on, and at `deadline` at the latest if it has not passed.
    virtual StepEnd run_step(Instant from, Duration duration, Instant deadline) noexcept = 0;

  protected:
    ~ModelledProcessor() = default;
};

/// Clock and execution-time model of one simulated core. Users construct a VirtualHostFor.
///
/// Thread safety: none. Time: O(1) per call, O(components) to find a component. Memory: none of its own;
///                refers to the durations.
class VirtualHost : public WindowHost {
  public:
    VirtualHost(const VirtualHost&) = delete;
    VirtualHost& operator=(const VirtualHost&) = delete;

    Instant get_now() const noexcept final { return now_; }
    /// The modelled end of the step; for one that is cut off an instant after its deadline.
    Instant get_step_end() const noexcept final { return step_end_; }

    /// Work whose modelled time fits runs and the clock moves on by it. Work that does not fit is cut off at
    /// the deadline: a late one still has its effect on its component, a hanging one has none.
    /// The modelled time is that of the first pass, and of a mode step in its place; the second takes none.
    /// An action outside windows has the modelled time as well, but the clock does not move: the time line
    /// consists of major frames.
    std::size_t run_within(const Work& work, Instant deadline) noexcept final;
    /// Always: work that is cut off has returned, or never began.
    bool has_returned(std::size_t) const noexcept final { return true; }

    /// @param[in] processor executes the work of windows from now on; nullptr: one without other work.
    ///            Must outlive its use, and must not be set while actions outside windows run.
    void set_processor(ModelledProcessor* processor) noexcept { processor_ = processor; }

    /// Lets time pass without work. @param[in] instant not before get_now(); an earlier one is an own bug.
    void advance_to(Instant instant) noexcept;

    /// Changes the modelled execution time from the next cycle on.
    /// @param[in] component of the system table. @param[in] duration >= 0, or kNever: it hangs.
    /// @return kOk; kBadParameter (not a component of the table, or a negative duration).
    Status set_duration(const Component& component, Duration duration) noexcept;
    /// The same by the index of the component in the system table.
    Status set_duration(std::size_t component, Duration duration) noexcept;
    /// @return its modelled execution time; 0 without one.
    Duration get_duration(std::size_t component) const noexcept {
        return component < durations_.size() ? durations_[component] : Duration{0};
    }

  protected:
    constexpr VirtualHost(Span<Duration> durations, Span<Component* const> components) noexcept
        : durations_(durations), components_(components) {}
    ~VirtualHost() = default;

  private:
    StepEnd run_step(Duration duration, Instant deadline) const noexcept;

    Span<Duration> durations_;
    Span<Component* const> components_;
    ModelledProcessor* processor_{nullptr};
    Instant now_{};
    Instant step_end_{};
};

namespace detail {
/// Base so that the durations exist before the host that refers to them.
template <std::size_t kCount>
struct DurationStorage {
    std::array<Duration, kCount> durations{};
};
}  // namespace detail

/// Host for the components of a table, with their modelled times:  VirtualHostFor host{kSystem};
template <typename Table>
class VirtualHostFor final : private detail::DurationStorage<Table::kComponentCount>, public VirtualHost {
  public:
    /// @param[in] table made by mamori::system(); must outlive the host; check it with MAMORI_CHECK, a wrong
    ///                  component is a contract violation. A component without modelled_time() takes no time.
    constexpr explicit VirtualHostFor(const Table& table) noexcept
        : VirtualHost(detail::DurationStorage<Table::kComponentCount>::durations, table.components) {
        for (const ModelledTimeRow& row : table.modelled_times) {
            detail::DurationStorage<Table::kComponentCount>::durations[index_of(table, *row.component)] =
                row.duration;
        }
    }
    explicit VirtualHostFor(const Table&& table) = delete;
};

/// Host for work without a table, as tests of a port have it.
class IndexedVirtualHost final : public VirtualHost {
  public:
    /// @param[in] durations modelled execution time of component 0, 1, ..., each >= 0 or kNever; must outlive
    ///            this object. A component without an entry takes no time.
    constexpr explicit IndexedVirtualHost(Span<Duration> durations) noexcept : VirtualHost(durations, {}) {}
};

}  // namespace mamori::ports::virtual_time

#endif  // MAMORI_PORTS_VIRTUAL_TIME_VIRTUAL_HOST_HPP
