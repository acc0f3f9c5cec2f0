// SPDX-License-Identifier: Apache-2.0
// Goal: what interrupts a sender of events, or a request for a parameter, at any place loses nothing and
// tears nothing. Method: the objects lie in pages of their own, which are closed in turns; before each access
// to them the test does what an interrupt or another thread could do there.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>
#include <vector>

#include "mamori/kernel/component/detail/fsm_event_queue.hpp"
#include "mamori/kernel/parameter/parameter.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/page_steps.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

using Cells = std::array<FsmEventCell, 4U>;

class InterruptLimitsTest : public ::testing::Test {
  protected:
    struct Outcome {
        std::size_t turn_count;
        Status status;
        std::vector<std::int64_t> left;  ///< events that wait afterwards
    };
    /// Posts event 1 into an empty queue; `interrupt(queue)` comes before turn `at`.
    template <typename Interrupt>
    static Outcome post_interrupted(std::size_t at, Interrupt interrupt) {
        PagedObject<Cells> cells;
        PagedObject<FsmEventQueue> queue{Span<FsmEventCell>{*cells}};
        Outcome outcome{0U, Status::kError, {}};
        outcome.turn_count = run_interrupted(
            queue, cells, at, [&] { outcome.status = queue->post({0U, 1}); }, [&] { interrupt(*queue); });
        EXPECT_LE(queue->get_high_water_mark(), 4U);
        for (Result<FsmEvent> event = queue->take(); event.has_value(); event = queue->take()) {
            outcome.left.push_back(event.get_value().argument);
        }
        EXPECT_EQ(queue->get_size(), 0U);
        return outcome;
    }
};

TEST_F(InterruptLimitsTest, AnEventOfAnInterruptAndThatOfTheInterruptedSenderBothArrive) {
    verifies("SWR-RTC-009", Technique::kFaultInjection);
    std::size_t overtaken_count = 0U;
    std::size_t at = 0U;

    for (std::size_t turn_count = 1U; at < turn_count; ++at) {
        Status second = Status::kError;
        const Outcome outcome =
            post_interrupted(at, [&second](FsmEventQueue& queue) { second = queue.post({0U, 2}); });
        turn_count = outcome.turn_count;
        EXPECT_EQ(outcome.status, Status::kOk) << at;
        EXPECT_EQ(second, Status::kOk) << at;
        ASSERT_EQ(outcome.left.size(), 2U) << at;
        EXPECT_EQ(outcome.left[0] + outcome.left[1], 3) << at;
        overtaken_count += outcome.left[0] == 2 ? 1U : 0U;
    }
    EXPECT_GT(overtaken_count, 0U) << "the interrupt came first";
    EXPECT_LT(overtaken_count, at) << "the sender had its place";
}

TEST_F(InterruptLimitsTest, AReaderThatIsFasterThanTheSenderGetsEachEventOnce) {
    verifies("SWR-RTC-009", Technique::kFaultInjection);
    std::size_t at = 0U;
    std::size_t whole_count = 0U;

    for (std::size_t turn_count = 1U; at < turn_count; ++at) {
        std::int64_t sum = 0;
        const Outcome outcome = post_interrupted(at, [&sum](FsmEventQueue& queue) {
            static_cast<void>(queue.post({0U, 2}));
            for (Result<FsmEvent> event = queue.take(); event.has_value(); event = queue.take()) {
                sum += event.get_value().argument;
            }
        });
        turn_count = outcome.turn_count;
        whole_count += outcome.left.empty() ? 1U : 0U;
        for (const std::int64_t argument : outcome.left) {
            sum += argument;
        }
        EXPECT_EQ(outcome.status, Status::kOk) << at;
        EXPECT_EQ(sum, 3) << at;
    }
    EXPECT_GT(whole_count, 0U) << "the reader took what the sender still counted";
}

TEST_F(InterruptLimitsTest, ClearingStopsAtAnEventThatIsNotWholeYet) {
    verifies("SWR-RTC-009", Technique::kFaultInjection, Polarity::kViolation);
    std::size_t at = 0U;
    std::size_t kept_count = 0U;

    for (std::size_t turn_count = 1U; at < turn_count; ++at) {
        const Outcome outcome = post_interrupted(at, [](FsmEventQueue& queue) { queue.clear(); });
        turn_count = outcome.turn_count;
        EXPECT_EQ(outcome.status, Status::kOk) << at;
        EXPECT_LE(outcome.left.size(), 1U) << at;
        kept_count += outcome.left.size();
    }
    EXPECT_GT(kept_count, 0U);
}

TEST_F(InterruptLimitsTest, ClearingLeavesWhatComesMeanwhile) {
    verifies("SWR-RTC-009", Technique::kFaultInjection, Polarity::kViolation);
    std::size_t dropped_count = 0U;
    std::size_t at = 0U;

    for (std::size_t turn_count = 1U; at < turn_count; ++at) {
        PagedObject<Cells> cells;
        PagedObject<FsmEventQueue> queue{Span<FsmEventCell>{*cells}};
        ASSERT_EQ(queue->post({0U, 1}), Status::kOk);
        ASSERT_EQ(queue->post({0U, 2}), Status::kOk);
        turn_count = run_interrupted(
            queue, cells, at, [&] { queue->clear(); }, [&] { EXPECT_EQ(queue->post({0U, 3}), Status::kOk); });
        const Result<FsmEvent> left = queue->take();
        dropped_count += left.has_value() ? 0U : 1U;
        EXPECT_EQ(left.has_value() ? left.get_value().argument : 3, 3) << at;
    }
    EXPECT_EQ(dropped_count, 1U) << "the one that came before the queue was looked at";
    EXPECT_GT(at, 2U);
}

class OvertakenSenderTest : public InterruptLimitsTest {
  protected:
    /// Posts event 1 into an empty queue while `count` others post at the worst instant, each before an
    /// exchange of the sender; the reader takes their events at once.
    Status post_overtaken(std::size_t count) {
        Status status = Status::kError;
        std::size_t left = count;
        run_in_turns(
            queue_, cells_, [&] { status = queue_->post({0U, 1}); },
            [&](std::size_t turn) {
                // It reads its position, looks at the cell, and then each exchange follows a look at a cell.
                const bool is_exchange = turn > 0U && turn % 2U == 0U;
                if (is_exchange && left > 0U) {
                    --left;
                    EXPECT_EQ(queue_->post({0U, 2}), Status::kOk);
                    EXPECT_TRUE(queue_->take().has_value());
                }
            });
        EXPECT_EQ(left, 0U);
        return status;
    }

    PagedObject<Cells> cells_;
    PagedObject<FsmEventQueue> queue_{Span<FsmEventCell>{*cells_}};
};

TEST_F(OvertakenSenderTest, ASenderWaitsForAsManyOthersAsThereAreCells) {
    verifies("SWR-RTC-009", Technique::kBoundaryValues);

    EXPECT_EQ(post_overtaken(4U), Status::kOk);
    EXPECT_EQ(queue_->get_refused_count(), 0U);
    EXPECT_EQ(queue_->take().get_value().argument, 1);
}

TEST_F(OvertakenSenderTest, ASenderThatIsOvertakenOnceMoreIsRefusedAndCounted) {
    verifies("SWR-RTC-009", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_EQ(post_overtaken(5U), Status::kOutOfResources);
    EXPECT_EQ(queue_->get_refused_count(), 1U);
    EXPECT_FALSE(queue_->take().has_value());
}

TEST_F(OvertakenSenderTest, AFullQueueIsLookedAtNoMoreThanOneWithRoom) {
    verifies("SWR-RTC-009", Technique::kBoundaryValues, Polarity::kViolation);
    const auto count_turns = [this](Status wanted) {
        Status status = Status::kError;
        const std::size_t turn_count =
            run_in_turns(queue_, cells_, [&] { status = queue_->post({0U, 1}); }, [](std::size_t) {});
        EXPECT_EQ(status, wanted);
        return turn_count;
    };
    const std::size_t with_room = count_turns(Status::kOk);
    for (int i = 0; i < 3; ++i) {
        ASSERT_EQ(queue_->post({0U, 1}), Status::kOk);
    }

    EXPECT_LE(count_turns(Status::kOutOfResources), with_room);
}

// A parameter of nine pages and more: active value, requested value, and last the slot of the request.
using LargeValue = std::array<double, 2048U>;
using LargeParameter = Parameter<LargeValue, 1U>;
using Paged = PagedObject<LargeParameter>;
constexpr std::size_t kRequestedPage = 6U;
constexpr std::size_t kSlotPage = Paged::kPages - 1U;

TEST(InterruptLimitsParameterTest, ARequestWithinARequestIsRefusedAndACommitWithinItWaits) {
    verifies("SWR-PAR-005", Technique::kFaultInjection, Polarity::kViolation);
    Paged sut{kNoOwner, "large", LargeValue{}};
    LargeValue one{};
    one.fill(1.0);
    Status inner = Status::kError;
    bool is_committed = true;
    {
        const FaultHandler handler{[&](const void*) {
            sut.protect(kRequestedPage, 1U, PROT_READ | PROT_WRITE);
            inner = sut->request(LargeValue{});
            is_committed = sut->commit();
        }};
        sut.protect(kRequestedPage, 1U, PROT_READ);
        EXPECT_EQ(sut->request(one), Status::kOk);
    }

    EXPECT_EQ(inner, Status::kPreconditionNotMet);
    EXPECT_FALSE(is_committed);
    EXPECT_EQ(sut->get()[0], 0.0);
    EXPECT_TRUE(sut->commit());
    EXPECT_EQ(sut->get(), one);
}

TEST(InterruptLimitsParameterTest, ACommitThatARequestOvertakesLeavesTheValueToTheNextOne) {
    verifies("SWR-PAR-005", Technique::kFaultInjection, Polarity::kViolation);
    Paged sut{kNoOwner, "large", LargeValue{}};
    LargeValue one{};
    LargeValue two{};
    one.fill(1.0);
    two.fill(2.0);
    ASSERT_EQ(sut->request(one), Status::kOk);
    std::atomic<bool> may_begin{false};
    std::atomic<bool> is_in_the_middle{false};
    std::atomic<bool> may_end{false};
    const auto wait_for = [](const std::atomic<bool>& flag) {
        while (!flag.load()) {
            std::this_thread::yield();
        }
    };
    Status overtaking = Status::kError;
    std::thread requester{[&] {
        wait_for(may_begin);
        overtaking = sut->request(two);
    }};
    bool is_committed = true;
    {
        const FaultHandler handler{[&](const void* address) {
            if (sut.has(address, kSlotPage, 1U)) {  // the commit has seen that a request waits
                sut.protect(kSlotPage, 1U, PROT_READ | PROT_WRITE);
                may_begin = true;
                wait_for(is_in_the_middle);
            } else {  // the other request is at its value
                is_in_the_middle = true;
                wait_for(may_end);
                sut.protect(kRequestedPage, 1U, PROT_READ | PROT_WRITE);
            }
        }};
        sut.protect(kSlotPage, 1U, PROT_READ);
        sut.protect(kRequestedPage, 1U, PROT_READ);
        is_committed = sut->commit();
        may_end = true;
        requester.join();
    }

    EXPECT_FALSE(is_committed);
    EXPECT_EQ(sut->get()[0], 0.0);
    EXPECT_EQ(overtaking, Status::kOk);
    EXPECT_TRUE(sut->commit());
    EXPECT_EQ(sut->get(), two);
}

}  // namespace
}  // namespace mamori
