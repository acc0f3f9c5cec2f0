// SPDX-License-Identifier: Apache-2.0
// Goal: an invalid declaration of a parameter that the compiler did not check ends in a refusal with the
// component, not in a trap before main(). Method: components that are made at run time, with a valid and with
// each kind of invalid declaration, in a table on two cores.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <memory>
#include <utility>

#include "mamori/kernel/parameter/configuration_admin.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using namespace verification;
using literals::operator""_us;
using literals::operator""_ms;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class Valve final : public Component {
  public:
    Valve(const char* name, double initial, double lower, double upper) noexcept
        : Component(name), opening{*this, "opening", initial, between(lower, upper)} {}

    Parameter<double> opening;
    Parameter<bool> is_manual{*this, "is_manual", false};
    using Parameters = mamori::Parameters<&Valve::is_manual, &Valve::opening>;
    bool was_initialized{false};

    Status on_initialize() noexcept override {
        was_initialized = true;
        return Status::kOk;
    }
};

/// Its ports have the same name.
class TwoOutputs final : public Component {
  public:
    TwoOutputs() noexcept : Component("two_outputs") {}
    OutPort<int> one{*this, "out"};
    OutPort<int> other{*this, "out"};
    using Ports = mamori::Ports<&TwoOutputs::one, &TwoOutputs::other>;
};

auto make_table(Valve& a, Valve& b, Valve& c) {
    return system(frame(1_ms), window("a", 0_us, 300_us, budget(300_us), run(a)),
                  window("b", 300_us, 300_us, budget(300_us), run(b)),
                  window("c", 0_us, 300_us, core(1), budget(300_us), run(c)));
}

/// Three components in three windows on two cores; `opening` of the second one is as given.
struct Plant {
    Valve first{"first", 1.0, 0.0, 2.0};
    Valve second;
    Valve third{"third", 1.0, 0.0, 2.0};

    using Table =
        decltype(make_table(std::declval<Valve&>(), std::declval<Valve&>(), std::declval<Valve&>()));

    Table table;
    std::array<ExecutiveFor<Table>, 2U> cores{{ExecutiveFor<Table>{table}, ExecutiveFor<Table>{table, 1U}}};

    Plant(double initial, double lower, double upper) noexcept
        : second("second", initial, lower, upper), table(make_table(first, second, third)) {}
};

struct Declaration {
    double initial;
    double lower;
    double upper;
};
const std::array kInvalid{
    Declaration{2.1, 1.0, 2.0},
    Declaration{0.9, 1.0, 2.0},
    Declaration{kNan, 1.0, 2.0},
    Declaration{2.0, 3.0, 1.0},
    Declaration{1.0, kNan, 2.0},
    Declaration{1.0, 0.0, kNan},
    Declaration{1.0, 0.0, std::numeric_limits<double>::infinity()},
};

TEST(InvalidParameterTest, ATableWithAnInvalidParameterIsRefusedOnEachCoreWithTheComponent) {
    verifies("SWR-PAR-011", Technique::kEquivalenceClasses, Polarity::kViolation);
    for (const Declaration& declaration : kInvalid) {
        const auto plant = std::make_unique<Plant>(declaration.initial, declaration.lower, declaration.upper);
        for (Executive& core : plant->cores) {
            EXPECT_EQ(core.initialize(), Status::kBadParameter) << declaration.lower;
            EXPECT_EQ(core.get_failed_component(), 1U);
            EXPECT_EQ(core.start(), Status::kPreconditionNotMet);
        }
        EXPECT_FALSE(plant->first.was_initialized || plant->second.was_initialized)
            << "refused before any action";
    }
}

TEST(InvalidParameterTest, AnInvalidParameterOfTheFirstComponentIsFound) {
    verifies("SWR-PAR-011", Technique::kBoundaryValues, Polarity::kViolation);
    Valve first{"first", 3.0, 0.0, 2.0};
    Valve second{"second", 1.0, 0.0, 2.0};
    Valve third{"third", 1.0, 0.0, 2.0};
    auto table = make_table(first, second, third);
    ExecutiveFor<decltype(table)> core{table};

    EXPECT_EQ(core.initialize(), Status::kBadParameter);
    EXPECT_EQ(core.get_failed_component(), 0U);
}

TEST(InvalidParameterTest, ADuplicatePortNameOfTheFirstComponentIsReportedBesideParameters) {
    verifies("SWR-KRN-046", Technique::kBoundaryValues, Polarity::kViolation);
    TwoOutputs first;
    Valve second{"second", 1.0, 0.0, 2.0};
    auto table = system(frame(1_ms), window("a", 0_us, 300_us, budget(300_us), run(first)),
                        window("b", 300_us, 300_us, budget(300_us), run(second)));
    ExecutiveFor<decltype(table)> core{table};

    EXPECT_EQ(core.initialize(), Status::kBadParameter);
    EXPECT_EQ(core.get_failed_component(), 0U);
}

TEST(InvalidParameterTest, ATableWhoseDefaultsAreAtTheirLimitsIsInitialised) {
    verifies("SWR-PAR-011", Technique::kBoundaryValues);
    for (const Declaration& declaration :
         {Declaration{1.0, 1.0, 2.0}, Declaration{2.0, 1.0, 2.0}, Declaration{1.0, 1.0, 1.0}}) {
        const auto plant = std::make_unique<Plant>(declaration.initial, declaration.lower, declaration.upper);
        for (Executive& core : plant->cores) {
            EXPECT_EQ(core.initialize(), Status::kOk);
            EXPECT_EQ(core.get_failed_component(), kNoIndex);
        }
        EXPECT_TRUE(plant->second.opening.is_valid());
        EXPECT_EQ(plant->second.opening.request(declaration.initial), Status::kOk);
    }
}

TEST(InvalidParameterTest, AnInvalidParameterRefusesEveryValueInEachWayIn) {
    verifies("SWR-PAR-011", Technique::kErrorGuessing, Polarity::kViolation);
    for (const Declaration& declaration : kInvalid) {
        Valve valve{"valve", declaration.initial, declaration.lower, declaration.upper};
        ParameterBase& sut = valve.opening;

        EXPECT_FALSE(sut.is_valid());
        EXPECT_TRUE(valve.is_manual.is_valid());
        for (const double value : {0.0, 1.0, 1.5, 2.0}) {
            EXPECT_EQ(sut.check(std::array{to_scalar(value)}), Status::kBadParameter);
            EXPECT_EQ(sut.request_scalars(std::array{to_scalar(value)}), Status::kBadParameter);
            EXPECT_EQ(sut.activate(std::array{to_scalar(value)}), Status::kBadParameter);
            EXPECT_EQ(valve.opening.request(value), Status::kBadParameter);
        }
        EXPECT_FALSE(sut.commit());
        EXPECT_EQ(sut.get_range(0U).get_status(), Status::kBadParameter);
    }
}

TEST(InvalidParameterTest, LimitsOfIntegersAndElementsOfArraysCountAsWell) {
    verifies("SWR-PAR-011", Technique::kEquivalenceClasses, Polarity::kViolation);
    using Pair = std::array<int, 2U>;

    EXPECT_FALSE((Parameter<int>{kNoOwner, "p", 1, at_most(2147483648LL)}.is_valid()));
    EXPECT_FALSE((Parameter<Pair>{kNoOwner, "p", {1, 1}, at_least(0), between(2, 3)}.is_valid()));
    EXPECT_FALSE((Parameter<Pair>{kNoOwner, "p", {1, 1}, between(3, 2), at_least(0)}.is_valid()));
    EXPECT_TRUE((Parameter<Pair>{kNoOwner, "p", {1, 2}, at_least(0), between(2, 3)}.is_valid()));
}

}  // namespace
}  // namespace mamori
