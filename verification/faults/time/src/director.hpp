// SPDX-License-Identifier: Apache-2.0
/// @file
/// Injects the faults of a plan into a running system, each at its frame, and records injections and reports.
#ifndef MAMORI_TIME_FAULTS_DIRECTOR_HPP
#define MAMORI_TIME_FAULTS_DIRECTOR_HPP

#include <atomic>
#include <vector>

#include "course.hpp"
#include "faulty_time.hpp"
#include "inversion.hpp"
#include "mamori/kernel/run/execution_observer.hpp"
#include "mamori/ports/posix_rt/core_runner.hpp"
#include "mamori/ports/posix_rt/grid_watch.hpp"
#include "mamori/verification/run_delay.hpp"
#include "time_faults.hpp"

namespace mamori::time_faults {

/// Targets of the faults. All must outlive the director.
struct Stage {
    const ports::posix_rt::FrameClock& clock;
    FaultyTime& time;
    Inversion& inversion;
    WindowHost& host;
    const std::atomic<bool>& is_reading;  ///< a reader of lower priority on the same processor
};

/// Calling context: the thread that runs the windows. A fault waits until earlier faults have ended: all work
/// has returned, and the monitor was reset.
class Director final : public ports::posix_rt::OpeningObserver, public ExecutionObserver {
  public:
    Director(const Stage& stage, std::vector<Injection> injections);

    /// nullptr: no finding is expected or reset. @param[in] watch must outlive it.
    void set_watch(ports::posix_rt::GridWatch* watch) noexcept { watch_ = watch; }

    void before_opening(const FrameSchedule::Opening& opening, Instant woke) noexcept override;
    void after_opening(const FrameSchedule::Opening& opening, WindowOutcome outcome) noexcept override;
    void on_budget_overrun(std::size_t window, std::size_t component, Instant now) noexcept override;
    void on_late_release(std::size_t window, Duration lateness, Instant now) noexcept override;

    /// The records, without overruns and stalls. Call after the run.
    const Course& get_course() const noexcept { return course_; }

  private:
    void look_after_watch() noexcept;
    void end_clock_fault() noexcept;
    const Injection* find_due(const FrameSchedule::Opening& opening) noexcept;
    void begin(const Injection& injection, const FrameSchedule::Opening& opening) noexcept;
    void begin_after(const Injection& injection, const FrameSchedule::Opening& opening) noexcept;
    void record_held_sleep(const FrameSchedule::Opening& opening) noexcept;
    void finish(Duration aftermath) noexcept;
    void hold_back(Instant end) const noexcept;
    void add(const Report& report) noexcept;

    Stage stage_;
    std::vector<Injection> injections_;
    ports::posix_rt::GridWatch* watch_{nullptr};
    Course course_;
    std::size_t next_{0U};
    Instant quiet_until_{};
    Instant release_{};
    Instant woke_{};
    verification::RunDelayMeter meter_{};
    Duration runner_delay_{};
    bool is_sleep_held_{false};
    bool is_guard_held_{false};
    bool is_clock_wrong_{false};
};

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_DIRECTOR_HPP
