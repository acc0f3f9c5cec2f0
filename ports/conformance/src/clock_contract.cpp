// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/conformance/clock_contract.hpp"

#include <utility>

#include "mamori/ports/conformance/rule_trial.hpp"

namespace mamori::ports::conformance {
namespace {

constexpr const char* kRequirement = "SWR-CNF-001";

class ClockSubject final {
  public:
    explicit ClockSubject(std::unique_ptr<ClockRig> rig)
        : rig_(std::move(rig)), origin_(rig_->get_now()), last_(origin_) {}

    /// Reads the clock and compares it with the previous reading.
    Instant read(Judge& judge) {
        const Instant now = rig_->get_now();
        judge.expect(now >= last_, "the clock ran backwards");
        last_ = now > last_ ? now : last_;
        return now;
    }

    void read_often(Judge& judge) {
        const Instant before = last_;
        for (int i = 0; i < 1000; ++i) {
            static_cast<void>(read(judge));
        }
        if (rig_->is_exact()) {
            judge.expect_equal(last_, before, "time passed without a wait");
        }
    }

    /// @param[in] distance time from now to the instant; if negative, the instant has passed.
    void wait(Duration distance, Judge& judge) {
        const Instant before = read(judge);
        wait_until(before, before + distance, judge);
    }

    /// Waits for the next instant of a schedule that began with the port.
    void wait_for_grid(Judge& judge) {
        const Instant before = read(judge);
        const Duration period = rig_->get_tick() * 3;
        const std::int64_t passed = (before - origin_).ns / period.ns;
        wait_until(before, origin_ + period * (passed + 1), judge);
    }

    Duration get_tick() const { return rig_->get_tick(); }

    /// The state includes the position within a period of the schedule.
    std::string describe_state() const {
        const Duration period = rig_->get_tick() * 3;
        return rig_->is_exact() ? std::to_string((last_ - origin_).ns % period.ns) : "running";
    }

  private:
    void wait_until(Instant before, Instant until, Judge& judge) {
        rig_->wait_until(until);
        const Instant after = read(judge);
        judge.expect(after >= until, "a wait ended before its instant");
        if (rig_->is_exact()) {
            judge.expect_equal(after, until > before ? until : before, "a wait did not end at its instant");
        }
    }

    std::unique_ptr<ClockRig> rig_;
    Instant origin_;
    Instant last_;
};

Rule<ClockSubject> make_wait(const char* name, std::int64_t ticks, Duration more) {
    return {name, kRequirement, [](const ClockSubject&) { return true; },
            [ticks, more](ClockSubject& subject, Judge& judge) {
                subject.wait(subject.get_tick() * ticks + more, judge);
            }};
}

Rules<ClockSubject> make_rules() {
    const auto always = [](const ClockSubject&) { return true; };
    return {
        {"read the clock repeatedly", kRequirement, always,
         [](ClockSubject& subject, Judge& judge) { subject.read_often(judge); }},
        make_wait("wait one tick", 1, 0_ns),
        make_wait("wait a nanosecond", 0, 1_ns),
        make_wait("wait for now", 0, 0_ns),
        make_wait("wait for an instant that has passed", -2, 0_ns),
        {"wait for the next instant of the schedule", kRequirement, always,
         [](ClockSubject& subject, Judge& judge) { subject.wait_for_grid(judge); }},
    };
}

}  // namespace

TrialFactory make_clock_trials(RigFactory<ClockRig> make_rig) {
    return make_trials<ClockSubject>(make_rules(), [make_rig = std::move(make_rig)] {
        return std::make_unique<ClockSubject>(make_rig());
    });
}

}  // namespace mamori::ports::conformance
