// SPDX-License-Identifier: Apache-2.0
/// @file
/// A window host whose clock a test sets and whose work takes as long as the test says, and an observer with
/// records that writes down what it hears.
#ifndef MAMORI_KERNEL_TESTS_FAKE_HOST_HPP
#define MAMORI_KERNEL_TESTS_FAKE_HOST_HPP

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mamori/kernel/component/window_host.hpp"
#include "mamori/kernel/run/execution_observer.hpp"

namespace mamori::testing_support {

class FakeHost final : public WindowHost {
  public:
    Instant now{};
    /// Modelled time of (component, pass); nothing for those that are not named.
    std::map<std::pair<std::size_t, Pass>, Duration> durations;
    /// Work of these is not called and runs out of budget.
    std::map<std::pair<std::size_t, Pass>, bool> hangs;
    std::vector<Instant> deadlines;
    Instant step_end{};
    bool is_work_out{false};  ///< what was cut off has not come back

    bool has_returned(std::size_t) const noexcept override { return !is_work_out; }
    Instant get_now() const noexcept override { return now; }
    Instant get_step_end() const noexcept override { return step_end; }

    std::size_t run_within(const Work& work, Instant deadline) noexcept override {
        deadlines.push_back(deadline);
        for (std::size_t i = 0U; i < work.count; ++i) {
            const auto key = std::make_pair(work.component + i, work.pass);
            const Instant end = now + durations[key];
            step_end = end;
            if (!hangs[key]) {
                work.run(work.argument, work.first + i, work.first + i + 1U);
            }
            const bool is_in_time = !hangs[key] && end <= deadline;
            now = is_in_time ? end : deadline;
            if (!is_in_time) {
                return i;
            }
        }
        return work.count;
    }
};

/// Base so that the records exist before the observer that names them.
struct SpyRecords {
    std::array<ExecutionRecord, 8U> records{};

    /// What was seen of components 0 .. count - 1 since the last call.
    std::vector<std::uint32_t> take_seen(std::size_t count) {
        std::vector<std::uint32_t> seen;
        for (std::size_t i = 0U; i < count; ++i) {
            seen.push_back(records.at(i).take_seen());
        }
        return seen;
    }
};

class SpyObserver final : public SpyRecords, public ExecutionObserver {
  public:
    SpyObserver() : ExecutionObserver(records) {}
    std::vector<std::string> heard;

    void on_budget_overrun(std::size_t window, std::size_t component, Instant now) noexcept override {
        heard.push_back("overrun window " + std::to_string(window) + " component " +
                        std::to_string(component) + " @" + std::to_string(now.ns));
    }
    void on_late_release(std::size_t window, Duration lateness, Instant now) noexcept override {
        heard.push_back("late window " + std::to_string(window) + " by " + std::to_string(lateness.ns) +
                        " @" + std::to_string(now.ns));
    }
};

}  // namespace mamori::testing_support

#endif  // MAMORI_KERNEL_TESTS_FAKE_HOST_HPP
