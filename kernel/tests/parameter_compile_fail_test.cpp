// SPDX-License-Identifier: Apache-2.0
// Goal: the compiler refuses parameters and configurations that break a rule, and its message says what and
// where. Method: support/compilation.hpp.
#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"
#include "support/compilation.hpp"

namespace mamori {
namespace {

using testing_support::compile;
using testing_support::expect_refused;
using namespace verification;

TEST(ParameterCompileFailTest, AMalformedConstraintIsRefusedWithItsRule) {
    verifies("SWR-PAR-004", Technique::kInterface, Polarity::kViolation);
    expect_refused("parameters", "constraint_malformed", "kTextBeyondEnd");
}

TEST(ParameterCompileFailTest, AMalformedConstraintIsRefusedWithItsPlaceAndParameter) {
    verifies("SWR-PAR-004", Technique::kInterface, Polarity::kViolation);
    const std::string output = compile("parameters", "-DMAMORI_BREAK_CONSTRAINT_MALFORMED").output;

    // g++ writes [with long unsigned int kCharacter = 11], clang refuse_at_character<11UL>.
    EXPECT_TRUE(output.find("kCharacter = 11]") != std::string::npos ||
                output.find("refuse_at_character<11") != std::string::npos)
        << output;
    EXPECT_NE(output.find("\"limit\""), std::string::npos) << output;
    EXPECT_NE(output.find("\"0.1<=x<=3.0a\""), std::string::npos) << output;
}

TEST(ParameterCompileFailTest, ALimitThatTheTypeDoesNotHaveIsRefused) {
    verifies("SWR-PAR-004", Technique::kInterface, Polarity::kViolation);
    expect_refused("parameters", "constraint_not_in_type", "kNotInType");
}

TEST(ParameterCompileFailTest, AConstraintWithoutRoomIsRefused) {
    verifies("SWR-PAR-004", Technique::kInterface, Polarity::kViolation);
    expect_refused("parameters", "constraint_without_room", "kTooManyRanges");
}

TEST(ParameterCompileFailTest, ADefaultOutsideItsConstraintIsRefused) {
    verifies("SWR-PAR-004", Technique::kInterface, Polarity::kViolation);
    expect_refused("parameters", "default_outside_constraint", "require_default_within_constraint");
}

TEST(ParameterCompileFailTest, AParameterOfATypeThatHasNoConstraintIsRefused) {
    verifies("SWR-PAR-004", Technique::kInterface, Polarity::kViolation);
    expect_refused("parameters", "parameter_of_odd_type",
                   "a parameter is a bool, integer, float, double, enum");
}

TEST(ParameterCompileFailTest, AMemberThatIsNoParameterIsRefused) {
    verifies("SWR-PAR-006", Technique::kInterface, Polarity::kViolation);
    expect_refused("parameters", "parameter_is_no_parameter", "names members that are parameters");
}

TEST(ParameterCompileFailTest, AValueOutsideItsConstraintIsRefusedWithItsSetAndPlace) {
    verifies("SWR-PAR-006", Technique::kInterface, Polarity::kViolation);
    expect_refused("parameters", "set_value_outside_constraint", "kValueOutsideConstraint, 1, 1>");
}

TEST(ParameterCompileFailTest, AParameterThatIsAssignedTwiceIsRefused) {
    verifies("SWR-PAR-006", Technique::kInterface, Polarity::kViolation);
    expect_refused("parameters", "set_assigns_twice", "kParameterAssignedTwice, 0, 1>");
}

TEST(ParameterCompileFailTest, AParameterOfAComponentThatIsNotListedIsRefused) {
    verifies("SWR-PAR-006", Technique::kInterface, Polarity::kViolation);
    expect_refused("parameters", "set_of_unknown_parameter", "kUnknownParameter, 0, 0>");
}

TEST(ParameterCompileFailTest, TwoSetsOfOneNameAreRefused) {
    verifies("SWR-PAR-006", Technique::kInterface, Polarity::kViolation);
    expect_refused("parameters", "set_named_twice", "kSetNamedTwice, 1, 0>");
}

TEST(ParameterCompileFailTest, ASetWithoutANameIsRefused) {
    verifies("SWR-PAR-006", Technique::kInterface, Polarity::kViolation);
    expect_refused("parameters", "set_without_name", "kSetRowInvalid, 0, 0>");
}

}  // namespace
}  // namespace mamori
