// SPDX-License-Identifier: Apache-2.0
/// @file
/// The system that receives faults of time: three windows in a major frame of 1 ms, and four components that
/// take too long if they are armed.
#ifndef MAMORI_TIME_FAULTS_VICTIMS_HPP
#define MAMORI_TIME_FAULTS_VICTIMS_HPP

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <vector>

#include "course.hpp"
#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/run/introspection.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/verification/run_delay.hpp"
#include "page_storm.hpp"
#include "time_faults.hpp"

namespace mamori::time_faults {

/// What a component does for too long.
enum class Way : std::uint8_t { kCompute, kSleep, kLock };

/// An injected overrun that has begun. Its thread may be released meanwhile, but still returns.
struct OpenOverrun {
    std::size_t component{0U};
    Instant begin{};
    Cause cause{Cause::kWork};
    std::atomic<std::int64_t> end_ns{0};
};

/// Objects that the components use; set before the run.
struct Surroundings {
    const ports::posix_rt::FrameClock* clock{nullptr};
    std::vector<OpenOverrun>* overruns{nullptr};  ///< capacity for the complete run
    std::mutex* mutex{nullptr};
    ComponentDelays* delays{nullptr};
    std::atomic<std::size_t> overrun_count{0U};
    Defect defect{Defect::kNone};
};
Surroundings& get_surroundings() noexcept;

class Victim final : public Component {
  public:
    constexpr explicit Victim(const char* name, std::size_t place) noexcept
        : Component(name), place_(place) {}

    /// The next cycle takes `size`, or, with kLock, as long as the mutex is held.
    void arm(Way way, Cause cause, Duration size) noexcept {
        way_ = way;
        cause_ = cause;
        size_ns_.store(size.ns, std::memory_order_release);
    }
    /// On its thread, before the first window: opening the file of the meter can take longer than the budget.
    void open_meter() noexcept { static_cast<void>(delay_meter_.take()); }
    Status on_execute(ContextHandle handle) noexcept override;
    const PageMeter& get_meter() const noexcept { return meter_; }

  private:
    void do_as_told() noexcept;
    void work_too_long() noexcept;

    std::size_t place_;
    std::uint64_t cycle_{0U};
    Way way_{Way::kCompute};
    Cause cause_{Cause::kWork};
    std::atomic<std::int64_t> size_ns_{0};
    PageMeter meter_;
    verification::RunDelayMeter delay_meter_{};
};

inline constexpr std::size_t kComponentCount = 4U;
inline constexpr std::size_t kWindowCount = 3U;
inline constexpr Duration kBudget{200'000};

/// The window of each component.
inline constexpr std::array<std::size_t, kComponentCount> kWindowOf{0U, 1U, 1U, 2U};

Victim& get_victim(std::size_t component) noexcept;
Executive& get_executive() noexcept;
Introspection& get_introspection() noexcept;

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_VICTIMS_HPP
