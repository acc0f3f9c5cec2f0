// SPDX-License-Identifier: Apache-2.0
// Goal: the compiler refuses modes that could not work, and its message names the rule and the guilty
// element. Method: support/compilation.hpp; one system, broken by one thing at a time.
#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"
#include "support/compilation.hpp"

namespace mamori {
namespace {

using testing_support::expect_explained;
using testing_support::expect_refused;
using namespace verification;

void expect_broken(int number, const std::string& expected) {
    expect_refused("system_modes", "", expected, std::to_string(number));
}

TEST(ModeCompileFailTest, AConnectionThatHoldsInAnUnknownModeIsRefused) {
    verifies("SWR-MOD-003", Technique::kInterface, Polarity::kViolation);
    expect_broken(1, "ConnectionHoldsInKnownModes<mamori::Name<'t', 'e', 'c', 'h'>");
}

TEST(ModeCompileFailTest, ASecondWriterInOneModeIsRefused) {
    verifies("SWR-MOD-003", Technique::kInterface, Polarity::kViolation);
    expect_broken(2, "InputHasOneWriter<Axis, &Axis::in, 0>");
}

TEST(ModeCompileFailTest, AMandatoryInputThatNoConnectionFeedsInAModeIsRefused) {
    verifies("SWR-MOD-003", Technique::kInterface, Polarity::kViolation);
    expect_broken(3, "InputIsFedInEachModeOfItsComponent<mamori::Name<'t', 'e', 'a', 'c', 'h'>");
    expect_broken(3, "PortMember<Axis, &Axis::in>");
}

TEST(ModeCompileFailTest, ASetInTheTableWhoseValueIsOutsideItsConstraintIsRefused) {
    verifies("SWR-MOD-002", Technique::kInterface, Polarity::kViolation);
    expect_broken(4,
                  "kValueOutsideConstraint, mamori::Name<'s', 'l', 'o', 'w'>, "
                  "mamori::rules::ParameterOf<Axis, &Axis::speed, 0>");
}

TEST(ModeCompileFailTest, AModeOfAComponentThatNoWindowRunsIsRefused) {
    verifies("SWR-MOD-003", Technique::kInterface, Polarity::kViolation);
    expect_broken(5, "ModeRunsComponentsOfTheTable<mamori::Name<'w', 'o', 'r', 'k'>, Spare>");
}

TEST(ModeCompileFailTest, TwoModesOfOneNameAreRefused) {
    verifies("SWR-MOD-003", Technique::kInterface, Polarity::kViolation);
    expect_broken(6, "ModeHasANameOfItsOwn<mamori::Name<'w', 'o', 'r', 'k'>");
}

TEST(ModeCompileFailTest, AMandatoryInputWhoseSourceDoesNotRunInAModeIsRefused) {
    verifies("SWR-MOD-003", Technique::kInterface, Polarity::kViolation);
    expect_broken(7, "InputIsFedInEachModeOfItsComponent<mamori::Name<'t', 'e', 'a', 'c', 'h'>");
}

TEST(ModeCompileFailTest, ASafeModeThatWouldActivateSomebodyIsRefused) {
    verifies("SWR-MOD-003", Technique::kInterface, Polarity::kViolation);
    expect_broken(8, "SafeModeActivatesNobody<Spare, mamori::Name<'t', 'e', 'a', 'c', 'h'>");
}

TEST(ModeCompileFailTest, AModeWithAnUnknownConfigurationSetIsRefused) {
    verifies("SWR-MOD-003", Technique::kInterface, Polarity::kViolation);
    expect_broken(9,
                  "ModeHasAKnownConfigurationSet<mamori::Name<'t', 'e', 'a', 'c', 'h'>, mamori::Name<'s', "
                  "'l', 'o'>");
}

TEST(ModeCompileFailTest, ModesWithoutASafeOneAreRefused) {
    verifies("SWR-MOD-003", Technique::kInterface, Polarity::kViolation);
    expect_broken(10, "SystemHasASafeMode<mamori::Name<'w', 'o', 'r', 'k'>");
}

TEST(ModeCompileFailTest, TwoSafeModesAreRefused) {
    verifies("SWR-MOD-003", Technique::kInterface, Polarity::kViolation);
    expect_broken(11, "SystemHasOneSafeMode<mamori::Name<'s', 't', 'o', 'p'>");
}

TEST(ModeCompileFailTest, ATransitionOutOfTheSafeModeIsRefused) {
    verifies("SWR-MOD-003", Technique::kInterface, Polarity::kViolation);
    expect_broken(12, "SafeModeIsLeftByResetOnly<mamori::Name<'w', 'o', 'r', 'k'>");
}

TEST(ModeCompileFailTest, AnEventWithTwoTransitionsInOneModeIsRefused) {
    verifies("SWR-MOD-003", Technique::kInterface, Polarity::kViolation);
    expect_broken(13, "EventLeadsToOneMode<mamori::Name<'w', 'o', 'r', 'k'>, 0>");
}

TEST(ModeCompileFailTest, AComponentThatNoModeRunsIsRefused) {
    verifies("SWR-MOD-003", Technique::kInterface, Polarity::kViolation);
    expect_broken(14, "ComponentRunsInSomeMode<Spare, 0>");
}

TEST(ModeCompileFailTest, ATransitionToAnUnknownModeIsRefused) {
    verifies("SWR-MOD-003", Technique::kInterface, Polarity::kViolation);
    expect_broken(15,
                  "TransitionJoinsKnownModes<mamori::Name<'w', 'o', 'r', 'k'>, mamori::Name<'t', 'e', 'c', "
                  "'h'>");
}

TEST(ModeCompileFailTest, AModeThatNoTransitionLeadsToIsRefused) {
    verifies("SWR-MOD-003", Technique::kInterface, Polarity::kViolation);
    expect_broken(16, "ModeIsReachable<mamori::Name<'t', 'e', 'a', 'c', 'h'>");
}

TEST(ModeCompileFailTest, AModeWithoutANameIsRefused) {
    verifies("SWR-MOD-003", Technique::kBoundaryValues, Polarity::kViolation);
    expect_broken(17, "ModeRowIsValid<mamori::rules::Row<1>");
    expect_broken(18, "ModeRowIsValid<mamori::rules::Row<1>");
}

TEST(ModeCompileFailTest, ATransitionFromAnUnknownModeIsRefused) {
    verifies("SWR-MOD-003", Technique::kInterface, Polarity::kViolation);
    expect_broken(19, "TransitionJoinsKnownModes<mamori::Name<'t', 'e', 'e', 'c', 'h'>");
}

TEST(ModeCompileFailTest, AFaultySetInTheTableIsNamedWithItsParameter) {
    verifies("SWR-PAR-022", Technique::kInterface, Polarity::kViolation);
    expect_broken(20, "SetRowIsValid<mamori::rules::Row<0>");
    expect_broken(21, "kUnknownParameter, mamori::Name<'s', 'l', 'o', 'w'>, mamori::rules::Assignment<0>");
    expect_broken(22,
                  "kParameterAssignedTwice, mamori::Name<'s', 'l', 'o', 'w'>, "
                  "mamori::rules::ParameterOf<Axis, &Axis::speed, 0>");
    expect_broken(23, "kSetNamedTwice, mamori::Name<'s', 'l', 'o', 'w'>, mamori::rules::Row<1>");
}

TEST(ModeCompileFailTest, AnExecutiveOfATableWithModesOrSetsNeedsTheirSwitch) {
    verifies("SWR-MOD-008", Technique::kInterface, Polarity::kViolation);
    const std::string needs = "a table with modes or configuration sets needs a SystemModes: write";
    expect_refused("executive_without_modes", "", needs, "1");
    expect_refused("executive_without_modes", "", needs, "2");
}

TEST(ModeCompileFailTest, AnEventOfMoreThan32BitsIsRefused) {
    verifies("SWR-MOD-003", Technique::kBoundaryValues, Polarity::kViolation);
    expect_explained("table_enumerators", "", "events, faults and reactions have at most 32 bits", "1");
}

TEST(ModeCompileFailTest, AFaultOrReactionOfMoreThan32BitsIsRefused) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);
    for (const char* option : {"2", "3", "4"}) {
        expect_explained("table_enumerators", "", "events, faults and reactions have at most 32 bits",
                         option);
    }
}

TEST(ModeCompileFailTest, EventsOfTwoEnumerationsInOneTableAreRefused) {
    verifies("SWR-MOD-003", Technique::kInterface, Polarity::kViolation);
    expect_refused("table_enumerators", "", "are enumerators of one enumeration", "5");
}

TEST(ModeCompileFailTest, EnumeratorsThatDoNotNameTheModesAreRejected) {
    verifies("SWR-MOD-010", Technique::kInterface, Polarity::kViolation);
    const char* const in_order = "the modes of a system are the enumerators 0, 1, ... of one enumeration";

    expect_explained("mode_enumerators", "", "a mode without an enumerator", "1");
    expect_explained("mode_enumerators", "", in_order, "2");
    expect_explained("mode_enumerators", "", in_order, "3");
    expect_explained("mode_enumerators", "", "a mode is an enumerator", "4");
}

}  // namespace
}  // namespace mamori
