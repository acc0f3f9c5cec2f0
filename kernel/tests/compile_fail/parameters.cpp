// SPDX-License-Identifier: Apache-2.0
// What the compiler rejects: parameters, constraints and configuration sets.
// Each namespace compiles, and does not with its MAMORI_BREAK_<NAME>.
#include "mamori/kernel/parameter/parameter.hpp"
#include "parameter_parts.hpp"

// A constraint excludes every value.
namespace constraint_without_value {
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
#ifdef MAMORI_BREAK_CONSTRAINT_WITHOUT_VALUE
    mamori::Parameter<double> limit{*this, "limit", 1.0, mamori::between(3.0, 0.1)};
#else
    mamori::Parameter<double> limit{*this, "limit", 1.0, mamori::between(0.1, 3.0)};
#endif
};
MAMORI_CONSTINIT Monitor g_monitor;
}  // namespace constraint_without_value

// A limit is one more than the type of the parameter can hold.
namespace limit_not_in_type {
#ifdef MAMORI_BREAK_LIMIT_NOT_IN_TYPE
MAMORI_CONSTINIT mamori::Parameter<std::uint8_t> g_retries{mamori::kNoOwner, "retries", 3U,
                                                           mamori::at_most(256)};
#else
MAMORI_CONSTINIT mamori::Parameter<std::uint8_t> g_retries{mamori::kNoOwner, "retries", 3U,
                                                           mamori::at_most(255)};
#endif
}  // namespace limit_not_in_type

// A limit of a float is a double.
namespace limit_of_other_type {
#ifdef MAMORI_BREAK_LIMIT_OF_OTHER_TYPE
mamori::Parameter<float> g_gain{mamori::kNoOwner, "gain", 1.0F, mamori::at_least(0.1)};
#else
mamori::Parameter<float> g_gain{mamori::kNoOwner, "gain", 1.0F, mamori::at_least(0.1F)};
#endif
}  // namespace limit_of_other_type

// A constraint is a text in the notation of the RTC Profile.
namespace constraint_as_text {
#ifdef MAMORI_BREAK_CONSTRAINT_AS_TEXT
mamori::Parameter<double> g_limit{mamori::kNoOwner, "limit", 1.0, "0.1<=x<=3.0"};
#else
mamori::Parameter<double> g_limit{mamori::kNoOwner, "limit", 1.0, mamori::between(0.1, 3.0)};
#endif
}  // namespace constraint_as_text

// Two constraints for three elements.
namespace constraint_count {
using Gains = std::array<int, 3U>;
#ifdef MAMORI_BREAK_CONSTRAINT_COUNT
mamori::Parameter<Gains> g_gains{mamori::kNoOwner, "gains", Gains{1, 1, 1}, mamori::above(0),
                                 mamori::above(0)};
#else
mamori::Parameter<Gains> g_gains{mamori::kNoOwner, "gains", Gains{1, 1, 1}, mamori::above(0)};
#endif
}  // namespace constraint_count

// A constraint has one choice more than the parameter has room for.
namespace constraint_without_room {
constexpr auto kRates = mamori::one_of(2400, 4800, 9600, 19200, 38400);
#ifdef MAMORI_BREAK_CONSTRAINT_WITHOUT_ROOM
mamori::Parameter<int> g_baud{mamori::kNoOwner, "baud", 9600, kRates};
#else
mamori::Parameter<int, 5U> g_baud{mamori::kNoOwner, "baud", 9600, kRates};
#endif
}  // namespace constraint_without_room

// A list of choices has values of two types.
namespace choices_of_two_types {
#ifdef MAMORI_BREAK_CHOICES_OF_TWO_TYPES
constexpr auto kChoices = mamori::one_of(1, 2U);
#else
constexpr auto kChoices = mamori::one_of(1, 2);
#endif
mamori::Parameter<int> g_step{mamori::kNoOwner, "step", 1, kChoices};
}  // namespace choices_of_two_types

// A default lies below the lower limit.
namespace default_outside_constraint {
#ifdef MAMORI_BREAK_DEFAULT_OUTSIDE_CONSTRAINT
constexpr double kDefault = 0.09;
#else
constexpr double kDefault = 0.1;
#endif
MAMORI_CONSTINIT mamori::Parameter<double> g_limit{mamori::kNoOwner, "limit", kDefault,
                                                   mamori::between(0.1, 3.0)};
}  // namespace default_outside_constraint

// A parameter is a pointer.
namespace parameter_of_odd_type {
#ifdef MAMORI_BREAK_PARAMETER_OF_ODD_TYPE
mamori::Parameter<const char*> g_name{mamori::kNoOwner, "name", "value"};
#else
mamori::Parameter<int> g_name{mamori::kNoOwner, "name", 1};
#endif
}  // namespace parameter_of_odd_type

// A component lists a member that is no parameter.
namespace parameter_is_no_parameter {
class Odd final : public mamori::Component {
  public:
    constexpr Odd() noexcept : Component("odd") {}
    mamori::Parameter<double> real{*this, "real", 0.0};
    double number{0.0};
#ifdef MAMORI_BREAK_PARAMETER_IS_NO_PARAMETER
    using Parameters = mamori::Parameters<&Odd::real, &Odd::number>;
#else
    using Parameters = mamori::Parameters<&Odd::real>;
#endif
};
Odd g_odd;
[[maybe_unused]] constexpr auto kList = mamori::parameters_of(g_odd);
}  // namespace parameter_is_no_parameter

// The second value of the second set is beyond its limit.
namespace set_value_outside_constraint {
#ifdef MAMORI_BREAK_SET_VALUE_OUTSIDE_CONSTRAINT
constexpr double kSpeed = 3.1;
#else
constexpr double kSpeed = 3.0;
#endif
constexpr auto kConfiguration = mamori::configuration(
    mamori::parameters_of(g_axis), mamori::configuration_set("normal"),
    mamori::configuration_set("fast", mamori::assign(g_axis.gain, 1), mamori::assign(g_axis.speed, kSpeed)));
MAMORI_CHECK_CONFIGURATION(kConfiguration);
}  // namespace set_value_outside_constraint

// A set gives one parameter two values.
namespace set_assigns_twice {
constexpr auto kConfiguration = mamori::configuration(
    mamori::parameters_of(g_axis), mamori::configuration_set("fast", mamori::assign(g_axis.speed, 1.0)
#ifdef MAMORI_BREAK_SET_ASSIGNS_TWICE
                                                                         ,
                                                             mamori::assign(g_axis.speed, 2.0)
#endif
                                                                 ));
MAMORI_CHECK_CONFIGURATION(kConfiguration);
}  // namespace set_assigns_twice

// A set assigns a parameter of a component that the configuration does not list.
namespace set_of_unknown_parameter {
constexpr auto kConfiguration = mamori::configuration(
#ifdef MAMORI_BREAK_SET_OF_UNKNOWN_PARAMETER
    mamori::parameters_of(g_axis),
#else
    mamori::parameters_of(g_axis, g_second_axis),
#endif
    mamori::configuration_set("fast", mamori::assign(g_second_axis.speed, 1.0)));
MAMORI_CHECK_CONFIGURATION(kConfiguration);
}  // namespace set_of_unknown_parameter

// Two sets have one name.
namespace set_named_twice {
#ifdef MAMORI_BREAK_SET_NAMED_TWICE
constexpr const char* kName = "slow";
#else
constexpr const char* kName = "fast";
#endif
constexpr auto kConfiguration = mamori::configuration(
    mamori::parameters_of(g_axis), mamori::configuration_set("slow"), mamori::configuration_set(kName));
MAMORI_CHECK_CONFIGURATION(kConfiguration);
}  // namespace set_named_twice

// A configuration set without a name: nullptr (1) or empty (2).
namespace set_without_name {
#ifdef MAMORI_BREAK_SET_WITHOUT_NAME
constexpr const char* kName = MAMORI_BREAK_SET_WITHOUT_NAME == 1 ? nullptr : "";
#else
constexpr const char* kName = "slow";
#endif
constexpr auto kConfiguration =
    mamori::configuration(mamori::parameters_of(g_axis), mamori::configuration_set(kName));
MAMORI_CHECK_CONFIGURATION(kConfiguration);
}  // namespace set_without_name
