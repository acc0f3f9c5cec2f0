// SPDX-License-Identifier: Apache-2.0
// Goal: the compiler refuses parameters and configurations that break a rule, and its message says what and
// where. Method: support/compilation.hpp.
#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"
#include "support/compilation.hpp"

namespace mamori {
namespace {

using testing_support::compile;
using testing_support::expect_explained;
using testing_support::expect_refused;
using namespace verification;

TEST(ParameterCompileFailTest, AConstraintThatExcludesEveryValueIsRejected) {
    verifies("SWR-PAR-004", Technique::kInterface, Polarity::kViolation);
    expect_explained("parameters", "constraint_without_value", "require_range_contains_a_value");
}

TEST(ParameterCompileFailTest, ARejectedConstraintIsShownWithItsParameter) {
    verifies("SWR-PAR-004", Technique::kInterface, Polarity::kViolation);
    const std::string output = compile("parameters", "-DMAMORI_BREAK_CONSTRAINT_WITHOUT_VALUE").output;

    EXPECT_NE(output.find("\"limit\""), std::string::npos) << output;
}

TEST(ParameterCompileFailTest, ALimitThatTheTypeDoesNotHaveIsRejected) {
    verifies("SWR-PAR-004", Technique::kInterface, Polarity::kViolation);
    expect_explained("parameters", "limit_not_in_type", "require_limit_within_type");
}

TEST(ParameterCompileFailTest, ALimitOfAnotherTypeIsRejectedWithAnExample) {
    verifies("SWR-PAR-004", Technique::kInterface, Polarity::kViolation);
    expect_explained("parameters", "limit_of_other_type",
                     "a limit has the type of its parameter, for example 0.0 for double");
}

TEST(ParameterCompileFailTest, AConstraintAsTextIsRejectedWithTheListOfConstraints) {
    verifies("SWR-PAR-004", Technique::kInterface, Polarity::kViolation);
    expect_explained("parameters", "constraint_as_text", "a constraint is at_least(), above(), at_most()");
}

TEST(ParameterCompileFailTest, AConstraintForPartOfTheElementsIsRejected) {
    verifies("SWR-PAR-004", Technique::kInterface, Polarity::kViolation);
    expect_explained("parameters", "constraint_count", "one constraint for each element");
}

TEST(ParameterCompileFailTest, AConstraintWithoutRoomIsRejected) {
    verifies("SWR-PAR-004", Technique::kInterface, Polarity::kViolation);
    expect_explained("parameters", "constraint_without_room",
                     "more ranges and choices than the parameter has room for");
}

TEST(ParameterCompileFailTest, ChoicesOfTwoTypesAreRejected) {
    verifies("SWR-PAR-004", Technique::kInterface, Polarity::kViolation);
    expect_explained("parameters", "choices_of_two_types", "the values of one_of() have one type");
}

TEST(ParameterCompileFailTest, ADefaultOutsideItsConstraintIsRefused) {
    verifies("SWR-PAR-004", Technique::kInterface, Polarity::kViolation);
    expect_explained("parameters", "default_outside_constraint", "require_default_within_constraint");
}

TEST(ParameterCompileFailTest, AParameterOfATypeThatHasNoConstraintIsRefused) {
    verifies("SWR-PAR-004", Technique::kInterface, Polarity::kViolation);
    expect_explained("parameters", "parameter_of_odd_type",
                     "a parameter is a bool, integer, float, double, enum");
}

TEST(ParameterCompileFailTest, AMemberThatIsNoParameterIsRefused) {
    verifies("SWR-PAR-006", Technique::kInterface, Polarity::kViolation);
    expect_refused("parameters", "parameter_is_no_parameter",
                   "ListNamesMembersOfItsComponent<parameter_is_no_parameter::Odd, "
                   "&parameter_is_no_parameter::Odd::number>");
}

TEST(ParameterCompileFailTest, AValueOutsideItsConstraintIsRefusedWithItsSetAndPlace) {
    verifies("SWR-PAR-022", Technique::kInterface, Polarity::kViolation);
    expect_refused("parameters", "set_value_outside_constraint",
                   "kValueOutsideConstraint, mamori::Name<'f', 'a', 's', 't'>, "
                   "mamori::rules::ParameterOf<Axis, &Axis::speed, 0>");
}

TEST(ParameterCompileFailTest, AParameterThatIsAssignedTwiceIsRefused) {
    verifies("SWR-PAR-006", Technique::kInterface, Polarity::kViolation);
    expect_refused("parameters", "set_assigns_twice",
                   "kParameterAssignedTwice, mamori::Name<'f', 'a', 's', 't'>, "
                   "mamori::rules::ParameterOf<Axis, &Axis::speed, 0>");
}

TEST(ParameterCompileFailTest, AParameterOfAComponentThatIsNotListedIsRefused) {
    verifies("SWR-PAR-006", Technique::kInterface, Polarity::kViolation);
    expect_refused("parameters", "set_of_unknown_parameter",
                   "kUnknownParameter, mamori::Name<'f', 'a', 's', 't'>, mamori::rules::Assignment<0>");
}

TEST(ParameterCompileFailTest, TwoSetsOfOneNameAreRefused) {
    verifies("SWR-PAR-006", Technique::kInterface, Polarity::kViolation);
    expect_refused("parameters", "set_named_twice",
                   "kSetNamedTwice, mamori::Name<'s', 'l', 'o', 'w'>, mamori::rules::Row<1>");
}

TEST(ParameterCompileFailTest, ASetWithoutANameIsRefused) {
    verifies("SWR-PAR-006", Technique::kInterface, Polarity::kViolation);
    for (const char* missing_or_empty : {"1", "2"}) {
        expect_refused("parameters", "set_without_name",
                       "kSetRowInvalid, mamori::Name<>, mamori::rules::Row<0>", missing_or_empty);
    }
}

TEST(ParameterCompileFailTest, AParameterThatItsComponentDoesNotListIsNamed) {
    verifies("SWR-PAR-020", Technique::kInterface, Polarity::kViolation);
    expect_refused("parameter_lists", "parameter_not_listed",
                   "ParameterIsListed<parameter_not_listed::Monitor, mamori::Name<'l', 'i', 'm', 'i', 't'>");
    expect_refused("parameter_lists", "no_parameter_listed",
                   "ParameterIsListed<no_parameter_listed::Monitor, mamori::Name<'g', 'a', 'i', 'n'>");
    expect_refused("parameter_lists", "parameter_list_private",
                   "ParameterIsListed<parameter_list_private::Monitor, mamori::Name<'g', 'a', 'i', 'n'>");
}

TEST(ParameterCompileFailTest, AListedParameterWithoutItsComponentIsRefused) {
    verifies("SWR-PAR-020", Technique::kInterface, Polarity::kViolation);
    expect_refused("parameter_lists", "parameter_not_owned",
                   "ParameterIsOwned<parameter_not_owned::Monitor, &parameter_not_owned::Monitor::gain, 0>");
    expect_refused("parameter_lists", "parameter_without_owner", "Parameter<double> gain{");
}

TEST(ParameterCompileFailTest, TwoParametersOfOneNameAndAParameterListedTwiceAreRefused) {
    verifies("SWR-PAR-021", Technique::kInterface, Polarity::kViolation);
    expect_refused("parameter_lists", "parameter_named_twice",
                   "ParameterHasANameOfItsOwn<parameter_named_twice::Monitor, "
                   "&parameter_named_twice::Monitor::right, 0>");
    expect_refused("parameter_lists", "parameter_listed_twice",
                   "ParameterHasANameOfItsOwn<parameter_listed_twice::Monitor, "
                   "&parameter_listed_twice::Monitor::gain, 0>");
}

TEST(ParameterCompileFailTest, AParameterWithoutANameIsRefused) {
    verifies("SWR-PAR-021", Technique::kBoundaryValues, Polarity::kViolation);
    for (const char* empty_or_missing : {"1", "2"}) {
        expect_refused("parameter_lists", "parameter_without_name",
                       "ParameterHasANameOfItsOwn<parameter_without_name::Monitor, "
                       "&parameter_without_name::Monitor::gain, 0>",
                       empty_or_missing);
    }
}

TEST(ParameterCompileFailTest, AListOfWhatIsNoParameterOfTheComponentIsRefused) {
    verifies("SWR-KRN-062", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused("parameter_lists", "parameter_of_other_component",
                   "ListNamesMembersOfItsComponent<parameter_of_other_component::Monitor, "
                   "&parameter_of_other_component::Other::gain>");
    const std::string list = "ListNamesMembersOfItsComponent<list_without_parameter::Monitor, ";
    expect_refused("parameter_lists", "list_without_parameter",
                   list + "&list_without_parameter::Monitor::speed>", "1");
    expect_refused("parameter_lists", "list_without_parameter", list, "2");
}

}  // namespace
}  // namespace mamori
