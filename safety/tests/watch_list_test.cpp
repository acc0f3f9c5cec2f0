// SPDX-License-Identifier: Apache-2.0
// Goal: a supervisor of a table identifies components by themselves, and a list of limits is applied as a
// whole. Method: two components of one type in a table, a third outside it.
#include "mamori/safety/supervision/execution_supervisor.hpp"

#include <gtest/gtest.h>

#include <array>

#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using namespace verification;
using literals::operator""_us;
using literals::operator""_ms;

// Declared before the table, so that a component of it can refer to the supervisor.
extern ExecutionSupervisor g_supervision;

class Part final : public Component {
  public:
    constexpr explicit Part(const char* name) noexcept : Component(name) {}
};
class Decider final : public Component {
  public:
    constexpr explicit Decider(ExecutionSupervisor& supervision) noexcept
        : Component("decider"), supervision_(supervision) {}
    Status on_execute(ContextHandle context) noexcept override {
        static_cast<void>(supervision_.step(context.now));
        return Status::kOk;
    }

  private:
    ExecutionSupervisor& supervision_;
};
Part g_first{"first"};
Part g_second{"second"};
Part g_stranger{"stranger"};
Decider g_decider{g_supervision};

constexpr auto kSystem =
    system(frame(1_ms), window("all", 0_us, 1_ms, budget(1_ms), run(g_first, g_second, g_decider)));
MAMORI_CHECK(kSystem);
ExecutionStorageFor<kSystem> g_storage;
ExecutionSupervisor g_supervision{g_storage, 10_us};

constexpr ComponentLimits kSilentAfterOne{{1U, 1U}, {0_us, 40_us}};
constexpr std::array kLimits = {watch(g_second, kSilentAfterOne), watch(g_first, {{2U, 3U}, {0_us, 40_us}})};

class WatchListTest : public ::testing::Test {
  protected:
    ExecutionStorageFor<kSystem> storage_{};
    ExecutionSupervisor sut_{storage_, 10_us};
};

TEST_F(WatchListTest, AComponentOfTheTableStepsItsSupervisor) {
    verifies("SWR-SUP-040");
    static_cast<void>(g_supervision.watch(g_second, kSilentAfterOne));  // once, also in repeated tests

    ASSERT_EQ(g_decider.on_execute({0, Instant{1000}}), Status::kOk);
    EXPECT_EQ(g_supervision.get_local_status(g_second), LocalStatus::kExpired);
}

TEST_F(WatchListTest, EachRowIsAppliedToItsComponent) {
    verifies("SWR-SUP-040");
    ASSERT_EQ(sut_.watch(kLimits), Status::kOk);

    EXPECT_EQ(sut_.step(Instant{1000}), GlobalStatus::kExpired);
    EXPECT_EQ(sut_.get_local_status(g_first), LocalStatus::kOk);
    EXPECT_EQ(sut_.get_local_status(g_second), LocalStatus::kExpired);
    EXPECT_EQ(sut_.get_cause(g_second), ExpiryCause::kSilent);
    EXPECT_EQ(sut_.get_first_expired(), index_of(kSystem, g_second));
    EXPECT_EQ(sut_.watch(kLimits), Status::kPreconditionNotMet) << "watched already";
}

TEST_F(WatchListTest, AComponentIsWatchedPausedAndAcknowledgedByItself) {
    verifies("SWR-SUP-040", Technique::kStateTransition);
    EXPECT_EQ(sut_.find(g_decider), 2U);
    EXPECT_EQ(sut_.watch(g_first, kSilentAfterOne), Status::kOk);
    EXPECT_EQ(sut_.deactivate(g_first), Status::kOk);
    EXPECT_EQ(sut_.step(Instant{1}), GlobalStatus::kFailed) << "nothing is active";
    EXPECT_EQ(sut_.activate(g_first), Status::kOk);
    EXPECT_EQ(sut_.step(Instant{2}), GlobalStatus::kExpired);
    EXPECT_EQ(sut_.acknowledge(g_first), Status::kOk);
    EXPECT_EQ(sut_.get_local_status(g_first), LocalStatus::kOk);
}

TEST_F(WatchListTest, AComponentOfNoTableIsRejected) {
    verifies("SWR-SUP-040", Technique::kInterface, Polarity::kViolation);
    ExecutionStorage<1U> plain{};
    ExecutionSupervisor without_table{plain, 10_us};

    EXPECT_EQ(sut_.find(g_stranger), kNoIndex);
    EXPECT_EQ(without_table.find(g_first), kNoIndex);
    EXPECT_EQ(without_table.watch(g_first, kSilentAfterOne), Status::kBadParameter);
    EXPECT_EQ(sut_.watch(g_stranger, kSilentAfterOne), Status::kBadParameter);
    EXPECT_EQ(sut_.deactivate(g_stranger), Status::kBadParameter);
    EXPECT_EQ(sut_.activate(g_stranger), Status::kBadParameter);
    EXPECT_EQ(sut_.acknowledge(g_stranger), Status::kBadParameter);
    EXPECT_CHECK_FAILS(static_cast<void>(sut_.get_local_status(g_stranger)), "span.hpp", 1);
    EXPECT_CHECK_FAILS(static_cast<void>(sut_.get_cause(g_stranger)), "span.hpp", 1);
}

TEST_F(WatchListTest, AListEndsAtTheFirstRejectedRow) {
    verifies("SWR-SUP-040", Technique::kErrorGuessing, Polarity::kViolation);
    const std::array<WatchRow, 3U> rows{{watch(g_first, kSilentAfterOne), watch(g_stranger, kSilentAfterOne),
                                         watch(g_second, kSilentAfterOne)}};

    EXPECT_EQ(sut_.watch(rows), Status::kBadParameter);
    EXPECT_EQ(sut_.watch(g_first, kSilentAfterOne), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.watch(g_second, kSilentAfterOne), Status::kOk);
    EXPECT_EQ(sut_.watch(Span<const WatchRow>{}), Status::kOk);
}

}  // namespace
}  // namespace mamori::safety
