// SPDX-License-Identifier: Apache-2.0
// Goal: no start jumps. Method: both sides of one encoder step on each axis, numbers that are none, and the
// first setpoint after each way of switching torque on.
#include "mamori/safety/reaction/bumpless_start.hpp"

#include <limits>

#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

using Axes = std::array<double, 3U>;

// Numbers that a double holds exactly, so that the limit itself can be tried.
constexpr double kStep = 1.0 / 4096.0;
constexpr double kLittle = kStep / 1024.0;
constexpr Axes kSteps{kStep, kStep, 2.0 * kStep};
constexpr Axes kMeasured{1.0, -0.5, 0.25};
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(BumplessStartTest, SetpointWithinOneEncoderStepMayStart) {
    verifies("SWR-FSM-030");

    EXPECT_TRUE(may_start_bumpless(kMeasured, kMeasured, kSteps));
    EXPECT_TRUE(may_start_bumpless(Axes{1.0 + kStep, -0.5 - kStep, 0.25 + 2.0 * kStep}, kMeasured, kSteps));
}

TEST(BumplessStartTest, JumpOverOneEncoderStepRefusesTheStartOnEachAxisAndSide) {
    verifies("SWR-FSM-030", Technique::kBoundaryValues, Polarity::kViolation);

    for (std::size_t axis = 0U; axis < kMeasured.size(); ++axis) {
        for (const double side : {-1.0, 1.0}) {
            Axes setpoint = kMeasured;
            setpoint[axis] = kMeasured[axis] + side * kSteps[axis];
            EXPECT_TRUE(may_start_bumpless(setpoint, kMeasured, kSteps)) << axis;
            setpoint[axis] = kMeasured[axis] + side * (kSteps[axis] + kLittle);
            EXPECT_FALSE(may_start_bumpless(setpoint, kMeasured, kSteps)) << axis;
        }
    }
}

TEST(BumplessStartTest, WhatIsNoNumberRefusesTheStart) {
    verifies("SWR-FSM-030", Technique::kFaultInjection, Polarity::kViolation);

    for (const double wrong : {kNan, kInfinity, -kInfinity}) {
        Axes spoilt = kMeasured;
        spoilt[1] = wrong;
        EXPECT_FALSE(may_start_bumpless(spoilt, kMeasured, kSteps));
        EXPECT_FALSE(may_start_bumpless(kMeasured, spoilt, kSteps));
        EXPECT_FALSE(may_start_bumpless(spoilt, spoilt, kSteps));
        EXPECT_FALSE(may_start_bumpless(kMeasured, kMeasured, spoilt));
    }
}

TEST(BumplessStartTest, EncoderStepThatIsNoneRefusesTheStart) {
    verifies("SWR-FSM-030", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_TRUE(may_start_bumpless(kMeasured, kMeasured, Axes{kStep, kLittle, kStep}));
    EXPECT_TRUE(
        may_start_bumpless(kMeasured, kMeasured, Axes{kStep, std::numeric_limits<double>::max(), kStep}));
    EXPECT_FALSE(may_start_bumpless(kMeasured, kMeasured, Axes{kStep, 0.0, kStep}));
    EXPECT_FALSE(may_start_bumpless(kMeasured, kMeasured, Axes{kStep, -kStep, kStep}));
}

TEST(BumplessStartTest, MissingAxesRefuseTheStart) {
    verifies("SWR-FSM-030", Technique::kBoundaryValues, Polarity::kViolation);
    const Span<const double> all = kMeasured;
    const Span<const double> steps = kSteps;

    EXPECT_TRUE(may_start_bumpless(all.subspan(0U, 1U), all.subspan(0U, 1U), steps.subspan(0U, 1U)));
    EXPECT_FALSE(may_start_bumpless(all.subspan(0U, 2U), all, steps));
    EXPECT_FALSE(may_start_bumpless(all, all.subspan(0U, 2U), steps));
    EXPECT_FALSE(may_start_bumpless(all, all, steps.subspan(0U, 2U)));
    EXPECT_FALSE(may_start_bumpless({}, {}, {})) << "a machine without axes has not been asked about";
}

TEST(SetpointGateTest, FirstSetpointUnderTorqueIsTheMeasuredPosition) {
    verifies("SWR-FSM-031");
    constexpr Axes kWanted{1.1, -0.4, 0.3};
    SetpointGate<3U> sut;

    EXPECT_EQ(sut.step(false, kWanted, kMeasured), kMeasured);
    EXPECT_EQ(sut.step(true, kWanted, kMeasured), kMeasured) << "the first cycle with torque";
    EXPECT_EQ(sut.step(true, kWanted, kMeasured), kWanted);
}

TEST(SetpointGateTest, EachTimeThatTorqueComesBackBeginsAtTheMeasuredPosition) {
    verifies("SWR-FSM-031", Technique::kStateTransition, Polarity::kViolation);
    constexpr Axes kWanted{1.1, -0.4, 0.3};
    constexpr Axes kSagged{0.9, -0.6, 0.2};
    SetpointGate<3U> sut;

    EXPECT_EQ(sut.step(true, kWanted, kMeasured), kMeasured) << "torque in the very first cycle";
    EXPECT_EQ(sut.step(true, kWanted, kMeasured), kWanted);
    EXPECT_EQ(sut.step(false, kWanted, kSagged), kSagged) << "the controller still wants to go on";
    EXPECT_EQ(sut.step(true, kWanted, kSagged), kSagged);
    EXPECT_EQ(sut.step(true, kWanted, kSagged), kWanted);
}

}  // namespace
}  // namespace mamori::safety
