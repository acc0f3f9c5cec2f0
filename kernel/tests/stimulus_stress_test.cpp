// SPDX-License-Identifier: Apache-2.0
// Goal: stimuli from any thread race with nothing while a machine begins and ends its runs, and none of an
// earlier activation is served. Method: two senders at full speed beside many whole lives of a machine, under
// the thread sanitizer too; the order of a slow sender by hand.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>
#include <vector>

#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/kernel/component/fsm_check.hpp"
#include "mamori/kernel/component/fsm_component.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using namespace mamori::literals;
using namespace verification;

constexpr std::array<FsmState, 1> kStates{{{"on"}}};
constexpr std::array<FsmMessage, 1> kMessages{{{"tick"}}};
constexpr std::array<FsmTransition, 1> kTransitions{{{0U, 0U, 0U}}};
constexpr FsmTable kTable{"lamp", kStates, kMessages, kTransitions, 0U};
MAMORI_CHECK_FSM(kTable);

class Lamp final : public FsmComponentFor<8U> {
  public:
    Lamp() noexcept : FsmComponentFor("lamp", kTable, FsmProfile{}) {}
};

/// What senders got, by status.
struct Answers {
    std::uint64_t accepted{0U};
    std::uint64_t others{0U};
    std::uint64_t wrong{0U};
};

Answers send_until(const std::atomic<bool>& is_done, std::atomic<int>& sender_count, Lamp& lamp,
                   std::int32_t id) {
    Answers answers;
    ++sender_count;
    while (!is_done.load(std::memory_order_acquire)) {
        switch (lamp.send_stimulus(0U, ContextHandle{id, {}})) {
            case Status::kOk:
                ++answers.accepted;
                break;
            case Status::kPreconditionNotMet:
            case Status::kOutOfResources:
                ++answers.others;
                break;
            case Status::kBadParameter:
                id == -1 ? ++answers.wrong : ++answers.others;  // no such context while it is detached
                break;
            case Status::kError:
            case Status::kUnsupported:
                ++answers.wrong;
                break;
        }
    }
    return answers;
}

TEST(StimulusStressTest, SendersOnOtherThreadsDoNotDisturbTheLifeOfAMachine) {
    verifies("SWR-RTC-012", Technique::kFaultInjection);
    constexpr std::int32_t kId = 5;
    Lamp lamp;
    const std::array<Component*, 1> participants{&lamp};
    ExecutionContext context;
    ContextPlan plan{1_ms};
    plan.kind = ExecutionKind::kEventDriven;
    plan.events_per_cycle = 4U;
    std::atomic<bool> is_done{false};
    std::atomic<int> sender_count{0};
    std::array<Answers, 2U> answers{};
    std::vector<std::thread> senders;
    senders.emplace_back([&] { answers[0] = send_until(is_done, sender_count, lamp, -1); });
    senders.emplace_back([&] { answers[1] = send_until(is_done, sender_count, lamp, kId); });
    std::uint64_t bad_calls = 0U;
    const auto expect_ok = [&](Status status) { bad_calls += status == Status::kOk ? 0U : 1U; };

    while (sender_count < 2) {
        std::this_thread::yield();  // a busy host may start them after the last life
    }
    for (int life = 0; life < 2000; ++life) {
        expect_ok(lamp.initialize());
        expect_ok(context.attach(kId, participants, plan));
        expect_ok(context.start(Instant{life}));
        expect_ok(context.activate_component(lamp, Instant{life}));
        for (int cycle = 0; cycle < 3; ++cycle) {
            expect_ok(context.begin_cycle(Instant{life}));
            context.execute_range(0U, 1U);
            context.end_cycle();
        }
        expect_ok(context.deactivate_component(lamp, Instant{life}));
        expect_ok(context.stop(Instant{life}));
        expect_ok(context.detach());
        expect_ok(lamp.finalize());
        if (life % 16 == 0) {
            std::this_thread::yield();
        }
    }
    is_done.store(true, std::memory_order_release);
    for (std::thread& sender : senders) {
        sender.join();
    }

    EXPECT_EQ(bad_calls, 0U);
    EXPECT_EQ(answers[0].wrong + answers[1].wrong, 0U);
    EXPECT_GT(answers[0].accepted + answers[0].others + answers[1].accepted + answers[1].others, 0U);
}

TEST(StimulusOrderTest, AnEventOfASenderThatWasInterruptedIsNotServedInTheNextActivation) {
    verifies("SWR-RTC-012", Technique::kErrorGuessing, Polarity::kViolation);
    std::array<FsmEventCell, 4U> cells{};
    FsmEventQueue sut{cells};
    const std::uint32_t epoch = sut.get_epoch();
    ASSERT_EQ(sut.post({0U, 1}), Status::kOk);
    sut.clear();  // as the next activation does, before the sender goes on

    ASSERT_EQ(sut.post({0U, 2}, epoch), Status::kOk);
    ASSERT_EQ(sut.post({0U, 3}), Status::kOk);
    const Result<FsmEvent> event = sut.take();
    ASSERT_TRUE(event.has_value());
    EXPECT_EQ(event.get_value().argument, 3);
    EXPECT_FALSE(sut.take().has_value());
    EXPECT_EQ(sut.get_size(), 0U);
}

}  // namespace
}  // namespace mamori
