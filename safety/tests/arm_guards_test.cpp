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
constexpr std::size_t kAxes = 7U;
using Axes = std::array<double, kAxes>;
constexpr Axes kZero{};
constexpr Axes kLimits{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7};
constexpr std::array<AxisRange, 7U> kRanges{
    {{-1.0, 1.0}, {-2.0, 0.5}, {0.25, 0.5}, {-3.0, -1.0}, {-1.0, 1.0}, {-1.0, 1.0}, {-1.0, 1.0}}};
constexpr Axes kInside{0.0, 0.0, 0.3, -2.0, 0.0, 0.0, 0.0};

static_assert(are_valid(kRanges) && are_valid(kLimits));

double above(double value) {
    return std::nextafter(value, kInf);
}
double below(double value) {
    return std::nextafter(value, -kInf);
}

Axes with(Axes values, std::size_t joint, double value) {
    values[joint] = value;
    return values;
}

bool is_only(const AxisSet& joints, std::size_t joint) {
    return joints.get_bits() == (1U << joint);
}

using Deviation = AxisSet (*)(AxisValues, AxisValues, AxisValues) noexcept;

void expect_passes_up_to_its_limit(Deviation guard) {
    EXPECT_TRUE(guard(kZero, kZero, kLimits).is_empty());
    EXPECT_TRUE(guard(kInside, kInside, kLimits).is_empty()) << "far from zero";
    for (std::size_t joint = 0U; joint < kAxes; ++joint) {
        EXPECT_TRUE(guard(with(kZero, joint, kLimits[joint]), kZero, kLimits).is_empty()) << joint;
        EXPECT_TRUE(guard(kZero, with(kZero, joint, kLimits[joint]), kLimits).is_empty()) << joint;
    }
}

void expect_trips_beyond_its_limit(Deviation guard) {
    for (std::size_t joint = 0U; joint < kAxes; ++joint) {
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
    for (std::size_t joint = 0U; joint < kAxes; ++joint) {
        EXPECT_TRUE(calc_position_violations(with(kInside, joint, kRanges[joint].min), kRanges).is_empty());
        EXPECT_TRUE(calc_position_violations(with(kInside, joint, kRanges[joint].max), kRanges).is_empty());
    }
}

TEST(ArmGuardsTest, WidestRangePassesEveryFinitePosition) {
    verifies("SWR-ARM-002", Technique::kBoundaryValues);
    constexpr double kLargest = std::numeric_limits<double>::max();
    std::array<AxisRange, 7U> ranges;
    ranges.fill({-kLargest, kLargest});

    EXPECT_TRUE(are_valid(ranges));
    EXPECT_TRUE(calc_position_violations(with(kZero, 1U, kLargest), ranges).is_empty());
    EXPECT_TRUE(calc_position_violations(with(kZero, 1U, -kLargest), ranges).is_empty());
}

TEST(ArmGuardsTest, PositionOutsideItsRangeNamesTheJoint) {
    verifies("SWR-ARM-002", Technique::kBoundaryValues, Polarity::kViolation);

    for (std::size_t joint = 0U; joint < kAxes; ++joint) {
        const Axes low = with(kInside, joint, below(kRanges[joint].min));
        const Axes high = with(kInside, joint, above(kRanges[joint].max));
        EXPECT_TRUE(is_only(calc_position_violations(low, kRanges), joint)) << joint;
        EXPECT_TRUE(is_only(calc_position_violations(high, kRanges), joint)) << joint;
        for (const double value : kNotFinite) {
            EXPECT_TRUE(is_only(calc_position_violations(with(kInside, joint, value), kRanges), joint))
                << value;
            std::array<AxisRange, 7U> ranges = kRanges;
            ranges[joint].max = value;
            EXPECT_TRUE(is_only(calc_position_violations(kInside, ranges), joint)) << "upper limit " << value;
            ranges = kRanges;
            ranges[joint].min = value;
            EXPECT_TRUE(is_only(calc_position_violations(kInside, ranges), joint)) << "lower limit " << value;
        }
    }
}

TEST(ArmGuardsTest, SpeedUpToItsLimitPassesInBothDirections) {
    verifies("SWR-ARM-002", Technique::kBoundaryValues);

    EXPECT_TRUE(calc_speed_violations(kLimits, kLimits).is_empty());
    for (std::size_t joint = 0U; joint < kAxes; ++joint) {
        EXPECT_TRUE(calc_speed_violations(with(kZero, joint, -kLimits[joint]), kLimits).is_empty()) << joint;
    }
}

TEST(ArmGuardsTest, SpeedBeyondItsLimitNamesTheJoint) {
    verifies("SWR-ARM-002", Technique::kBoundaryValues, Polarity::kViolation);

    for (std::size_t joint = 0U; joint < kAxes; ++joint) {
        const Axes forward = with(kZero, joint, above(kLimits[joint]));
        const Axes backward = with(kZero, joint, below(-kLimits[joint]));
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
    EXPECT_FALSE(are_valid(std::array<AxisRange, 7U>{})) << "an empty range";
    for (const double value : kNotFinite) {
        EXPECT_FALSE(are_valid(with(kLimits, 3U, value))) << value;
        std::array<AxisRange, 7U> ranges = kRanges;
        ranges[3].min = value;
        EXPECT_FALSE(are_valid(ranges)) << value;
        ranges = kRanges;
        ranges[3].max = value;
        EXPECT_FALSE(are_valid(ranges)) << value;
    }
}

TEST(ArmGuardsTest, SetOfAxesTellsItsMembers) {
    verifies("SWR-ARM-002", Technique::kInterface);
    AxisSet axes;
    EXPECT_TRUE(axes.is_empty());
    EXPECT_EQ(axes.get_first(), kAxisMax);

    axes.insert(6U);
    axes.insert(2U);
    EXPECT_EQ(axes.get_first(), 2U);
    EXPECT_TRUE(axes.contains(2U) && axes.contains(6U));
    EXPECT_FALSE(axes.contains(0U) || axes.contains(7U) || axes.contains(99U));
    EXPECT_EQ(axes.get_bits(), 0x44U);
    AxisSet others;
    others.insert(8U);
    EXPECT_EQ(unite(axes, others).get_bits(), 0x144U);
}

TEST(ArmGuardsTest, OneToNineAxesAreCompared) {
    verifies("SWR-ARM-009", Technique::kBoundaryValues);
    constexpr std::array<double, kAxisMax> kOnes{1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
    constexpr AxisRange kRange{-1.0, 1.0};
    constexpr std::array<AxisRange, kAxisMax> kAll{kRange, kRange, kRange, kRange, kRange,
                                                   kRange, kRange, kRange, kRange};
    for (std::size_t count = 1U; count <= kAxisMax; ++count) {
        std::array<double, kAxisMax> values{};
        values[count - 1U] = 1.5;
        const AxisValues some{values.data(), count};
        const AxisValues limits{kOnes.data(), count};
        EXPECT_TRUE(is_only(calc_speed_violations(some, limits), count - 1U)) << count;
        EXPECT_TRUE(is_only(calc_position_violations(some, {kAll.data(), count}), count - 1U)) << count;
        EXPECT_TRUE(calc_jumps(some, limits, limits).is_empty()) << "1.5 and 0 are at most 1 from 1";
        StandstillDetector detector{limits, Duration{0}};
        EXPECT_FALSE(detector.step(some, Instant{1}));
        values[count - 1U] = 1.0;
        EXPECT_TRUE(detector.step(some, Instant{2})) << count;
        EXPECT_TRUE(are_valid(limits) && are_valid(Span<const AxisRange>{kAll.data(), count}));
    }
}

TEST(ArmGuardsTest, AnotherNumberOfAxesGoesToTheAssertionHandler) {
    verifies("SWR-ARM-009", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr std::array<double, 10U> kMany{1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
    std::array<AxisRange, 10U> many_ranges{};
    many_ranges.fill({-1.0, 1.0});
    EXPECT_FALSE(are_valid(many_ranges));
    const AxisValues six{kLimits.data(), 6U};

    EXPECT_FALSE(are_valid(AxisValues{}) || are_valid(Span<const AxisRange>{}) || are_valid(kMany));
    EXPECT_CHECK_FAILS(static_cast<void>(calc_jumps(kZero, six, kLimits)), "guards.cpp", 2);
    EXPECT_CHECK_FAILS(static_cast<void>(calc_jumps(kZero, kZero, six)), "guards.cpp", 2);
    EXPECT_CHECK_FAILS(static_cast<void>(calc_jumps(kMany, kMany, kMany)), "guards.cpp", 2);
    EXPECT_CHECK_FAILS(static_cast<void>(calc_position_violations(six, kRanges)), "guards.cpp", 3);
    EXPECT_CHECK_FAILS(static_cast<void>(calc_position_violations(kMany, many_ranges)), "guards.cpp", 3);
    EXPECT_CHECK_FAILS(static_cast<void>(calc_speed_violations(kMany, kMany)), "guards.cpp", 4);
    EXPECT_CHECK_FAILS(static_cast<void>(calc_speed_violations(kZero, six)), "guards.cpp", 2);
    EXPECT_CHECK_FAILS((StandstillDetector{kMany, Duration{0}}), "arm/guards.hpp", 1);
    StandstillDetector detector{kLimits, Duration{0}};
    EXPECT_CHECK_FAILS(static_cast<void>(detector.step(six, Instant{})), "guards.cpp", 2);
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

    for (std::size_t joint = 0U; joint < kAxes; ++joint) {
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

TEST(AxisSetTest, AxisThatDoesNotExistGoesToTheAssertionHandler) {
    verifies("SWR-ARM-002", Technique::kBoundaryValues, Polarity::kViolation);
    AxisSet axes;

    EXPECT_CHECK_FAILS(axes.insert(kAxisMax), "axis_set.hpp", 1);
    axes.insert(kAxisMax - 1U);
    EXPECT_EQ(axes.get_first(), kAxisMax - 1U);
}

}  // namespace
}  // namespace mamori::safety
