// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/conformance/timer_contract.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <string>
#include <utility>
#include <vector>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/conformance/rule_trial.hpp"

namespace mamori::ports::conformance {
namespace {

constexpr const char* kRequirement = "SWR-CNF-011";

constexpr Duration kFrame = 8_ms;
constexpr Duration kBudget = 2_ms;
constexpr Duration kSlow = 5_ms;  ///< longer than the budget and the window; ends after the next window start
constexpr std::array<Duration, TimerRig::kWindowCount> kOffsets{0_ms, 4_ms};
constexpr int kPatience = 60'000;  ///< maximum wait for slow work [ms], as in host_subject.cpp
constexpr std::size_t kOpeningsMax = 16U;

/// A window instance as its component observed it.
struct Opening {
    Instant planned{};
    Instant seen{};
};

/// Records when it runs. The records are read after its work has returned.
class Witness final : public Component {
  public:
    explicit Witness(const char* name) noexcept : Component(name) {}
    using Ports = mamori::Ports<>;

    Status on_execute(ContextHandle handle) noexcept override {
        if (count_ < kOpeningsMax) {
            openings_[count_] = {handle.now, rig_->get_host().get_now()};
        }
        ++count_;
        rig_->spend(time_);
        return Status::kOk;
    }

    void set_rig(TimerRig& rig) { rig_ = &rig; }
    void set_time(Duration time) { time_ = time; }
    Duration get_time() const { return time_; }
    std::vector<Opening> take() {
        const auto count = static_cast<std::ptrdiff_t>(std::min(count_, kOpeningsMax));
        std::vector<Opening> result{openings_.begin(), openings_.begin() + count};
        count_ = 0U;
        return result;
    }

  private:
    TimerRig* rig_{nullptr};
    Duration time_{0};
    std::array<Opening, kOpeningsMax> openings_{};
    std::size_t count_{0U};
};

class TimerSubject final {
  public:
    explicit TimerSubject(const TimerRigFactory& make_rig) {
        MAMORI_ENSURE(1, executive_.initialize() == Status::kOk && executive_.start() == Status::kOk);
        rig_ = make_rig(executive_);
        first_.set_rig(*rig_);
        second_.set_rig(*rig_);
    }

    bool is_slow() const { return first_.get_time() > kBudget; }
    void set_time(Duration time) {
        first_.set_time(time);
        rig_->plan(0U, time);
    }
    std::string describe_state() const {
        return std::string{is_slow() ? "slow " : "fast "} + (has_run_ ? "running" : "new");
    }

    void run(std::uint64_t frame_count, Judge& judge) {
        const TimerRig::Counts before = rig_->get_counts();
        rig_->run(frame_count);
        judge.expect(wait_for_return(), "late work never returned");
        const TimerRig::Counts counts = rig_->get_counts();
        const std::array<std::vector<Opening>, TimerRig::kWindowCount> seen{first_.take(), second_.take()};
        for (std::size_t window = 0U; window < seen.size(); ++window) {
            check_grid(window, seen[window], judge);
        }
        check_span(seen, frame_count, judge);
        const std::uint64_t ran = seen[0].size() + seen[1].size();
        const std::uint64_t missed = counts.missed - before.missed;
        const std::uint64_t overran = counts.overran - before.overran;
        const std::uint64_t wanted = frame_count * TimerRig::kWindowCount;
        judge.expect(ran + missed <= wanted, "a window started more than once in a major frame");
        judge.expect(ran + missed + overran >= wanted,
                     "a window did not start and was not reported as skipped");
        if (rig_->is_exact()) {
            judge.expect_equal(static_cast<std::int64_t>(ran), static_cast<std::int64_t>(wanted),
                               "window instances");
            judge.expect_equal(static_cast<std::int64_t>(overran),
                               is_slow() ? static_cast<std::int64_t>(frame_count) : 0, "overruns");
        }
        has_run_ = true;
    }

  private:
    static std::int64_t calc_frame(std::size_t window, Instant planned) {
        return (planned - Instant{0} - kOffsets.at(window)).ns / kFrame.ns;
    }

    /// Checks that each window starts on the schedule, in order, and not before its instant.
    void check_grid(std::size_t window, const std::vector<Opening>& openings, Judge& judge) const {
        Instant last = last_;
        for (const Opening& opening : openings) {
            const Duration since = opening.planned - Instant{0} - kOffsets.at(window);
            judge.expect(since >= Duration{0} && since.ns % kFrame.ns == 0,
                         "a window started at an instant that is not on the schedule");
            judge.expect(opening.planned > last, "a window started twice in a major frame or out of order");
            judge.expect(opening.seen >= opening.planned, "a window started before its instant");
            if (rig_->is_exact()) {
                judge.expect_equal(opening.seen, opening.planned, "a window did not start at its instant");
            }
            last = opening.planned;
        }
    }

    /// Checks that all windows are in the requested number of major frames, after those of the previous run.
    void check_span(const std::array<std::vector<Opening>, TimerRig::kWindowCount>& seen,
                    std::uint64_t frame_count, Judge& judge) {
        std::vector<std::int64_t> frames;
        for (std::size_t window = 0U; window < seen.size(); ++window) {
            for (const Opening& opening : seen[window]) {
                frames.push_back(calc_frame(window, opening.planned));
                last_ = std::max(last_, opening.planned, [](Instant a, Instant b) { return a < b; });
            }
        }
        if (frames.empty()) {
            return;
        }
        const auto [lowest, highest] = std::minmax_element(frames.begin(), frames.end());
        judge.expect(*highest - *lowest < static_cast<std::int64_t>(frame_count),
                     "more major frames ran than requested");
        if (rig_->is_exact()) {
            judge.expect_equal(*lowest, frame_ + 1, "first major frame");
        }
        frame_ = *highest;
    }

    bool wait_for_return() {
        WindowHost& host = rig_->get_host();
        for (int i = 0; i < kPatience; ++i) {
            if (host.has_returned(0U) && host.has_returned(1U)) {
                return true;
            }
            rig_->wait_until(host.get_now() + 1_ms);
        }
        return false;
    }

    Witness first_{"first"};
    Witness second_{"second"};
    SystemTable<2U, 2U, 0U, 0U> table_ =
        system(frame(kFrame), window("first", kOffsets[0], 3_ms, budget(kBudget), mamori::run(first_)),
               window("second", kOffsets[1], 3_ms, budget(kBudget), mamori::run(second_)));
    ExecutiveFor<decltype(table_)> executive_{table_};
    Instant last_{-1};
    std::int64_t frame_{-1};
    bool has_run_{false};
    std::unique_ptr<TimerRig> rig_;  ///< destroyed first, since it can wait for work
};

Rule<TimerSubject> make_run(const char* name, std::uint64_t frame_count, bool is_slow) {
    return {name, kRequirement,
            [is_slow](const TimerSubject& subject) { return subject.is_slow() == is_slow; },
            [frame_count](TimerSubject& subject, Judge& judge) { subject.run(frame_count, judge); }};
}

Rules<TimerSubject> make_rules() {
    return {
        make_run("one major frame", 1U, false),
        make_run("four major frames", 4U, false),
        {"the first component becomes slow", kRequirement,
         [](const TimerSubject& subject) { return !subject.is_slow(); },
         [](TimerSubject& subject, Judge&) { subject.set_time(kSlow); }},
        make_run("one major frame with a slow component", 1U, true),
        make_run("four major frames with a slow component", 4U, true),
        {"the first component is fast again", kRequirement,
         [](const TimerSubject& subject) { return subject.is_slow(); },
         [](TimerSubject& subject, Judge&) { subject.set_time(Duration{0}); }},
    };
}

}  // namespace

TrialFactory make_timer_trials(TimerRigFactory make_rig) {
    return make_trials<TimerSubject>(
        make_rules(), [make_rig = std::move(make_rig)] { return std::make_unique<TimerSubject>(make_rig); });
}

}  // namespace mamori::ports::conformance
