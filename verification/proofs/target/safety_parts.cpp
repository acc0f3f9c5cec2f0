// SPDX-License-Identifier: Apache-2.0
// Clock, platform property and watchdog with queries, as a platform would provide them, because the safety
// layer calls them through interfaces; and the self test of the processor that runs the image.
#include "safety_parts.hpp"

#include "mamori/safety/assumptions/assumption_checks.hpp"
#include "mamori/safety/self_test/clock_check.hpp"
#include "mamori/safety/self_test/cpu_check.hpp"
#include "mamori/safety/supervision/challenge_gate.hpp"

namespace proof {
namespace {

using mamori::Duration;
using mamori::Instant;
using mamori::Status;

/// Increases by the same amount at each reading.
class SteppingClock final : public mamori::safety::ClockSource {
  public:
    explicit constexpr SteppingClock(Duration step) noexcept : step_(step) {}
    Instant read() noexcept override {
        now_ = now_ + step_;
        return now_;
    }

  private:
    Duration step_;
    Instant now_{};
};

class Supply final : public mamori::safety::Provision {
  public:
    bool is_in_effect() noexcept override { return true; }
};

class AskingWatchdog final : public mamori::safety::ChallengeWatchdog {
  public:
    mamori::Result<std::uint32_t> get_question() noexcept override { return question_; }
    Status answer(Instant, std::uint32_t answer) noexcept override {
        return answer == question_ ? Status::kOk : Status::kBadParameter;
    }

  private:
    std::uint32_t question_{1U};
};

constexpr Duration kStep{1000};
constexpr Duration kWindow{10000};
constexpr mamori::safety::ClockRatioLimits kRatio{kWindow, 1000U};
constexpr std::size_t kSteps = 20U;

}  // namespace

static SteppingClock reference{kStep};
static SteppingClock tick{kStep};
static Supply supply;
static AskingWatchdog asking_watchdog;
static mamori::safety::ClockCheck clock_check{reference, tick, kRatio, kSteps};
static mamori::safety::CpuCheck<mamori::safety::NativeCpu> cpu_check;
static mamori::safety::TickSourceCheck tick_check{reference, tick, kRatio};
static mamori::safety::ProvisionCheck supply_check{supply};
static mamori::safety::ChallengeGate challenge_gate{asking_watchdog, {Duration{0}, kWindow}};

Status prepare_safety_parts() noexcept {
    using mamori::safety::ChallengeOutcome;
    using mamori::safety::GlobalStatus;
    using mamori::safety::SelfTestStatus;
    clock_check.begin();
    const bool is_running =
        clock_check.step() == SelfTestStatus::kRunning && tick_check.check() == SelfTestStatus::kRunning;
    cpu_check.begin();
    auto cpu = SelfTestStatus::kRunning;
    for (std::size_t step = 0U; step < cpu_check.get_step_count() && cpu == SelfTestStatus::kRunning;
         ++step) {
        cpu = cpu_check.step();
    }
    const bool is_supplied = supply_check.check() == SelfTestStatus::kPassed;
    const std::uint32_t question = challenge_gate.ask(Instant{});
    const bool is_answered =
        challenge_gate.step(Instant{}, GlobalStatus::kOk, true, question) == ChallengeOutcome::kAnswered;
    return is_running && cpu == SelfTestStatus::kPassed && is_supplied && is_answered ? Status::kOk
                                                                                      : Status::kError;
}

}  // namespace proof
