// SPDX-License-Identifier: Apache-2.0
// Goal: whatever differs between two port sets is found, and named; what cannot be a tolerance does not
// compile. Method: every value of a nested set is changed in turn, to both sides of its tolerance; every bit
// of its exact values.
#include "mamori/safety/redundancy/cross_comparison.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "compile_fail/compiler.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety::cross_comparison_test {

enum class Mode : std::uint8_t { kStop, kMove };

struct Joint {
    double position_rad;
    float torque_nm;
};

struct Ports {
    std::array<Joint, 2U> joints;
    std::array<double, 2U> limits;
    std::int64_t count;
    bool is_on;
    Mode mode;
    BoundedSequence<double, 2U> forces_n;
    BoundedSequence<Joint, 2U> more;
    BoundedString<4U> name;
};

}  // namespace mamori::safety::cross_comparison_test

MAMORI_FIELDS(mamori::safety::cross_comparison_test::Joint, position_rad, torque_nm)
MAMORI_FIELDS(mamori::safety::cross_comparison_test::Ports, joints, limits, count, is_on, mode, forces_n,
              more, name)

namespace mamori::safety {
namespace {

using cross_comparison_test::Joint;
using cross_comparison_test::Mode;
using cross_comparison_test::Ports;
using namespace verification;

constexpr Joint kJointTolerance{0.5, 0.25F};
constexpr Ports kTolerance{{{kJointTolerance, {0.0, 0.0F}}},
                           {{0.5, 0.0}},
                           0,
                           false,
                           Mode::kStop,
                           std::array{0.5, 0.5},
                           std::array{kJointTolerance, kJointTolerance},
                           {}};
using Comparison = CrossComparison<Ports, kTolerance>;

/// A change of one value, and the field that it belongs to.
struct Change {
    std::size_t field;
    std::function<void(Ports&)> apply;
};

class CrossComparisonTest : public ::testing::Test {
  protected:
    Discrepancy step(std::int64_t at_ns) { return sut_.step(own_, other_, Instant{at_ns}); }

    /// @return field that differs after the change of one channel's set; of both in turn the same.
    std::size_t find(const Change& change) const {
        Ports changed = own_;
        change.apply(changed);
        Comparison first(Duration{0});
        Comparison second(Duration{0});
        const bool is_found = first.step(own_, changed, Instant{0}) != Discrepancy::kNone;
        EXPECT_EQ(second.step(changed, own_, Instant{0}) != Discrepancy::kNone, is_found);
        EXPECT_EQ(first.get_first_difference(), second.get_first_difference());
        EXPECT_EQ(is_found, first.get_first_difference() != Comparison::kNoField);
        return first.get_first_difference();
    }

    Ports own_{{{{1.0, 1.0F}, {2.0, 2.0F}}}, {{3.0, 4.0}}, 7, true, Mode::kMove, std::array{5.0},
               std::array{Joint{6.0, 6.0F}}, "arm"};
    Ports other_{own_};
    Comparison sut_{Duration{100}};
};

TEST_F(CrossComparisonTest, EqualSetsAgree) {
    verifies("SWR-RED-008");

    EXPECT_EQ(step(0), Discrepancy::kNone);
    EXPECT_EQ(sut_.get_first_difference(), Comparison::kNoField);
    EXPECT_EQ(sut_.get_discrepancy(), Discrepancy::kNone);
}

TEST_F(CrossComparisonTest, ValuesUpToTheirToleranceAgree) {
    verifies("SWR-RED-008", Technique::kBoundaryValues);
    other_.joints[0] = {1.5, 0.75F};
    other_.limits[0] = 2.5;
    other_.forces_n[0] = 5.5;
    other_.more[0] = {5.5, 6.25F};

    EXPECT_EQ(step(0), Discrepancy::kNone);
}

TEST_F(CrossComparisonTest, EveryValueBeyondItsToleranceIsFoundAndItsFieldNamed) {
    verifies("SWR-RED-008", Technique::kFaultInjection, Polarity::kViolation);
    constexpr double kSmallest = std::numeric_limits<double>::epsilon() * 8.0;
    const std::vector<Change> changes{
        {0U, [](Ports& p) { p.joints[0].position_rad += 0.5 + kSmallest; }},
        {0U, [](Ports& p) { p.joints[0].torque_nm -= 0.2501F; }},
        {0U, [](Ports& p) { p.joints[1].position_rad += kSmallest; }},
        {0U, [](Ports& p) { p.joints[1].torque_nm += 0.001F; }},
        {1U, [](Ports& p) { p.limits[0] -= 0.5 + kSmallest; }},
        {1U, [](Ports& p) { p.limits[1] += kSmallest; }},
        {3U, [](Ports& p) { p.is_on = false; }},
        {4U, [](Ports& p) { p.mode = Mode::kStop; }},
        {5U, [](Ports& p) { p.forces_n[0] += 0.5 + kSmallest; }},
        {5U, [](Ports& p) { static_cast<void>(p.forces_n.push_back(0.0)); }},
        {5U, [](Ports& p) { p.forces_n.clear(); }},
        {6U, [](Ports& p) { p.more[0].torque_nm += 0.2501F; }},
        {7U, [](Ports& p) { p.name = "arn"; }},
    };

    for (std::size_t i = 0U; i < changes.size(); ++i) {
        EXPECT_EQ(find(changes[i]), changes[i].field) << "change " << i;
    }
}

TEST_F(CrossComparisonTest, EveryBitOfAnIntegerIsCompared) {
    verifies("SWR-RED-008", Technique::kFaultInjection, Polarity::kViolation);

    for (unsigned int bit = 0U; bit < 64U; ++bit) {
        const auto turn = [bit](Ports& p) {
            p.count =
                static_cast<std::int64_t>(static_cast<std::uint64_t>(p.count) ^ (std::uint64_t{1} << bit));
        };
        ASSERT_EQ(find({2U, turn}), 2U) << bit;
    }
}

TEST_F(CrossComparisonTest, WhatIsNotANumberIsADifferenceInBothSetsToo) {
    verifies("SWR-RED-008", Technique::kFaultInjection, Polarity::kViolation);
    own_.limits[0] = std::numeric_limits<double>::quiet_NaN();
    other_.limits[0] = own_.limits[0];

    EXPECT_EQ(step(0), Discrepancy::kTolerated);
    EXPECT_EQ(sut_.get_first_difference(), 1U);
}

TEST_F(CrossComparisonTest, DifferenceIsToleratedForItsTimeWhateverFieldHasIt) {
    verifies("SWR-RED-007", Technique::kBoundaryValues);
    other_.count = 8;
    ASSERT_EQ(step(0), Discrepancy::kTolerated);
    other_.count = 7;
    other_.is_on = false;
    ASSERT_EQ(step(100), Discrepancy::kTolerated);
    EXPECT_EQ(sut_.get_first_difference(), 3U);
    other_.is_on = true;

    EXPECT_EQ(step(101), Discrepancy::kNone);
    EXPECT_EQ(sut_.get_first_difference(), Comparison::kNoField);
}

TEST_F(CrossComparisonTest, LatchedDifferenceKeepsItsFieldUntilAcknowledged) {
    verifies("SWR-RED-007", Technique::kBoundaryValues, Polarity::kViolation);
    other_.count = 8;
    ASSERT_EQ(step(0), Discrepancy::kTolerated);
    ASSERT_EQ(step(101), Discrepancy::kLatched);
    EXPECT_EQ(sut_.acknowledge(), Status::kPreconditionNotMet);

    other_ = own_;
    EXPECT_EQ(step(102), Discrepancy::kLatched);
    EXPECT_EQ(sut_.get_first_difference(), 2U);
    EXPECT_EQ(sut_.acknowledge(), Status::kOk);
    EXPECT_EQ(step(103), Discrepancy::kNone);
    EXPECT_EQ(sut_.get_first_difference(), Comparison::kNoField);
}

TEST(CrossComparisonCompileTest, TolerancesForEveryValueCompile) {
    verifies("SWR-RED-009");

    const rig::Compilation result = rig::compile("redundancy_source.cpp", "MAMORI_DEFECT_NONE");
    EXPECT_EQ(result.exit_status, 0) << result.messages;
}

TEST(CrossComparisonCompileTest, WhatIsNoToleranceDoesNotCompile) {
    verifies("SWR-RED-009", Technique::kErrorGuessing, Polarity::kViolation);

    for (const char* const defect : {"MAMORI_DEFECT_NEGATIVE", "MAMORI_DEFECT_INFINITE", "MAMORI_DEFECT_NAN",
                                     "MAMORI_DEFECT_EXACT_INTEGER", "MAMORI_DEFECT_EXACT_BOOL",
                                     "MAMORI_DEFECT_SHORT_SEQUENCE", "MAMORI_DEFECT_TEXT"}) {
        const rig::Compilation result = rig::compile("redundancy_source.cpp", defect);
        EXPECT_EQ(result.exit_status, 1) << defect;
        EXPECT_TRUE(result.names("tolerance that is negative or not finite")) << result.messages;
    }
}

TEST(CrossComparisonCompileTest, EveryKindOfToleranceIsJudged) {
    verifies("SWR-RED-009", Technique::kEquivalenceClasses, Polarity::kViolation);
    const std::vector<Change> changes{
        {0U, [](Ports& p) { p.joints[1].torque_nm = -1.0F; }},
        {1U, [](Ports& p) { p.limits[0] = -1.0; }},
        {1U, [](Ports& p) { p.limits[1] = -1.0; }},
        {2U, [](Ports& p) { p.count = 1; }},
        {3U, [](Ports& p) { p.is_on = true; }},
        {4U, [](Ports& p) { p.mode = Mode::kMove; }},
        {5U, [](Ports& p) { p.forces_n.clear(); }},
        {6U, [](Ports& p) { p.more.clear(); }},
        {7U, [](Ports& p) { p.name = "a"; }},
    };

    EXPECT_TRUE(are_tolerances(kTolerance));
    for (const Change& change : changes) {
        Ports tolerance = kTolerance;
        change.apply(tolerance);
        EXPECT_FALSE(are_tolerances(tolerance)) << change.field;
    }
}

}  // namespace
}  // namespace mamori::safety
