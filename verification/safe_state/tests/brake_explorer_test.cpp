// SPDX-License-Identifier: Apache-2.0
// Goal: the explorer records the results of the compiled brake sequence, and rejects a sequence that the
// relation cannot describe. Method: the shipped sequence and its relation get the same random calls and
// times, alone and under the shipped safe-state machine; sequences with additional memory or another
// dependence on time.
#include "brake_explorer.hpp"

#include <random>
#include <stdexcept>
#include <string>

#include "mamori/safety/reaction/safe_state_machine.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::verification {
namespace {

using safety::BrakeSequence;

constexpr Duration kCloses{30};

const BrakeRelation& get_relation() {
    static const BrakeRelation relation = explore_all_brakes<BrakeSequence>();
    return relation;
}

/// Follows the relation as its readers do: a situation, and the time of the command.
class RelationWalk {
  public:
    explicit RelationWalk(bool has_contacts)
        : situation_(has_contacts ? 0U : get_relation().first_without_contacts) {}

    bool confirm(SafeState state, bool is_standing, bool are_closed, Instant now) {
        const std::size_t digit =
            ((get_digit(state) * 2U + (is_standing ? 1U : 0U)) * 2U) + (are_closed ? 1U : 0U);
        return take(get().confirm[digit * kClosingTimeCount + classify(now)], now).is_confirmed;
    }

    StopOutputs apply(SafeState state, Instant now) {
        return take(get().apply[get_digit(state) * kClosingTimeCount + classify(now)], now).outputs;
    }

    bool is_overdue(Instant now) const { return get().is_overdue[classify(now)]; }
    bool is_closing(Instant now) const { return get().is_closing[classify(now)]; }

  private:
    static std::size_t get_digit(SafeState state) {
        return is_valid(state) ? static_cast<std::size_t>(state) - 1U : safety::kSafeStateCount;
    }

    const BrakeSituation& get() const { return get_relation().situations[situation_]; }

    std::size_t classify(Instant now) const {
        const std::int64_t elapsed = (now - told_at_).ns;
        const auto time = elapsed < 0            ? ClosingTime::kBeforeCommand
                          : elapsed < kCloses.ns ? ClosingTime::kWithin
                          : elapsed > kCloses.ns ? ClosingTime::kBeyond
                                                 : ClosingTime::kAtBound;
        return static_cast<std::size_t>(time);
    }

    CallAnswer take(CallAnswer answer, Instant now) {
        situation_ = answer.next;
        told_at_ = answer.is_told_now ? now : told_at_;
        return answer;
    }

    std::size_t situation_;
    Instant told_at_{};
};

/// Advances by a random time: often by part of the closing time, sometimes to its end, sometimes backwards.
Instant advance(Instant now, std::mt19937& random) {
    const auto choice = random() % 10U;
    const std::int64_t step = choice == 0U  ? -40
                              : choice < 4U ? 30
                                            : static_cast<std::int64_t>(random() % 16U);
    return now + Duration{step};
}

TEST(BrakeExplorerTest, RelationSaysWhatTheCompiledSequenceAnswersToRandomCalls) {
    verifies("SWR-FSM-032", Technique::kBackToBack);
    std::mt19937 random{1U};  // NOLINT(cert-msc51-cpp): the same run each time

    for (int run = 0; run < 2000; ++run) {
        const bool has_contacts = run % 2 == 0;
        BrakeSequence sut{{kCloses, has_contacts}};
        RelationWalk walk{has_contacts};
        Instant now{static_cast<std::int64_t>(random() % 1000U)};
        for (int call = 0; call < 60; ++call) {
            now = advance(now, random);
            const auto state = static_cast<SafeState>(random() % 12U);  // 0 and 11 are invalid
            const bool is_standing = random() % 2U == 0U;
            const bool are_closed = random() % 2U == 0U;
            if (random() % 2U == 0U) {
                ASSERT_EQ(walk.confirm(state, is_standing, are_closed, now),
                          sut.confirm(state, is_standing, are_closed, now))
                    << "run " << run;
            } else {
                ASSERT_TRUE(walk.apply(state, now) == sut.apply(state, now)) << "run " << run;
            }
            ASSERT_EQ(walk.is_overdue(now), sut.is_overdue(now)) << "run " << run;
            ASSERT_EQ(walk.is_closing(now), sut.is_closing(now)) << "run " << run;
        }
    }
}

TEST(BrakeExplorerTest, RelationSaysWhatTheCompiledSequenceDoesUnderTheMachine) {
    verifies("SWR-FSM-032", Technique::kBackToBack);
    std::mt19937 random{2U};  // NOLINT(cert-msc51-cpp): the same run each time
    std::array<std::size_t, safety::kSafeStateCount + 1U> visits{};

    for (int run = 0; run < 2000; ++run) {
        const bool has_contacts = run % 2 == 0;
        safety::SafeStateMachine machine{{Duration{60}, Duration{90}}};
        BrakeSequence sut{{kCloses, has_contacts}};
        RelationWalk walk{has_contacts};
        safety::SafeStateInputs inputs;
        inputs.faults_cleared = true;
        inputs.start_permitted = true;
        for (int cycle = 0; cycle < 80; ++cycle) {
            inputs.now = advance(inputs.now, random);
            const auto choice = random() % 12U;
            inputs.demand = choice < 5U ? static_cast<safety::Reaction>(choice) : safety::Reaction::kNone;
            inputs.self_test =
                cycle % 2 == 0 ? safety::SelfTestStatus::kRunning : safety::SelfTestStatus::kPassed;
            inputs.start_button = random() % 2U == 0U;
            inputs.reset_button = random() % 2U == 0U;
            const bool is_standing = random() % 4U != 0U;
            const bool are_closed = random() % 3U == 0U;
            const SafeState before = machine.get_state();
            inputs.standstill = sut.confirm(before, is_standing, are_closed, inputs.now);
            inputs.brakes_failed = random() % 4U == 0U && sut.is_waiting();
            ASSERT_EQ(walk.confirm(before, is_standing, are_closed, inputs.now), inputs.standstill);
            const SafeState after = machine.step(inputs);
            ++visits[static_cast<std::size_t>(after)];
            ASSERT_TRUE(walk.apply(after, inputs.now) == sut.apply(after, inputs.now)) << "run " << run;
            ASSERT_EQ(walk.is_overdue(inputs.now), sut.is_overdue(inputs.now)) << "run " << run;
        }
    }
    for (std::size_t state = 1U; state <= safety::kSafeStateCount; ++state) {
        EXPECT_GT(visits[state], 50U) << get_name(static_cast<SafeState>(state));
    }
}

TEST(BrakeExplorerTest, EveryCallIsAnsweredInEverySituation) {
    verifies("SWR-FSM-032");

    ASSERT_GT(get_relation().situations.size(), 10U);
    for (const BrakeSituation& situation : get_relation().situations) {
        ASSERT_EQ(situation.confirm.size(), kConfirmLetters);
        ASSERT_EQ(situation.apply.size(), kApplyLetters);
    }
}

/// The shipped sequence with additions. A derived class appends its members to those of the shipped sequence.
class Extended {
  public:
    explicit constexpr Extended(BrakeLimits limits) noexcept : sequence_(limits) {}

    bool confirm(SafeState state, bool is_standing, bool are_closed, Instant now) noexcept {
        return sequence_.confirm(state, is_standing, are_closed, now);
    }
    StopOutputs apply(SafeState state, Instant now) noexcept { return sequence_.apply(state, now); }
    bool is_overdue(Instant now) const noexcept { return sequence_.is_overdue(now); }
    bool is_closing(Instant now) const noexcept { return sequence_.is_closing(now); }

  protected:
    BrakeSequence sequence_;
};

class CountingSequence final : public Extended {
  public:
    using Extended::Extended;
    StopOutputs apply(SafeState state, Instant now) noexcept {
        ++count_;
        return sequence_.apply(state, now);
    }

  private:
    std::uint64_t count_{0U};
};

/// Ignores standstill at every other tick.
class MoodySequence final : public Extended {
  public:
    using Extended::Extended;
    bool confirm(SafeState state, bool is_standing, bool are_closed, Instant now) noexcept {
        return sequence_.confirm(state, is_standing && now.ns % 2 == 0, are_closed, now);
    }
};

/// Receives half of the time.
class SlowSequence final : public Extended {
  public:
    using Extended::Extended;
    StopOutputs apply(SafeState state, Instant now) noexcept {
        return sequence_.apply(state, now.ns > 0 ? Instant{now.ns / 2} : now);
    }
};

/// Treats one invalid state number as Operational.
class TellingSequence final : public Extended {
  public:
    using Extended::Extended;
    StopOutputs apply(SafeState state, Instant now) noexcept {
        const bool is_eleven = static_cast<std::uint8_t>(state) == 11U;
        return sequence_.apply(is_eleven ? SafeState::kOperational : state, now);
    }
};

/// Also stores the time of each call.
class TimedSequence final : public Extended {
  public:
    using Extended::Extended;
    StopOutputs apply(SafeState state, Instant now) noexcept {
        applied_at_ = now;
        return sequence_.apply(state, now);
    }

  private:
    Instant applied_at_{};
};

/// Reports overdue brakes two ticks late.
class PatientSequence final : public Extended {
  public:
    using Extended::Extended;
    bool is_overdue(Instant now) const noexcept {
        return sequence_.is_overdue(now) && sequence_.is_overdue(now + Duration{-2});
    }
};

/// @return why the explorer rejects the sequence; empty if it accepts the sequence.
template <typename Sequence>
std::string refuse() {
    try {
        static_cast<void>(explore_all_brakes<Sequence>());
        return "";
    } catch (const std::runtime_error& error) {
        return error.what();
    }
}

TEST(BrakeExplorerTest, SequenceWithoutAnEndOfSituationsIsRefused) {
    verifies("SWR-FSM-033", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ(refuse<CountingSequence>(), "the sequence has no end of situations");
}

TEST(BrakeExplorerTest, SequenceThatDependsOnTimeInAnotherWayIsRefused) {
    verifies("SWR-FSM-033", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ(refuse<MoodySequence>(),
              "the sequence depends on time in another way than by its closing time");
    EXPECT_EQ(refuse<SlowSequence>(),
              "a call keeps another time of the command than its own or the one before");
    EXPECT_EQ(refuse<TimedSequence>(), "the sequence keeps its command in another way than as one instant");
    EXPECT_EQ(refuse<PatientSequence>(), "what is overdue or closing depends on more than the closing time");
}

TEST(BrakeExplorerTest, SequenceThatTellsInvalidNumbersApartIsRefused) {
    verifies("SWR-FSM-033", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ(refuse<TellingSequence>(),
              "the sequence behaves differently with other times or invalid numbers");
}

}  // namespace
}  // namespace mamori::verification
