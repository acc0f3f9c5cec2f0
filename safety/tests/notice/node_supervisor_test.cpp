// SPDX-License-Identifier: Apache-2.0
// Goal: missing notices and reports of components become latched faults in time, and nothing else does.
// Method: both sides of each time, each fault alone, worst first, acknowledgement.
#include "mamori/safety/notice/node_monitor.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

// Start within 510, late after 210, silent after 310.
constexpr Duration kPeriod{100};
constexpr NoticeLimits kLimits{Duration{10}, 2U, 3U, 5U};

constexpr std::uint8_t kOk = to_byte({LifecycleState::kActive, LocalStatus::kOk});

class NodeSupervisorTest : public ::testing::Test {
  protected:
    NodeSupervisorTest() { sut_.start(Instant{1000}); }

    void arrive(std::int64_t now) {
        sut_.record_arrival(Instant{now});
        sut_.evaluate(all_ok_);
    }
    bool has(NoticeFault fault) const { return has_fault(sut_.get_status(), fault); }
    std::uint32_t get_faults() const { return sut_.get_status().faults; }

    std::array<std::uint8_t, 3U> all_ok_{kOk, kOk, kOk};
    NodeSupervisor sut_{kPeriod, kLimits};
};

TEST_F(NodeSupervisorTest, NothingIsProvenBeforeTheFirstNotice) {
    verifies("SWR-NTC-010", Technique::kStateTransition, Polarity::kViolation);
    sut_.step(Instant{1000});
    EXPECT_FALSE(sut_.get_status().is_proven);
    EXPECT_EQ(get_faults(), 0U);

    arrive(1300);
    sut_.step(Instant{1300});
    EXPECT_TRUE(sut_.get_status().is_proven);
    sut_.start(Instant{1300});
    EXPECT_FALSE(sut_.get_status().is_proven);
}

TEST_F(NodeSupervisorTest, NodeThatNeverSendsIsSilentAfterItsStartTime) {
    verifies("SWR-NTC-004", Technique::kBoundaryValues, Polarity::kViolation);
    sut_.step(Instant{1510});
    EXPECT_EQ(get_faults(), 0U);

    sut_.step(Instant{1511});
    EXPECT_TRUE(has(NoticeFault::kSilent));
    EXPECT_FALSE(has(NoticeFault::kLate));
    EXPECT_EQ(sut_.get_status().first, NoticeFault::kSilent);
}

TEST_F(NodeSupervisorTest, NoticesWithinTheLateTimeAreNoFault) {
    verifies("SWR-NTC-004", Technique::kBoundaryValues);
    for (std::int64_t now = 1210; now < 10000; now += 210) {
        arrive(now);
        sut_.step(Instant{now + 209});
        ASSERT_EQ(get_faults(), 0U);
        ASSERT_TRUE(sut_.get_status().is_proven);
    }
}

TEST_F(NodeSupervisorTest, MissingNoticeIsLateThenSilent) {
    verifies("SWR-NTC-004", Technique::kBoundaryValues, Polarity::kViolation);
    arrive(1100);
    sut_.step(Instant{1310});
    EXPECT_EQ(get_faults(), 0U);

    sut_.step(Instant{1311});
    EXPECT_TRUE(has(NoticeFault::kLate));
    EXPECT_FALSE(sut_.get_status().is_proven);
    sut_.step(Instant{1410});
    EXPECT_FALSE(has(NoticeFault::kSilent));
    sut_.step(Instant{1411});
    EXPECT_TRUE(has(NoticeFault::kSilent));
    EXPECT_EQ(sut_.get_status().first, NoticeFault::kLate) << "the first one is kept";
    EXPECT_EQ(sut_.get_status().component, kNoNoticeComponent);
}

TEST_F(NodeSupervisorTest, NoticeThatArrivesTooLateDoesNotHideIt) {
    verifies("SWR-NTC-004", Technique::kFaultInjection, Polarity::kViolation);
    arrive(1100);
    arrive(1311);
    EXPECT_TRUE(has(NoticeFault::kLate));

    arrive(1400);
    sut_.step(Instant{1400});
    EXPECT_TRUE(has(NoticeFault::kLate)) << "latched";
    EXPECT_FALSE(sut_.get_status().is_proven);
}

TEST_F(NodeSupervisorTest, ClockThatRunsBackwardsIsSilence) {
    verifies("SWR-NTC-004", Technique::kFaultInjection, Polarity::kViolation);
    arrive(1100);

    sut_.step(Instant{1099});
    EXPECT_TRUE(has(NoticeFault::kSilent));
}

struct Case {
    LifecycleState state;
    LocalStatus status;
    NoticeFault fault;
};

TEST_F(NodeSupervisorTest, EachStateAndStatusOfEachComponentHasItsFault) {
    verifies("SWR-NTC-006", Technique::kEquivalenceClasses, Polarity::kViolation);
    for (const Case& one : {
             Case{LifecycleState::kCreated, LocalStatus::kOk, NoticeFault::kComponentMissing},
             Case{LifecycleState::kCreated, LocalStatus::kExpired, NoticeFault::kComponentMissing},
             Case{LifecycleState::kError, LocalStatus::kOk, NoticeFault::kComponentError},
             Case{LifecycleState::kError, LocalStatus::kExpired, NoticeFault::kComponentError},
             Case{LifecycleState::kActive, LocalStatus::kExpired, NoticeFault::kComponentExpired},
             Case{LifecycleState::kInactive, LocalStatus::kExpired, NoticeFault::kComponentExpired},
             Case{LifecycleState::kActive, LocalStatus::kFailed, NoticeFault::kNone},
             Case{LifecycleState::kInactive, LocalStatus::kFailed, NoticeFault::kNone},
             Case{LifecycleState::kActive, LocalStatus::kOk, NoticeFault::kNone},
             Case{LifecycleState::kInactive, LocalStatus::kOk, NoticeFault::kNone},
         }) {
        for (std::uint16_t component = 0U; component < 3U; ++component) {
            std::array<std::uint8_t, 3U> bytes = all_ok_;
            bytes[component] = to_byte({one.state, one.status});
            NodeSupervisor sut{kPeriod, kLimits};
            sut.start(Instant{0});
            sut.record_arrival(Instant{100});
            sut.evaluate(bytes);
            sut.step(Instant{100});
            EXPECT_EQ(sut.get_status().first, one.fault);
            EXPECT_EQ(sut.get_status().component,
                      one.fault == NoticeFault::kNone ? kNoNoticeComponent : component);
            EXPECT_EQ(sut.get_status().is_proven, one.fault == NoticeFault::kNone);
        }
    }
}

TEST_F(NodeSupervisorTest, FaultOfAComponentStaysAndNamesTheFirst) {
    verifies("SWR-NTC-006", Technique::kStateTransition, Polarity::kViolation);
    std::array<std::uint8_t, 3U> bytes = all_ok_;
    bytes[1] = to_byte({LifecycleState::kError, LocalStatus::kOk});
    bytes[2] = to_byte({LifecycleState::kCreated, LocalStatus::kOk});
    sut_.record_arrival(Instant{1100});
    sut_.evaluate(bytes);
    arrive(1200);
    sut_.step(Instant{1200});

    EXPECT_TRUE(has(NoticeFault::kComponentError));
    EXPECT_TRUE(has(NoticeFault::kComponentMissing));
    EXPECT_EQ(sut_.get_status().first, NoticeFault::kComponentError);
    EXPECT_EQ(sut_.get_status().component, 1U);
    EXPECT_FALSE(sut_.get_status().is_proven);
}

TEST_F(NodeSupervisorTest, FaultWithoutAComponentDoesNotHideTheComponentOfALaterOne) {
    verifies("SWR-NTC-006", Technique::kStateTransition);
    sut_.report(NoticeFault::kOutOfOrder);
    sut_.report(NoticeFault::kComponentExpired, 2U);

    EXPECT_EQ(sut_.get_status().first, NoticeFault::kOutOfOrder);
    EXPECT_EQ(sut_.get_status().component, 2U);
}

TEST_F(NodeSupervisorTest, AcknowledgementClearsAndAPresentFaultLatchesAgain) {
    verifies("SWR-NTC-009", Technique::kStateTransition, Polarity::kViolation);
    arrive(1100);
    sut_.step(Instant{2000});
    ASSERT_TRUE(has(NoticeFault::kSilent));

    sut_.acknowledge(Instant{2000});
    EXPECT_EQ(get_faults(), 0U);
    EXPECT_EQ(sut_.get_status().first, NoticeFault::kNone);
    sut_.step(Instant{2510});
    EXPECT_EQ(get_faults(), 0U);
    EXPECT_FALSE(sut_.get_status().is_proven);
    sut_.step(Instant{2511});
    EXPECT_TRUE(has(NoticeFault::kSilent));
}

TEST_F(NodeSupervisorTest, RestartKeepsTheFaults) {
    verifies("SWR-NTC-009", Technique::kStateTransition, Polarity::kViolation);
    sut_.report(NoticeFault::kWrongNode);
    sut_.start(Instant{5000});
    arrive(5100);
    sut_.step(Instant{5100});

    EXPECT_TRUE(has(NoticeFault::kWrongNode));
    EXPECT_FALSE(sut_.get_status().is_proven);
}

TEST(NoticeLimitsTest, LimitsOutsideTheirRangeAreInvalid) {
    verifies("SWR-NTC-003", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr std::int64_t kLongest = std::int64_t{1} << 61U;

    EXPECT_TRUE(is_valid({Duration{0}, 1U, 2U}, Duration{1}));
    EXPECT_FALSE(is_valid({Duration{-1}, 1U, 2U}, Duration{1}));
    EXPECT_FALSE(is_valid({Duration{0}, 0U, 2U}, Duration{1}));
    EXPECT_FALSE(is_valid({Duration{0}, 2U, 2U}, Duration{1}));
    EXPECT_FALSE(is_valid({Duration{0}, 1U, 2U}, Duration{0}));
    EXPECT_TRUE(is_valid({Duration{0}, 1U, 2U, 3U}, Duration{1}));
    EXPECT_FALSE(is_valid({Duration{0}, 1U, 2U, 2U}, Duration{1}));
    EXPECT_TRUE(is_valid({Duration{kLongest}, 1U, 2U, 8U}, Duration{kLongest / 8}));
    EXPECT_FALSE(is_valid({Duration{kLongest + 1}, 1U, 2U}, Duration{1}));
    EXPECT_FALSE(is_valid({Duration{0}, 1U, 2U, 8U}, Duration{kLongest / 8 + 1}));
    EXPECT_FALSE(is_valid({Duration{0}, 1U, 16U, 8U}, Duration{kLongest / 8}));
    EXPECT_TRUE(is_valid({Duration{0}, 1U, 8U, 8U}, Duration{kLongest / 8}));
    EXPECT_CHECK_FAILS((NodeSupervisor{kPeriod, NoticeLimits{Duration{0}, 2U, 2U}}), "node_monitor.hpp", 2);
}

TEST(NoticeLimitsTest, UnstatedLimitsAreThreePeriodsOfSilenceAndTenOfStart) {
    verifies("SWR-NTC-004", Technique::kInterface);
    constexpr NoticeLimits kUnstated{};
    EXPECT_EQ(kUnstated.tolerance, Duration{0});
    EXPECT_EQ(kUnstated.late_periods, 2U);
    EXPECT_EQ(kUnstated.silent_periods, 3U);
    EXPECT_EQ(kUnstated.start_periods, 10U);
    EXPECT_EQ(NodeStatus{}.component, 0xFFFFU);
    EXPECT_FALSE(NodeStatus{}.is_proven);
}

TEST(NoticeFaultTest, EachFaultHasANameAndABitOfItsOwn) {
    verifies("SWR-NTC-006", Technique::kInterface);
    constexpr std::array kNames{
        "None",       "Silent",           "Late",           "OutOfOrder",      "WrongNode",
        "OtherTable", "ComponentMissing", "ComponentError", "ComponentExpired"};
    static_assert(kNames.size() == kNoticeFaultMax + 1U);

    for (std::uint32_t number = 0U; number < kNames.size(); ++number) {
        EXPECT_EQ(std::string(get_name(static_cast<NoticeFault>(number))), kNames[number]);
    }
    EXPECT_EQ(std::string(get_name(static_cast<NoticeFault>(99))), "Invalid");
    EXPECT_TRUE(has_fault({1U << 3U, NoticeFault::kNone, 0U, false}, NoticeFault::kOutOfOrder));
    EXPECT_FALSE(has_fault({~(1U << 3U), NoticeFault::kNone, 0U, false}, NoticeFault::kOutOfOrder));
}

TEST(ComponentReportTest, EachReportComesBackAndOtherBytesAreExpired) {
    verifies("SWR-NTC-001", Technique::kEquivalenceClasses);
    for (unsigned value = 0U; value <= 255U; ++value) {
        const ComponentReport report = to_report(static_cast<std::uint8_t>(value));
        EXPECT_EQ(static_cast<unsigned>(report.state), value & 3U);
        EXPECT_EQ(report.status, value < 4U   ? LocalStatus::kOk
                                 : value < 8U ? LocalStatus::kFailed
                                              : LocalStatus::kExpired);
        if (value < 12U) {
            EXPECT_EQ(to_byte(report), value);
        }
    }
}

TEST(NoticeVersionTest, VersionFollowsNamesOrderAndPeriod) {
    verifies("SWR-NTC-007", Technique::kEquivalenceClasses, Polarity::kViolation);
    constexpr NoticeNode kNode{1U, Duration{10}, 2U, std::array<const char*, 2U>{"ab", "c"}};
    constexpr NoticeNode kMoved{1U, Duration{10}, 2U, std::array<const char*, 2U>{"a", "bc"}};
    constexpr NoticeNode kSwapped{1U, Duration{10}, 2U, std::array<const char*, 2U>{"c", "ab"}};
    constexpr NoticeNode kLonger{1U, Duration{10}, 2U, std::array<const char*, 3U>{"ab", "c", "d"}};
    constexpr NoticeNode kRare{1U, Duration{10}, 3U, std::array<const char*, 2U>{"ab", "c"}};
    constexpr NoticeNode kSlow{1U, Duration{11}, 2U, std::array<const char*, 2U>{"ab", "c"}};
    constexpr NoticeNode kOther{2U, Duration{10}, 2U, std::array<const char*, 2U>{"ab", "c"}};

    EXPECT_EQ(calc_version(kNode), calc_version(kOther)) << "the node is named by the data id";
    EXPECT_NE(calc_version(kNode), calc_version(kMoved));
    EXPECT_NE(calc_version(kNode), calc_version(kSwapped));
    EXPECT_NE(calc_version(kNode), calc_version(kLonger));
    EXPECT_NE(calc_version(kNode), calc_version(kRare));
    EXPECT_NE(calc_version(kNode), calc_version(kSlow));
    EXPECT_EQ(get_period(kNode), Duration{20});
}

}  // namespace
}  // namespace mamori::safety
