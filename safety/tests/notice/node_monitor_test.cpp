// SPDX-License-Identifier: Apache-2.0
// Goal: the monitor uses intact notices of its node only, and names what is wrong with the others. Method:
// the sending end by hand, one change to the message or its order at a time.
#include "mamori/safety/notice/node_monitor.hpp"

#include <array>
#include <cstdint>

#include "mamori/safety/e2e/out_port.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using namespace verification;
using literals::operator""_ms;

using Names = std::array<const char*, 2U>;
constexpr NoticeNode kArm{0x1234U, 1_ms, 10U, Names{"reader", "guard"}};
constexpr NoticeNode kBase{0x1235U, 1_ms, 10U, Names{"reader", "guard"}};
constexpr NoticeNode kNewArm{0x1234U, 1_ms, 10U, Names{"reader", "warden"}};
constexpr NoticeNode kLongArm{0x1234U, 1_ms, 10U, std::array<const char*, 3U>{"reader", "guard", "planner"}};
// Late after 22 ms, silent after 32 ms, start within 52 ms.
constexpr NoticeLimits kLimits{2_ms, 2U, 3U, 5U};

/// The sending end of a node.
template <const auto& kNode>
struct Sender {
    using Notice = NoticeFor<kNode>;
    OutPort<typename Notice::Frame> out{kNoOwner, "notice"};
    E2eOutPort<typename Notice::Message> port{out};
    typename Notice::Value value{};

    Sender() {
        value.version = calc_version(kNode);
        value.components.fill(to_byte({LifecycleState::kActive, LocalStatus::kOk}));
    }
    typename Notice::Frame make() {
        ++value.frame;
        EXPECT_EQ(port.write(value), Status::kOk);
        static_cast<void>(out.publish(Instant{}));
        return out.get_published();
    }
};

class NodeMonitorTest : public ::testing::Test {
  protected:
    using Frame = NoticeFor<kArm>::Frame;

    NodeMonitorTest() { EXPECT_EQ(sut_.on_activated({0, now_}), Status::kOk); }

    void run(Duration elapsed = 10_ms) {
        now_ = now_ + elapsed;
        EXPECT_EQ(sut_.on_execute({0, now_}), Status::kOk);
        sut_.notice.mark_read();
        static_cast<void>(sut_.status.publish(now_));
    }
    template <typename AnyFrame>
    void receive(const AnyFrame& frame) {
        Frame copy;
        ASSERT_EQ(copy.resize(frame.size()), Status::kOk);
        for (std::size_t i = 0U; i < frame.size(); ++i) {
            copy[i] = frame[i];
        }
        ++revision_;
        sut_.notice.take({copy, revision_, now_ + 10_ms});
        run();
    }
    void prove() {
        receive(arm_.make());
        receive(arm_.make());
        EXPECT_FALSE(sut_.get_status().is_proven) << "two notices find the order";
        receive(arm_.make());
        ASSERT_TRUE(sut_.get_status().is_proven);
        ASSERT_EQ(sut_.get_status().faults, 0U);
    }
    bool has(NoticeFault fault) const { return has_fault(sut_.get_status(), fault); }
    /// True when this fault is the only one, and the node is no longer proven.
    bool has_only(NoticeFault fault) const {
        return sut_.get_status().faults == 1U << static_cast<std::uint32_t>(fault) &&
               sut_.get_status().first == fault && !sut_.get_status().is_proven;
    }

    Sender<kArm> arm_{};
    NodeMonitor<kArm, kLimits> sut_{"arm"};
    Instant now_{1'000'000};
    std::uint64_t revision_{0U};
};

TEST_F(NodeMonitorTest, IntactNoticesInOrderProveTheNodeAndGiveItsState) {
    verifies("SWR-NTC-010");
    EXPECT_EQ(sut_.get_report(0U).state, LifecycleState::kCreated);
    EXPECT_EQ(sut_.get_report(0U).status, LocalStatus::kExpired);
    prove();
    arm_.value.components[1] = to_byte({LifecycleState::kInactive, LocalStatus::kFailed});
    arm_.value.health = 1U;
    receive(arm_.make());

    EXPECT_TRUE(sut_.get_status().is_proven);
    EXPECT_EQ(sut_.get_report(0U).state, LifecycleState::kActive);
    EXPECT_EQ(sut_.get_report(0U).status, LocalStatus::kOk);
    EXPECT_EQ(sut_.get_report(1U).state, LifecycleState::kInactive);
    EXPECT_EQ(sut_.get_report(1U).status, LocalStatus::kFailed);
    EXPECT_EQ(sut_.get_value().frame, 4U);
    EXPECT_EQ(sut_.get_value().health, 1U);
    EXPECT_TRUE(sut_.status.get_published().is_proven) << "for other components";
    EXPECT_CHECK_FAILS(static_cast<void>(sut_.get_report(2U)), "node_monitor.hpp", 1);
}

TEST_F(NodeMonitorTest, LostOrCorruptedNoticesWithinTheToleranceAreNoFault) {
    verifies("SWR-NTC-005");
    prove();
    for (int i = 0; i < 20; ++i) {
        Frame corrupted = arm_.make();
        corrupted[30U] = static_cast<std::uint8_t>(corrupted[30U] ^ 4U);
        receive(corrupted);
        ASSERT_EQ(sut_.get_status().faults, 0U);
        ASSERT_TRUE(sut_.get_status().is_proven);
        receive(arm_.make());
    }
    EXPECT_EQ(sut_.get_checker().get_count(FrameCause::kChecksum), 20U);
}

TEST_F(NodeMonitorTest, CorruptedNoticesDoNotCountAsASignOfLife) {
    verifies("SWR-NTC-005", Technique::kFaultInjection, Polarity::kViolation);
    prove();
    for (int i = 0; i < 3; ++i) {
        Frame corrupted = arm_.make();
        corrupted[0U] = static_cast<std::uint8_t>(corrupted[0U] ^ 1U);
        receive(corrupted);
    }
    EXPECT_TRUE(has_only(NoticeFault::kLate));
    run();
    EXPECT_TRUE(has(NoticeFault::kSilent));
    EXPECT_EQ(sut_.status.get_published().first, NoticeFault::kLate);
}

TEST_F(NodeMonitorTest, RepeatedNoticeIsOutOfOrder) {
    verifies("SWR-NTC-005", Technique::kFaultInjection, Polarity::kViolation);
    prove();
    receive(arm_.out.get_published());

    EXPECT_TRUE(has_only(NoticeFault::kOutOfOrder));
}

TEST_F(NodeMonitorTest, OlderNoticeIsOutOfOrder) {
    verifies("SWR-NTC-005", Technique::kFaultInjection, Polarity::kViolation);
    prove();
    const Frame older = arm_.make();
    receive(arm_.make());
    ASSERT_EQ(sut_.get_status().faults, 0U);
    receive(older);

    EXPECT_TRUE(has_only(NoticeFault::kOutOfOrder));
}

TEST_F(NodeMonitorTest, GapUpToTheSilentTimeIsNoFaultAndALargerOneIs) {
    verifies("SWR-NTC-005", Technique::kBoundaryValues, Polarity::kViolation);
    for (const int lost : {2, 3}) {
        NodeMonitorTest::sut_.acknowledge(now_);
        prove();
        for (int i = 0; i < lost; ++i) {
            static_cast<void>(arm_.make());
        }
        receive(arm_.make());
        EXPECT_EQ(has(NoticeFault::kOutOfOrder), lost == 3);
    }
}

TEST_F(NodeMonitorTest, NoticesBeforeTheOrderIsFoundAreNoFault) {
    verifies("SWR-NTC-005", Technique::kStateTransition);
    receive(arm_.make());
    receive(arm_.out.get_published());
    static_cast<void>(arm_.make());
    receive(arm_.make());

    EXPECT_EQ(sut_.get_status().faults, 0U);
    EXPECT_FALSE(sut_.get_status().is_proven);
}

TEST_F(NodeMonitorTest, ChannelThatRepeatsOneNoticeFromTheStartIsSilent) {
    verifies("SWR-NTC-004", Technique::kFaultInjection, Polarity::kViolation);
    const Frame stuck = arm_.make();
    for (int i = 0; i < 5; ++i) {
        receive(stuck);
        EXPECT_EQ(sut_.get_status().faults, 0U);
    }
    receive(stuck);

    EXPECT_TRUE(has_only(NoticeFault::kSilent));
}

TEST_F(NodeMonitorTest, NoticesOfTheNodeAreNoFaultAmongThoseOfOtherNodesElsewhere) {
    verifies("SWR-NTC-008");
    Sender<kBase> base;  // sends to another monitor
    for (int i = 0; i < 5; ++i) {
        static_cast<void>(base.make());
        receive(arm_.make());
    }

    EXPECT_FALSE(has(NoticeFault::kWrongNode));
    EXPECT_TRUE(sut_.get_status().is_proven);
}

TEST_F(NodeMonitorTest, NoticeOfTheSameTableGivesItsReports) {
    verifies("SWR-NTC-007");
    prove();
    arm_.value.components[0] = to_byte({LifecycleState::kInactive, LocalStatus::kOk});
    receive(arm_.make());

    EXPECT_FALSE(has(NoticeFault::kOtherTable));
    EXPECT_EQ(sut_.get_report(0U).state, LifecycleState::kInactive);
}

TEST_F(NodeMonitorTest, NoticeOfAnotherNodeIsNamedAndNotUsed) {
    verifies("SWR-NTC-008", Technique::kFaultInjection, Polarity::kViolation);
    prove();
    Sender<kBase> base;
    base.value.components.fill(0U);
    receive(base.make());

    EXPECT_TRUE(has_only(NoticeFault::kWrongNode));
    EXPECT_EQ(sut_.get_report(0U).state, LifecycleState::kActive);
}

TEST_F(NodeMonitorTest, NoticeOfAnotherTableIsNamedAndItsReportsAreNotUsed) {
    verifies("SWR-NTC-007", Technique::kFaultInjection, Polarity::kViolation);
    prove();
    arm_.value.version = calc_version(kNewArm);
    arm_.value.components.fill(to_byte({LifecycleState::kError, LocalStatus::kOk}));
    receive(arm_.make());

    EXPECT_TRUE(has_only(NoticeFault::kOtherTable)) << "which component failed is unknown";
    EXPECT_EQ(sut_.get_report(0U).state, LifecycleState::kCreated);
    EXPECT_EQ(sut_.get_report(0U).status, LocalStatus::kExpired);
}

TEST_F(NodeMonitorTest, NoticeOfAnotherLengthIsRejected) {
    verifies("SWR-NTC-007", Technique::kFaultInjection, Polarity::kViolation);
    static_assert(NoticeFor<kLongArm>::kLength == NoticeFor<kArm>::kLength + 1U);
    prove();
    Frame truncated = arm_.make();
    ASSERT_EQ(truncated.resize(truncated.size() - 1U), Status::kOk);
    receive(truncated);

    EXPECT_EQ(sut_.get_checker().get_cause(), FrameCause::kTooShort);
    EXPECT_EQ(sut_.get_value().frame, 3U);
}

TEST_F(NodeMonitorTest, FailedComponentIsNamedThroughTheMonitor) {
    verifies("SWR-NTC-006", Technique::kFaultInjection, Polarity::kViolation);
    prove();
    arm_.value.components[1] = to_byte({LifecycleState::kError, LocalStatus::kOk});
    receive(arm_.make());

    EXPECT_TRUE(has_only(NoticeFault::kComponentError));
    EXPECT_EQ(sut_.get_status().component, 1U);
}

TEST_F(NodeMonitorTest, NoticeIsReadOnceAlsoAfterAnAbortedCycle) {
    verifies("SWR-NTC-005", Technique::kErrorGuessing);
    prove();
    ++revision_;
    sut_.notice.take({arm_.make(), revision_, now_});
    EXPECT_EQ(sut_.on_execute({0, now_}), Status::kOk);
    EXPECT_EQ(sut_.on_execute({0, now_}), Status::kOk) << "the input is still new";

    EXPECT_EQ(sut_.get_status().faults, 0U);
}

TEST_F(NodeMonitorTest, RestartedSenderIsAcceptedAfterADeliberateResetOnly) {
    verifies("SWR-NTC-009", Technique::kStateTransition, Polarity::kViolation);
    prove();
    Sender<kArm> restarted;
    for (int i = 0; i < 5; ++i) {
        receive(restarted.make());
        EXPECT_TRUE(has(NoticeFault::kOutOfOrder));
        EXPECT_FALSE(sut_.get_status().is_proven);
    }

    sut_.acknowledge(now_);
    EXPECT_EQ(sut_.get_status().faults, 0U);
    receive(restarted.make());
    receive(restarted.make());
    EXPECT_FALSE(sut_.get_status().is_proven);
    receive(restarted.make());
    EXPECT_TRUE(sut_.get_status().is_proven);
}

TEST_F(NodeMonitorTest, ActivationStartsAgainAndKeepsFaults) {
    verifies("SWR-NTC-009", Technique::kStateTransition);
    prove();
    for (int i = 0; i < 100; ++i) {
        static_cast<void>(arm_.make());  // while the monitor is inactive
    }
    now_ = now_ + 1000_ms;
    ASSERT_EQ(sut_.on_activated({0, now_}), Status::kOk);
    receive(arm_.make());
    receive(arm_.make());
    EXPECT_FALSE(sut_.get_status().is_proven);
    receive(arm_.make());
    EXPECT_TRUE(sut_.get_status().is_proven);

    receive(arm_.out.get_published());
    ASSERT_EQ(sut_.on_activated({0, now_}), Status::kOk);
    EXPECT_TRUE(has(NoticeFault::kOutOfOrder));
}

TEST_F(NodeMonitorTest, NoticeAtTheInstantOfAnEarlierRunIsSeen) {
    verifies("SWR-NTC-005", Technique::kErrorGuessing);
    const Instant first = now_;
    prove();
    now_ = first;  // the time line of the new run starts again
    ASSERT_EQ(sut_.on_activated({0, now_}), Status::kOk);
    for (int i = 0; i < 3; ++i) {
        receive(arm_.make());
    }

    EXPECT_TRUE(sut_.get_status().is_proven);
}

}  // namespace
}  // namespace mamori::safety
