// SPDX-License-Identifier: Apache-2.0
// Goal: events come out in the order in which they went in, none is lost or torn, and a full queue says so.
// Method: each size on both sides of its limit, the wrap of the cells, and two senders against one reader.
#include "mamori/kernel/component/detail/fsm_event_queue.hpp"

#include <gtest/gtest.h>

#include <array>
#include <thread>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori {
namespace {

using namespace verification;

class FsmEventQueueTest : public ::testing::Test {
  protected:
    std::array<FsmEventCell, 4> cells_;
    FsmEventQueue sut_{cells_};
};

TEST_F(FsmEventQueueTest, FirstInIsFirstOutAcrossManyWraps) {
    verifies("SWR-RTC-009", Technique::kBoundaryValues);

    for (std::int64_t round = 0; round < 100; ++round) {
        for (FsmIndex message = 0U; message < 3U; ++message) {
            EXPECT_EQ(sut_.post({message, round}), Status::kOk);
        }
        EXPECT_EQ(sut_.get_size(), 3U);
        for (FsmIndex message = 0U; message < 3U; ++message) {
            const Result<FsmEvent> event = sut_.take();
            EXPECT_EQ(event.get_value().message, message);
            EXPECT_EQ(event.get_value().argument, round);
        }
        EXPECT_EQ(sut_.take().get_status(), Status::kPreconditionNotMet);
    }
    EXPECT_EQ(sut_.get_high_water_mark(), 3U);
    EXPECT_EQ(sut_.get_refused_count(), 0U);
    EXPECT_EQ(sut_.get_capacity(), 4U);
}

TEST_F(FsmEventQueueTest, TheHighWaterMarkCountsWhatWaitsAndNeverFalls) {
    verifies("SWR-RTC-009", Technique::kBoundaryValues);

    for (std::int64_t i = 0; i < 10; ++i) {
        ASSERT_EQ(sut_.post({0U, i}), Status::kOk);
        ASSERT_TRUE(sut_.take().has_value());
    }
    EXPECT_EQ(sut_.get_high_water_mark(), 1U) << "never more than one at a time";
    for (std::int64_t i = 0; i < 3; ++i) {
        ASSERT_EQ(sut_.post({0U, i}), Status::kOk);
        EXPECT_EQ(sut_.get_high_water_mark(), static_cast<std::size_t>(i + 1));
    }
    sut_.clear();
    ASSERT_EQ(sut_.post({0U, 0}), Status::kOk);
    EXPECT_EQ(sut_.get_high_water_mark(), 3U);
}

TEST_F(FsmEventQueueTest, AFullQueueRefusesCountsAndKeepsWhatItHas) {
    verifies("SWR-RTC-009", Technique::kBoundaryValues, Polarity::kViolation);
    for (std::int64_t i = 0; i < 4; ++i) {
        ASSERT_EQ(sut_.post({0U, i}), Status::kOk);
    }

    EXPECT_EQ(sut_.post({0U, 4}), Status::kOutOfResources);
    EXPECT_EQ(sut_.post({0U, 5}), Status::kOutOfResources);
    EXPECT_EQ(sut_.get_refused_count(), 2U);
    EXPECT_EQ(sut_.get_high_water_mark(), 4U);

    EXPECT_EQ(sut_.take().get_value().argument, 0);
    EXPECT_EQ(sut_.post({0U, 6}), Status::kOk);
    EXPECT_EQ(sut_.take().get_value().argument, 1);
}

TEST_F(FsmEventQueueTest, TwoCellsAreEnoughForAQueue) {
    verifies("SWR-RTC-009", Technique::kBoundaryValues);
    std::array<FsmEventCell, 2> cells;
    FsmEventQueue queue{cells};

    for (std::int64_t i = 0; i < 10; ++i) {
        EXPECT_EQ(queue.post({1U, i}), Status::kOk);
        EXPECT_EQ(queue.post({1U, -i}), Status::kOk);
        EXPECT_EQ(queue.post({1U, i}), Status::kOutOfResources);
        EXPECT_EQ(queue.take().get_value().argument, i);
        EXPECT_EQ(queue.take().get_value().argument, -i);
    }
}

TEST_F(FsmEventQueueTest, ClearDropsWhatWaits) {
    verifies("SWR-RTC-009", Technique::kStateTransition);
    ASSERT_EQ(sut_.post({0U, 1}), Status::kOk);
    ASSERT_EQ(sut_.post({0U, 2}), Status::kOk);

    sut_.clear();

    EXPECT_EQ(sut_.get_size(), 0U);
    EXPECT_FALSE(sut_.take().has_value());
    EXPECT_EQ(sut_.post({0U, 3}), Status::kOk);
    EXPECT_EQ(sut_.take().get_value().argument, 3);
}

TEST_F(FsmEventQueueTest, CellsThatAreNoPowerOfTwoEndInTheAssertion) {
    verifies("SWR-RTC-009", Technique::kBoundaryValues, Polarity::kViolation);
    std::array<FsmEventCell, 3> three;
    FsmEventQueue odd{three};
    FsmEventQueue single{Span<FsmEventCell>{cells_}.subspan(0U, 1U)};
    FsmEventQueue none{Span<FsmEventCell>{}};

    EXPECT_CHECK_FAILS(static_cast<void>(odd.post({})), "fsm_event_queue.cpp", 1);
    EXPECT_CHECK_FAILS(static_cast<void>(single.post({})), "fsm_event_queue.cpp", 1);
    EXPECT_CHECK_FAILS(static_cast<void>(none.take()), "fsm_event_queue.cpp", 1);
}

TEST_F(FsmEventQueueTest, TwoSendersLoseAndTearNothing) {
    verifies("SWR-RTC-009", Technique::kErrorGuessing);
    constexpr std::int64_t kEvents = 20000;
    const auto send = [this](FsmIndex sender) {
        for (std::int64_t i = 0; i < kEvents; ++i) {
            while (sut_.post({sender, i}) != Status::kOk) {
                std::this_thread::yield();
            }
        }
    };
    std::thread first{send, FsmIndex{0U}};
    std::thread second{send, FsmIndex{1U}};
    std::array<std::int64_t, 2> next{};

    while (next[0] + next[1] < 2 * kEvents) {
        const Result<FsmEvent> event = sut_.take();
        if (!event.has_value()) {
            std::this_thread::yield();
            continue;
        }
        std::int64_t& expected = next[event.get_value().message];
        ASSERT_EQ(event.get_value().argument, expected);
        ++expected;
    }
    first.join();
    second.join();

    EXPECT_EQ(sut_.get_size(), 0U);
    EXPECT_LE(sut_.get_high_water_mark(), 4U);
}

}  // namespace
}  // namespace mamori
