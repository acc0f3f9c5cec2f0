// SPDX-License-Identifier: Apache-2.0
// Goal: each guard passes values inside its limit, names the joints outside, and never passes a value or
// limit that is not a finite number. Method: both sides of each limit for each joint, special floating-point
// values.
#include "mamori/safety/arm/guards.hpp"

#include <cmath>
#include <limits>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr std::array<double, 3U> kNotFinite{kNan, kInf, -kInf};
constexpr JointVector kZero{};
constexpr JointVector kLimits{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7};
constexpr JointRanges kRanges{
    {{-1.0, 1.0}, {-2.0, 0.5}, {0.25, 0.5}, {-3.0, -1.0}, {-1.0, 1.0}, {-1.0, 1.0}, {-1.0, 1.0}}};
constexpr JointVector kInside{0.0, 0.0, 0.3, -2.0, 0.0, 0.0, 0.0};

static_assert(are_valid(kRanges) && are_valid(kLimits));

double above(double value) {
    return std::nextafter(value, kInf);
}
double below(double value) {
    return std::nextafter(value, -kInf);
}

JointVector with(JointVector values, std::size_t joint, double value) {
    values[joint] = value;
    return values;
}

bool is_only(const JointSet& joints, std::size_t joint) {
    return joints.get_bits() == (1U << joint);
}

using Deviation = JointSet (*)(const JointVector&, const JointVector&, const JointVector&) noexcept;

void expect_passes_up_to_its_limit(Deviation guard) {
    EXPECT_TRUE(guard(kZero, kZero, kLimits).is_empty());
    EXPECT_TRUE(guard(kInside, kInside, kLimits).is_empty()) << "far from zero";
    for (std::size_t joint = 0U; joint < kArmJointCount; ++joint) {
        EXPECT_TRUE(guard(with(kZero, joint, kLimits[joint]), kZero, kLimits).is_empty()) << joint;
        EXPECT_TRUE(guard(kZero, with(kZero, joint, kLimits[joint]), kLimits).is_empty()) << joint;
    }
}

void expect_trips_beyond_its_limit(Deviation guard) {
    for (std::size_t joint = 0U; joint < kArmJointCount; ++joint) {
        const double beyond = above(kLimits[joint]);
        EXPECT_TRUE(is_only(guard(with(kZero, joint, beyond), kZero, kLimits), joint)) << joint;
        EXPECT_TRUE(is_only(guard(with(kZero, joint, beyond), with(kZero, joint, -beyond), kLimits), joint))
            << joint;
        EXPECT_TRUE(is_only(guard(kZero, with(kZero, joint, beyond), kLimits), joint)) << joint;
        for (const double value : kNotFinite) {
            EXPECT_TRUE(is_only(guard(with(kZero, joint, value), kZero, kLimits), joint)) << value;
            EXPECT_TRUE(is_only(guard(kZero, with(kZero, joint, value), kLimits), joint)) << value;
            EXPECT_TRUE(is_only(guard(with(kZero, joint, value), with(kZero, joint, value), kLimits), joint))
                << value;
            EXPECT_TRUE(is_only(guard(kZero, kZero, with(kLimits, joint, value)), joint))
                << "limit " << value;
        }
        EXPECT_TRUE(is_only(guard(kZero, kZero, with(kLimits, joint, -0.1)), joint)) << "negative limit";
    }
}

TEST(ArmGuardsTest, PositionInsideItsRangePassesBothEndsIncluded) {
    verifies("SWR-ARM-002", Technique::kBoundaryValues);

    EXPECT_TRUE(calc_position_violations(kInside, kRanges).is_empty());
    for (std::size_t joint = 0U; joint < kArmJointCount; ++joint) {
        EXPECT_TRUE(
            calc_position_violations(with(kInside, joint, kRanges[joint].min_rad), kRanges).is_empty());
        EXPECT_TRUE(
            calc_position_violations(with(kInside, joint, kRanges[joint].max_rad), kRanges).is_empty());
    }
}

TEST(ArmGuardsTest, WidestRangePassesEveryFinitePosition) {
    verifies("SWR-ARM-002", Technique::kBoundaryValues);
    constexpr double kLargest = std::numeric_limits<double>::max();
    JointRanges ranges;
    ranges.fill({-kLargest, kLargest});

    EXPECT_TRUE(are_valid(ranges));
    EXPECT_TRUE(calc_position_violations(with(kZero, 1U, kLargest), ranges).is_empty());
    EXPECT_TRUE(calc_position_violations(with(kZero, 1U, -kLargest), ranges).is_empty());
}

TEST(ArmGuardsTest, PositionOutsideItsRangeNamesTheJoint) {
    verifies("SWR-ARM-002", Technique::kBoundaryValues, Polarity::kViolation);

    for (std::size_t joint = 0U; joint < kArmJointCount; ++joint) {
        const JointVector low = with(kInside, joint, below(kRanges[joint].min_rad));
        const JointVector high = with(kInside, joint, above(kRanges[joint].max_rad));
        EXPECT_TRUE(is_only(calc_position_violations(low, kRanges), joint)) << joint;
        EXPECT_TRUE(is_only(calc_position_violations(high, kRanges), joint)) << joint;
        for (const double value : kNotFinite) {
            EXPECT_TRUE(is_only(calc_position_violations(with(kInside, joint, value), kRanges), joint))
                << value;
            JointRanges ranges = kRanges;
            ranges[joint].max_rad = value;
            EXPECT_TRUE(is_only(calc_position_violations(kInside, ranges), joint)) << "upper limit " << value;
            ranges = kRanges;
            ranges[joint].min_rad = value;
            EXPECT_TRUE(is_only(calc_position_violations(kInside, ranges), joint)) << "lower limit " << value;
        }
    }
}

TEST(ArmGuardsTest, SpeedUpToItsLimitPassesInBothDirections) {
    verifies("SWR-ARM-002", Technique::kBoundaryValues);

    EXPECT_TRUE(calc_speed_violations(kLimits, kLimits).is_empty());
    for (std::size_t joint = 0U; joint < kArmJointCount; ++joint) {
        EXPECT_TRUE(calc_speed_violations(with(kZero, joint, -kLimits[joint]), kLimits).is_empty()) << joint;
    }
}

TEST(ArmGuardsTest, SpeedBeyondItsLimitNamesTheJoint) {
    verifies("SWR-ARM-002", Technique::kBoundaryValues, Polarity::kViolation);

    for (std::size_t joint = 0U; joint < kArmJointCount; ++joint) {
        const JointVector forward = with(kZero, joint, above(kLimits[joint]));
        const JointVector backward = with(kZero, joint, below(-kLimits[joint]));
        EXPECT_TRUE(is_only(calc_speed_violations(forward, kLimits), joint)) << joint;
        EXPECT_TRUE(is_only(calc_speed_violations(backward, kLimits), joint)) << joint;
        for (const double value : kNotFinite) {
            EXPECT_TRUE(is_only(calc_speed_violations(with(kZero, joint, value), kLimits), joint)) << value;
        }
    }
}

TEST(ArmGuardsTest, LimitTablesThatCannotProtectAreFound) {
    verifies("SWR-ARM-002", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_FALSE(are_valid(kZero)) << "a limit of zero trips always";
    EXPECT_TRUE(are_valid(with(kLimits, 3U, std::numeric_limits<double>::max()))) << "finite";
    EXPECT_TRUE(are_valid(with(kLimits, 3U, std::numeric_limits<double>::denorm_min())));
    EXPECT_FALSE(are_valid(with(kLimits, 6U, -1.0)));
    EXPECT_FALSE(are_valid(JointRanges{})) << "an empty range";
    for (const double value : kNotFinite) {
        EXPECT_FALSE(are_valid(with(kLimits, 3U, value))) << value;
        JointRanges ranges = kRanges;
        ranges[3].min_rad = value;
        EXPECT_FALSE(are_valid(ranges)) << value;
        ranges = kRanges;
        ranges[3].max_rad = value;
        EXPECT_FALSE(are_valid(ranges)) << value;
    }
}

TEST(ArmGuardsTest, SetOfJointsTellsItsMembers) {
    verifies("SWR-ARM-002", Technique::kInterface);
    JointSet joints;
    EXPECT_TRUE(joints.is_empty());
    EXPECT_EQ(joints.get_first(), kArmJointCount);

    joints.insert(6U);
    joints.insert(2U);
    EXPECT_EQ(joints.get_first(), 2U);
    EXPECT_TRUE(joints.contains(2U) && joints.contains(6U));
    EXPECT_FALSE(joints.contains(0U) || joints.contains(7U) || joints.contains(99U));
    EXPECT_EQ(joints.get_bits(), 0x44U);
}

TEST(ArmGuardsTest, ChannelsThatAgreePass) {
    verifies("SWR-ARM-003", Technique::kBoundaryValues);
    expect_passes_up_to_its_limit(&calc_discrepancies);
}

TEST(ArmGuardsTest, ChannelsThatDisagreeNameTheJoint) {
    verifies("SWR-ARM-003", Technique::kBoundaryValues, Polarity::kViolation);
    expect_trips_beyond_its_limit(&calc_discrepancies);
}

TEST(ArmGuardsTest, PossibleMovementPasses) {
    verifies("SWR-ARM-004", Technique::kBoundaryValues);
    expect_passes_up_to_its_limit(&calc_jumps);
}

TEST(ArmGuardsTest, ImpossibleMovementNamesTheJoint) {
    verifies("SWR-ARM-004", Technique::kBoundaryValues, Polarity::kViolation);
    expect_trips_beyond_its_limit(&calc_jumps);
}

TEST(ArmGuardsTest, SmallFollowingErrorPasses) {
    verifies("SWR-ARM-005", Technique::kBoundaryValues);
    expect_passes_up_to_its_limit(&calc_following_errors);
}

TEST(ArmGuardsTest, LargeFollowingErrorNamesTheJoint) {
    verifies("SWR-ARM-005", Technique::kBoundaryValues, Polarity::kViolation);
    expect_trips_beyond_its_limit(&calc_following_errors);
}

TEST(ArmGuardsTest, TorqueAsCommandedPasses) {
    verifies("SWR-ARM-006", Technique::kBoundaryValues);
    expect_passes_up_to_its_limit(&calc_torque_deviations);
}

TEST(ArmGuardsTest, TorqueThatWasNotCommandedNamesTheJoint) {
    verifies("SWR-ARM-006", Technique::kBoundaryValues, Polarity::kViolation);
    expect_trips_beyond_its_limit(&calc_torque_deviations);
}

TEST(ArmGuardsTest, MessageUpToItsAgePasses) {
    verifies("SWR-ARM-007", Technique::kBoundaryValues);

    EXPECT_FALSE(is_message_too_old(Instant{0}, Instant{0}, Duration{10}));
    EXPECT_FALSE(is_message_too_old(Instant{0}, Instant{10}, Duration{10}));
}

TEST(ArmGuardsTest, OldMessageAndMessageFromTheFutureTrip) {
    verifies("SWR-ARM-007", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_TRUE(is_message_too_old(Instant{0}, Instant{11}, Duration{10}));
    EXPECT_TRUE(is_message_too_old(Instant{1}, Instant{0}, Duration{10}));
    EXPECT_TRUE(is_message_too_old(Instant{std::numeric_limits<std::int64_t>::min()},
                                   Instant{std::numeric_limits<std::int64_t>::max()}, Duration{10}));
}

TEST(StandstillDetectorTest, ArmStandsAfterItsTimeBelowTheLimit) {
    verifies("SWR-ARM-008", Technique::kBoundaryValues);
    StandstillDetector sut{kLimits, Duration{100}};
    EXPECT_FALSE(sut.is_standing());

    EXPECT_FALSE(sut.step(kLimits, Instant{1000}));
    EXPECT_FALSE(sut.step(kZero, Instant{1099}));
    EXPECT_TRUE(sut.step(kLimits, Instant{1100}));
    EXPECT_TRUE(sut.is_standing());
}

TEST(StandstillDetectorTest, HoldOfZeroStandsInTheFirstSlowCycle) {
    verifies("SWR-ARM-008", Technique::kBoundaryValues);
    StandstillDetector sut{kLimits, Duration{0}};

    EXPECT_FALSE(sut.step(with(kZero, 0U, 1.0), Instant{0}));
    EXPECT_TRUE(sut.step(kZero, Instant{1}));
}

TEST(StandstillDetectorTest, SingleJointAboveItsLimitBeginsTheTimeAnew) {
    verifies("SWR-ARM-008", Technique::kBoundaryValues, Polarity::kViolation);

    for (std::size_t joint = 0U; joint < kArmJointCount; ++joint) {
        for (const double speed : {above(kLimits[joint]), below(-kLimits[joint]), kNan, kInf}) {
            StandstillDetector sut{kLimits, Duration{100}};
            ASSERT_FALSE(sut.step(kZero, Instant{0}));
            ASSERT_TRUE(sut.step(kZero, Instant{100}));
            EXPECT_FALSE(sut.step(with(kZero, joint, speed), Instant{101})) << joint << ' ' << speed;
            EXPECT_FALSE(sut.step(kZero, Instant{102}));
            EXPECT_FALSE(sut.step(kZero, Instant{201}));
            EXPECT_TRUE(sut.step(kZero, Instant{202}));
        }
    }
}

TEST(StandstillDetectorTest, LimitsThatCannotProtectGoToTheAssertionHandler) {
    verifies("SWR-ARM-008", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_CHECK_FAILS((StandstillDetector{kZero, Duration{0}}), "arm/guards.hpp", 1);
    EXPECT_CHECK_FAILS((StandstillDetector{with(kLimits, 2U, kNan), Duration{0}}), "arm/guards.hpp", 1);
    EXPECT_CHECK_FAILS((StandstillDetector{kLimits, Duration{-1}}), "arm/guards.hpp", 1);
}

TEST(StandstillDetectorTest, ClockThatRunsBackwardsBeginsTheTimeAnew) {
    verifies("SWR-ARM-008", Technique::kFaultInjection, Polarity::kViolation);
    StandstillDetector sut{kLimits, Duration{100}};
    ASSERT_FALSE(sut.step(kZero, Instant{0}));
    ASSERT_TRUE(sut.step(kZero, Instant{200}));
    ASSERT_TRUE(sut.step(kZero, Instant{200})) << "a clock that stands does not";

    EXPECT_FALSE(sut.step(kZero, Instant{150}));
    EXPECT_TRUE(sut.step(kZero, Instant{250}));
}

TEST(JointSetTest, JointThatDoesNotExistGoesToTheAssertionHandler) {
    verifies("SWR-ARM-002", Technique::kBoundaryValues, Polarity::kViolation);
    JointSet joints;

    EXPECT_CHECK_FAILS(joints.insert(kArmJointCount), "joint_set.hpp", 1);
    joints.insert(kArmJointCount - 1U);
    EXPECT_EQ(joints.get_first(), kArmJointCount - 1U);
}

}  // namespace
}  // namespace mamori::safety
