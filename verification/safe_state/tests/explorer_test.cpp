// SPDX-License-Identifier: Apache-2.0
// Goal: the explorer records the behaviour of the compiled machine, and rejects a machine that the relation
// cannot describe. Method: the shipped machine and its relation get the same random inputs and times;
// machines with additional memory or another dependence on time.
#include "explorer.hpp"

#include <random>
#include <stdexcept>
#include <string>

#include "mamori/trace/verifies.hpp"

namespace mamori::verification {
namespace {

using safety::SafeStateMachine;

const Relation& get_relation() {
    static const Relation relation = explore_all<SafeStateMachine>();
    return relation;
}

/// The inputs except time as digits of a letter; see make_input_kinds().
std::size_t get_letter(std::size_t inputs, TimeClass time) {
    return inputs * kTimeClassCount + static_cast<std::size_t>(time);
}

TEST(ExplorerTest, RelationSaysWhatTheCompiledMachineDoesInRunsOfAnyLength) {
    verifies("SWR-FSM-020", Technique::kBackToBack);
    const Relation& relation = get_relation();
    const StopBounds bounds{Duration{30}, Duration{70}};
    const std::vector<SafeStateInputs> all_inputs = make_all_inputs(200U);
    std::mt19937 random{1U};  // NOLINT(cert-msc51-cpp): the same run each time

    for (int run = 0; run < 2000; ++run) {
        SafeStateMachine machine{bounds};
        std::size_t situation = 0U;
        Instant now{static_cast<std::int64_t>(random())};
        for (int cycle = 0; cycle < 50; ++cycle) {
            const std::size_t choice = random() % all_inputs.size();
            SafeStateInputs inputs = all_inputs[choice];
            now = now + Duration{static_cast<std::int64_t>(random() % 40U)};
            inputs.now = now;
            const Limit limit = relation.situations[situation].limit;
            const Duration bound = limit == Limit::kSs2 ? bounds.ss2_within : bounds.ss1_within;
            const Duration elapsed = now - machine.get_entered_at();
            const TimeClass time = elapsed < bound    ? TimeClass::kWithin
                                   : elapsed == bound ? TimeClass::kAtBound
                                                      : TimeClass::kBeyond;
            situation = relation.situations[situation].next[get_letter(choice, time)];
            ASSERT_EQ(machine.step(inputs), relation.situations[situation].state) << "run " << run;
        }
    }
}

TEST(ExplorerTest, EveryCombinationOfInputsIsAnsweredInEverySituation) {
    verifies("SWR-FSM-020");
    const Relation& relation = get_relation();
    std::size_t letters = 1U;
    for (const InputKind& kind : make_input_kinds()) {
        letters *= kind.values.size();
    }

    EXPECT_EQ(letters, make_all_inputs(255U).size() * kTimeClassCount);
    ASSERT_EQ(relation.situations.size(), 82U);
    for (const Situation& situation : relation.situations) {
        ASSERT_EQ(situation.next.size(), letters);
        EXPECT_EQ(situation.limit != Limit::kNone, situation.state == SafeState::kProtectiveStopSs2 ||
                                                       situation.state == SafeState::kProtectiveStopSs1);
    }
    EXPECT_FALSE(relation.situations.back().is_consistent) << "all corrupted objects behave alike";
    EXPECT_EQ(relation.corrupted_objects, 81U * 16U) << "each bit of the state and of its complement";
}

/// The shipped machine with additions. A derived class appends its members to those of the shipped machine.
class Extended {
  public:
    explicit constexpr Extended(StopBounds bounds) noexcept : machine_(bounds) {}

    SafeState get_state() const noexcept { return machine_.get_state(); }
    Instant get_entered_at() const noexcept { return machine_.get_entered_at(); }
    bool is_consistent() const noexcept { return machine_.is_consistent(); }

  protected:
    SafeStateMachine machine_;
};

class CountingMachine final : public Extended {
  public:
    using Extended::Extended;
    SafeState step(const SafeStateInputs& inputs) noexcept {
        ++count_;
        return machine_.step(inputs);
    }

  private:
    std::uint64_t count_{0U};
};

/// Ignores standstill at every other tick.
class MoodyMachine final : public Extended {
  public:
    using Extended::Extended;
    SafeState step(const SafeStateInputs& inputs) noexcept {
        SafeStateInputs seen = inputs;
        seen.standstill = inputs.standstill && (inputs.now - machine_.get_entered_at()).ns % 2 == 0;
        return machine_.step(seen);
    }
};

/// Stores half of the entry time of each state.
class SlowMachine final : public Extended {
  public:
    using Extended::Extended;
    SafeState step(const SafeStateInputs& inputs) noexcept {
        SafeStateInputs seen = inputs;
        seen.now = inputs.now.ns > 0 ? Instant{inputs.now.ns / 2} : inputs.now;
        return machine_.step(seen);
    }
};

/// Treats one invalid demand number as no demand.
class TellingMachine final : public Extended {
  public:
    using Extended::Extended;
    SafeState step(const SafeStateInputs& inputs) noexcept {
        SafeStateInputs judged = inputs;
        if (static_cast<std::uint8_t>(inputs.demand) == 5U) {
            judged.demand = Reaction::kNone;
        }
        return machine_.step(judged);
    }
};

/// Also stores the time of each step.
class TimedMachine final : public Extended {
  public:
    using Extended::Extended;
    SafeState step(const SafeStateInputs& inputs) noexcept {
        stepped_at_ = inputs.now;
        return machine_.step(inputs);
    }

  private:
    Instant stepped_at_{};
};

/// @return why the explorer rejects the machine; empty if it accepts the machine.
template <typename Machine>
std::string refuse() {
    try {
        static_cast<void>(explore_all<Machine>());
        return "";
    } catch (const std::runtime_error& error) {
        return error.what();
    }
}

TEST(ExplorerTest, MachineWithoutAnEndOfSituationsIsRefused) {
    verifies("SWR-FSM-021", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ(refuse<CountingMachine>(), "the machine has no end of situations");
}

TEST(ExplorerTest, MachineThatDependsOnTimeInAnotherWayIsRefused) {
    verifies("SWR-FSM-021", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_NE(refuse<MoodyMachine>().find("depends on time in another way"), std::string::npos);
    EXPECT_EQ(refuse<SlowMachine>(), "a step answers one state and keeps another, or another time of entry");
    EXPECT_EQ(refuse<TimedMachine>(), "the machine keeps its entry time in another way than as one instant");
}

TEST(ExplorerTest, MachineThatTellsInvalidNumbersApartIsRefused) {
    verifies("SWR-FSM-021", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ(refuse<TellingMachine>(),
              "the machine behaves differently with other bounds or invalid numbers");
}

}  // namespace
}  // namespace mamori::verification
