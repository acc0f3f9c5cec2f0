// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/conformance/watchdog_contract.hpp"

#include <utility>

#include "mamori/ports/conformance/rule_trial.hpp"

namespace mamori::ports::conformance {
namespace {

constexpr const char* kRequirement = "SWR-CNF-006";

/// The model knows the two clock readings around the last service. With simulated time, both are equal, and
/// the expected result is exact. Otherwise, the result is not checked if the timeout is between the minimum
/// and the maximum elapsed time.
class WatchdogSubject final {
  public:
    enum class State : std::uint8_t { kSilent, kRunning, kExpired };

    explicit WatchdogSubject(RigFactory<WatchdogRig> make_rig)
        : make_rig_(std::move(make_rig)), rig_(make_rig_()) {}

    /// Simulates a power cycle, which is the only action that closes an open relay.
    void replace(Judge& judge) {
        rig_.reset();
        rig_ = make_rig_();
        state_ = State::kSilent;
        look(judge);
    }

    State get_state() const { return state_; }
    Duration get_timeout() const { return rig_->get_timeout(); }

    void service(Judge& judge) {
        const Instant before = rig_->get_now();
        const Status status = rig_->get_watchdog().service(before);
        const Instant after = rig_->get_now();
        if (must_have_expired(before)) {
            judge.expect(status == Status::kError, "a service was accepted though the relay is open");
            state_ = State::kExpired;
        } else if (may_have_expired(after) && status != Status::kOk) {
            state_ = State::kExpired;
        } else {
            judge.expect(status == Status::kOk, "a service in time was rejected");
            state_ = State::kRunning;
            serviced_from_ = before;
            serviced_until_ = after;
        }
        look(judge);
    }

    /// Compares the relay with the model.
    void look(Judge& judge) {
        const Instant before = rig_->get_now();
        const bool is_open = rig_->has_expired();
        const Instant after = rig_->get_now();
        judge.expect(is_open || !must_have_expired(before),
                     "the relay is closed though the timeout has elapsed");
        judge.expect(!is_open || may_have_expired(after), "the relay opened before the timeout");
        state_ = is_open ? State::kExpired : state_;
    }

    void pass(Duration time) { rig_->let_pass(time); }

    /// Waits for the rest of the timeout plus `more`.
    void pass_to_limit(Duration more) {
        const Duration left = serviced_until_ + rig_->get_timeout() + more - rig_->get_now();
        rig_->let_pass(left > Duration{0} ? left : Duration{0});
    }

    std::string describe_state() const {
        const std::int64_t quarters =
            state_ == State::kRunning ? (rig_->get_now() - serviced_until_).ns * 4 / get_timeout().ns : 0;
        return std::to_string(static_cast<int>(state_)) + " " + std::to_string(quarters > 4 ? 4 : quarters);
    }

  private:
    bool must_have_expired(Instant now) const {
        return state_ == State::kExpired ||
               (state_ == State::kRunning && now - serviced_until_ > rig_->get_timeout());
    }
    bool may_have_expired(Instant now) const {
        return state_ == State::kExpired ||
               (state_ == State::kRunning && now - serviced_from_ > rig_->get_timeout());
    }

    RigFactory<WatchdogRig> make_rig_;
    std::unique_ptr<WatchdogRig> rig_;
    State state_{State::kSilent};
    Instant serviced_from_{};
    Instant serviced_until_{};
};

using State = WatchdogSubject::State;

bool is_silent(const WatchdogSubject& subject) {
    return subject.get_state() == State::kSilent;
}
bool is_running(const WatchdogSubject& subject) {
    return subject.get_state() == State::kRunning;
}
bool is_expired(const WatchdogSubject& subject) {
    return subject.get_state() == State::kExpired;
}

void wait_twice(WatchdogSubject& subject, Judge& judge) {
    subject.pass(subject.get_timeout() * 2);
    subject.look(judge);
}
void service(WatchdogSubject& subject, Judge& judge) {
    subject.service(judge);
}

Rules<WatchdogSubject> make_rules() {
    return {
        {"time passes before the first service", kRequirement, is_silent, wait_twice},
        {"first service", kRequirement, is_silent, service},
        {"service again", kRequirement, is_running, service},
        {"a quarter of the time passes", kRequirement, is_running,
         [](WatchdogSubject& subject, Judge& judge) {
             subject.pass({subject.get_timeout().ns / 4});
             subject.look(judge);
         }},
        {"a service at the last instant", kRequirement, is_running,
         [](WatchdogSubject& subject, Judge& judge) {
             subject.pass_to_limit(0_ns);
             subject.look(judge);
             subject.service(judge);
         }},
        {"a service a nanosecond late", kRequirement, is_running,
         [](WatchdogSubject& subject, Judge& judge) {
             subject.pass_to_limit(1_ns);
             subject.service(judge);
         }},
        {"the timeout elapses", kRequirement, is_running, wait_twice},
        {"service after the timeout", kRequirement, is_expired, service},
        {"time passes after the timeout", kRequirement, is_expired, wait_twice},
        {"a new watchdog", kRequirement, is_expired,
         [](WatchdogSubject& subject, Judge& judge) { subject.replace(judge); }},
    };
}

}  // namespace

TrialFactory make_watchdog_trials(RigFactory<WatchdogRig> make_rig) {
    return make_trials<WatchdogSubject>(make_rules(), [make_rig = std::move(make_rig)] {
        return std::make_unique<WatchdogSubject>(make_rig);
    });
}

}  // namespace mamori::ports::conformance
