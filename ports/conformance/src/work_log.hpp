// SPDX-License-Identifier: Apache-2.0
/// @file
/// Work of the host rules. Its steps record which of them ran, when, and in which order.
///
/// @satisfies SWR-CNF-002, SWR-CNF-005      Design: docs/design/conformance.md#windows
#ifndef MAMORI_PORTS_CONFORMANCE_SRC_WORK_LOG_HPP
#define MAMORI_PORTS_CONFORMANCE_SRC_WORK_LOG_HPP

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <vector>

#include "mamori/ports/conformance/host_contract.hpp"

namespace mamori::ports::conformance {

/// One log per window. Aborted work continues to write to the log, so the log must outlive this work.
///
/// Thread safety: the entries are deliberately not atomic. Read an entry only after the host has reported the
/// end of its step: if the host reports it too early, the thread sanitizer detects a data race. The two
/// counts may be read at any time and do not order other accesses.
class WorkLog final {
  public:
    /// Record of a step, which the step writes at its end.
    struct Entry {
        std::size_t number{0U};
        Instant begin{};
        Instant end{};
        bool has_ended{false};
    };
    static constexpr std::size_t kCapacity = 2U * HostRig::kStepsMax;

    /// Clears the log. Call it while no work runs. @param[in] steps up to HostRig::kStepsMax.
    void prepare(HostRig& rig, std::size_t window, std::size_t first, const std::vector<StepPlan>& steps) {
        rig_ = &rig;
        window_ = window;
        first_ = first;
        count_ = steps.size();
        std::copy(steps.begin(), steps.end(), steps_.begin());
        entries_ = {};
        begun_.store(0U, std::memory_order_relaxed);
        ended_.store(0U, std::memory_order_relaxed);
    }

    /// Function for WindowHost::Work::run.
    static void run(void* argument, std::size_t begin, std::size_t end) noexcept {
        for (std::size_t number = begin; number < end; ++number) {
            static_cast<WorkLog*>(argument)->run_step(number);
        }
    }

    /// Steps that have begun, including those beyond the capacity.
    std::size_t get_begun_count() const noexcept { return begun_.load(std::memory_order_relaxed); }
    std::size_t get_ended_count() const noexcept { return ended_.load(std::memory_order_relaxed); }
    const Entry& get_entry(std::size_t index) const { return entries_.at(index); }
    std::size_t get_first() const noexcept { return first_; }
    std::size_t get_count() const noexcept { return count_; }
    const StepPlan& get_step(std::size_t index) const { return steps_.at(index); }

  private:
    void run_step(std::size_t number) noexcept {
        const std::size_t index = begun_.fetch_add(1U, std::memory_order_relaxed);
        if (index >= kCapacity) {
            return;
        }
        Entry& entry = entries_[index];
        entry.number = number;
        entry.begin = rig_->get_host().get_now();
        const std::size_t step = number - first_;
        rig_->spend(window_, step < count_ ? steps_[step] : StepPlan{});
        entry.end = rig_->get_host().get_step_end();
        entry.has_ended = true;
        ended_.fetch_add(1U, std::memory_order_relaxed);
    }

    HostRig* rig_{nullptr};
    std::size_t window_{0U};
    std::size_t first_{0U};
    std::size_t count_{0U};
    std::array<StepPlan, HostRig::kStepsMax> steps_{};
    std::array<Entry, kCapacity> entries_{};
    std::atomic<std::size_t> begun_{0U};
    std::atomic<std::size_t> ended_{0U};
};

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_SRC_WORK_LOG_HPP
