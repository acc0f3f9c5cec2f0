// SPDX-License-Identifier: Apache-2.0
// Goal: the executive moves a value exactly where its connection says, also where several connections leave
// one component; names and instants are told as they are.
// Method: small systems run by hand, in which one of several possible ways must not be taken.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "mamori/kernel/component/action_failure.hpp"
#include "mamori/kernel/dataflow/queue_in_port.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/fake_host.hpp"
#include "support/flow_components.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;
using Values = std::vector<std::int64_t>;

/// Writes into one of two outputs in turn.
class Switch final : public Component {
  public:
    Switch() : Component("switch") {}
    OutPort<std::int64_t> left{*this, "left"};
    OutPort<std::int64_t> right{*this, "right"};
    using Ports = mamori::Ports<&Switch::left, &Switch::right>;

    Status on_execute(ContextHandle) noexcept override {
        ++cycle_count_;
        (cycle_count_ % 2 == 1 ? left : right).write(cycle_count_);
        return Status::kOk;
    }

  private:
    std::int64_t cycle_count_{0};
};
class Queue final : public Component {
  public:
    explicit Queue(const char* name) : Component(name) {}
    QueueInPort<std::int64_t, 8U, FullPolicy::kDoNothing, EmptyPolicy::kDoNothing> in{*this, "in"};
    using Ports = mamori::Ports<&Queue::in>;
    Values values;

    Status on_execute(ContextHandle) noexcept override {
        std::int64_t value = 0;
        while (in.read(value) == Status::kOk) {
            values.push_back(value);
        }
        return Status::kOk;
    }
};

/// Runs the only window of `sut` in four frames of 40 ns.
void run_frames(Executive& sut) {
    FakeHost host;
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    for (std::int64_t t = 0; t < 160; t += 40) {
        host.now = Instant{t};
        ASSERT_EQ(sut.run_window(0U, host), WindowOutcome::kCompleted);
    }
}

TEST(FlowLimitsTest, AValueIsDeliveredToTheConnectionsOfItsOwnOutputOnly) {
    verifies("SWR-KRN-028", Technique::kEquivalenceClasses);
    Switch source;
    Queue left{"left"};
    Queue right{"right"};
    const auto table = system(frame(40_ns), window("w", 0_ns, 5_ns, budget(5_ns), run(left, right, source)),
                              connect(source.left, left.in, any_age(), delayed_by_a_frame()),
                              connect(source.right, right.in, any_age(), delayed_by_a_frame()));
    ExecutiveFor sut{table};
    run_frames(sut);

    EXPECT_EQ(left.values, (Values{1, 3}));
    EXPECT_EQ(right.values, Values{2}) << "the value of the last frame waits for the next";
}

TEST(FlowLimitsTest, AValueThroughACrossingArrivesAtTheNextOpeningWithinAWindowToo) {
    verifies("SWR-KRN-026", Technique::kEquivalenceClasses);
    Counter counter;
    Sink buffered{"buffered"};
    Sink direct{"direct"};
    Crossing<std::int64_t> crossing;
    const auto table =
        system(frame(40_ns), window("w", 0_ns, 5_ns, budget(5_ns), run(counter, buffered, direct)),
               connect(counter.out, buffered.in, through(crossing), any_age()),
               connect(counter.out, direct.in, any_age()));
    ExecutiveFor sut{table};
    run_frames(sut);

    EXPECT_EQ(buffered.get_values(), (Values{0, 10, 20, 30}));
    EXPECT_EQ(direct.get_values(), (Values{10, 20, 30, 40})) << "handed on within the window";
}

TEST(FlowLimitsTest, AnOutputTellsWhenItWasPublishedLast) {
    verifies("SWR-KRN-015", Technique::kStateTransition);
    OutPort<std::int64_t> sut{kNoOwner, "out"};
    sut.write(1);
    ASSERT_TRUE(sut.publish(Instant{5}));
    sut.write(2);

    EXPECT_EQ(sut.get_published_at(), Instant{5});
    EXPECT_TRUE(sut.publish(Instant{9}));
    EXPECT_EQ(sut.get_published_at(), Instant{9});
    EXPECT_FALSE(sut.publish(Instant{11}));
    EXPECT_EQ(sut.get_published_at(), Instant{9});
}

TEST(FlowLimitsTest, EveryActionHasANameOfItsOwn) {
    verifies("SWR-RTC-004", Technique::kInterface);
    const int action_count = static_cast<int>(ComponentAction::kModeChanged) + 1;
    std::set<std::string> names;

    for (int action = 0; action <= action_count; ++action) {
        names.insert(get_name(static_cast<ComponentAction>(action)));
    }
    EXPECT_EQ(names.size(), static_cast<std::size_t>(action_count) + 1U);
    EXPECT_EQ(names.count("invalid_action"), 1U) << "what is no action";
}

template <typename T>
void expect_no_success(Status status) {
    const Result<T> result{status};
    EXPECT_FALSE(result.has_value());
    EXPECT_EQ(result.get_status(), status == Status::kOk ? Status::kError : status);
}
TEST(FlowLimitsTest, AResultWithoutAValueIsNeverASuccess) {
    verifies("SWR-KRN-001", Technique::kBoundaryValues);

    for (const Status status :
         std::vector<Status>{Status::kOk, Status::kError, Status::kPreconditionNotMet}) {
        expect_no_success<int>(status);
        expect_no_success<Instant>(status);
    }
}

}  // namespace
}  // namespace mamori
