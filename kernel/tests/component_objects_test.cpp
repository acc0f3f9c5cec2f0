// SPDX-License-Identifier: Apache-2.0
// Goal: what the compiler cannot see of the objects of a table, initialize() rejects: names that are missing
// or occur twice, and ports and parameters that are not listed or belong to another component. Method:
// components that cannot be constants; each test breaks one thing of a table that is valid otherwise.
#include <gtest/gtest.h>

#include <vector>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using namespace literals;
using namespace verification;

class Axis final : public Component {
  public:
    Axis(const char* name, const char* second_name) noexcept : Component(name), second(*this, second_name) {}
    InPort<double, Need::kOptional> first{*this, "first"};
    OutPort<double> second;
    using Ports = mamori::Ports<&Axis::first, &Axis::second>;
};
/// Lists one of its three ports.
class Careless final : public Component {
  public:
    explicit Careless(const char* name) noexcept : Component(name) {}
    InPort<double, Need::kOptional> first{*this, "first"};
    OutPort<double> listed{*this, "listed"};
    InPort<double, Need::kOptional> third{*this, "third"};
    using Ports = mamori::Ports<&Careless::listed>;
};
/// Its port belongs to no component.
class Loose final : public Component {
  public:
    explicit Loose(const char* name) noexcept : Component(name) {}
    OutPort<double> speed{kNoOwner, "speed"};
    using Ports = mamori::Ports<&Loose::speed>;
};
/// Its port is constructed with `owner`.
class Confused final : public Component {
  public:
    Confused(const char* name, Component& owner) noexcept : Component(name), speed(owner, "speed") {}
    OutPort<double> speed;
    using Ports = mamori::Ports<&Confused::speed>;
};

class Tuned final : public Component {
  public:
    Tuned(const char* name, const char* second_name) noexcept
        : Component(name), second{*this, second_name, 1} {}
    Parameter<int> first{*this, "first", 1};
    Parameter<int> second;
    using Parameters = mamori::Parameters<&Tuned::first, &Tuned::second>;
};
/// Lists one of its two parameters.
class CarelessTuned final : public Component {
  public:
    explicit CarelessTuned(const char* name) noexcept : Component(name) {}
    Parameter<int> listed{*this, "listed", 1};
    Parameter<int> omitted{*this, "omitted", 1};
    using Parameters = mamori::Parameters<&CarelessTuned::listed>;
};
/// Its parameter belongs to no component.
class LooseTuned final : public Component {
  public:
    explicit LooseTuned(const char* name) noexcept : Component(name) {}
    Parameter<int> gain{kNoOwner, "gain", 1};
    using Parameters = mamori::Parameters<&LooseTuned::gain>;
};

/// Types of which the compiler makes no constant for its check, although traits say that it could.
class TakesAnything final : public Component {
  public:
    template <typename... Args>
    constexpr explicit TakesAnything(Args&&... arguments) noexcept : Component(arguments.name...) {}
};
struct Named {
    const char* name;
};
class TakesBool final : public Component {
  public:
    constexpr explicit TakesBool(bool is_left) noexcept : Component(is_left ? "left" : "right") {}
    OutPort<double> out{*this, "out"};
    using Ports = mamori::Ports<&TakesBool::out>;
};
constexpr Named kNamed{"named"};
TakesAnything g_anything{kNamed};
TakesBool g_left{true};

constexpr auto kOddConstructors =
    system(frame(1_ms), window("w", 0_us, 100_us, budget(50_us), run(g_anything, g_left)));
MAMORI_CHECK(kOddConstructors);

template <typename... Cs>
auto make_table(Cs&... components) {
    return system(frame(1_ms), window("w", 0_us, 100_us, budget(50_us), run(components...)));
}

template <typename Table>
std::vector<Finding> find_all(const Table& table) {
    std::vector<Finding> findings(check_all(make_view(table), {}));
    static_cast<void>(check_all(make_view(table), {findings.data(), findings.size()}));
    return findings;
}

/// @return component that initialize() rejects; kNoIndex: it rejects nothing.
template <typename Table>
std::size_t find_rejected(const Table& table) {
    ExecutiveFor executive{table};
    const Status result = executive.initialize();
    EXPECT_EQ(result == Status::kOk, executive.get_failed_component() == kNoIndex);
    if (result == Status::kOk) {
        EXPECT_EQ(executive.finalize(), Status::kOk);
    } else {
        EXPECT_EQ(result, Status::kBadParameter);
    }
    return executive.get_failed_component();
}

/// Expects exactly one finding, and that initialize() rejects `component`.
template <typename Table>
void expect_only(const Table& table, const Finding& expected, std::size_t component) {
    const std::vector<Finding> findings = find_all(table);

    ASSERT_EQ(findings.size(), 1U);
    EXPECT_EQ(findings[0].rule, expected.rule);
    EXPECT_EQ(findings[0].element, expected.element);
    EXPECT_EQ(findings[0].other, expected.other);
    EXPECT_EQ(find_rejected(table), component);
}

TEST(ComponentObjectsTest, EqualPortNamesOfTwoComponentsAreNoFinding) {
    verifies("SWR-KRN-046");
    Axis left{"left", "second"};
    Axis right{"right", "second"};
    const auto table = make_table(left, right);

    EXPECT_TRUE(find_all(table).empty());
    EXPECT_EQ(find_rejected(table), kNoIndex);
}

TEST(ComponentObjectsTest, AConstructorOfAnyArgumentIsCheckedAtInitialisationOnly) {
    verifies("SWR-KRN-045", Technique::kErrorGuessing);
    EXPECT_EQ(find_rejected(kOddConstructors), kNoIndex);
}

TEST(ComponentObjectsTest, TwoComponentsOfOneNameAreRejected) {
    verifies("SWR-KRN-046", Technique::kInterface, Polarity::kViolation);
    Axis first{"axis", "second"};
    Axis other{"other", "second"};
    Axis second{"axis", "second"};
    const auto table = make_table(first, other, second);

    expect_only(table, {Rule::kComponentNamedTwice, 2U, 0U}, 2U);
}

TEST(ComponentObjectsTest, TwoPortsOfOneNameAreRejected) {
    verifies("SWR-KRN-046", Technique::kInterface, Polarity::kViolation);
    Axis good{"good", "second"};
    Axis bad{"bad", "first"};
    const auto table = make_table(good, bad);

    expect_only(table, {Rule::kPortNamedTwice, 3U, 2U}, 1U);
}

TEST(ComponentObjectsTest, EachPortThatIsNotListedIsFound) {
    verifies("SWR-KRN-045", Technique::kInterface, Polarity::kViolation);
    Axis axis{"axis", "second"};
    Careless careless{"careless"};
    const auto table = make_table(axis, careless);
    const std::vector<Finding> findings = find_all(table);

    ASSERT_EQ(findings.size(), 2U);
    EXPECT_EQ(findings[0].rule, Rule::kPortNotListed);
    EXPECT_EQ(findings[0].element, 1U);
    EXPECT_EQ(findings[0].other, 0U) << "third: constructed last";
    EXPECT_EQ(findings[1].rule, Rule::kPortNotListed);
    EXPECT_EQ(findings[1].other, 2U) << "first: two ports are constructed after it";
    EXPECT_EQ(find_rejected(table), 1U);
}

TEST(ComponentObjectsTest, APortOfAnotherComponentIsFoundAtBoth) {
    verifies("SWR-KRN-045", Technique::kInterface, Polarity::kViolation);
    Axis axis{"axis", "second"};
    Confused confused{"confused", axis};
    const auto table = make_table(axis, confused);
    const std::vector<Finding> findings = find_all(table);

    ASSERT_EQ(findings.size(), 2U);
    EXPECT_EQ(findings[0].rule, Rule::kPortNotListed);
    EXPECT_EQ(findings[0].element, 0U);
    EXPECT_EQ(findings[1].rule, Rule::kPortNotOwned);
    EXPECT_EQ(findings[1].element, 2U);
    EXPECT_EQ(find_rejected(table), 0U);
}

TEST(ComponentObjectsTest, APortOfNoComponentIsFound) {
    verifies("SWR-KRN-045", Technique::kInterface, Polarity::kViolation);
    Axis axis{"axis", "second"};
    Loose loose{"loose"};
    const auto table = make_table(axis, loose);

    expect_only(table, {Rule::kPortNotOwned, 2U, 2U}, 1U);
}

TEST(ComponentObjectsTest, AComponentLeadsToItsPortsFromTheLastToTheFirst) {
    verifies("SWR-KRN-045");
    const Axis axis{"axis", "second"};
    const Member* port = axis.get_first(MemberKind::kPort);

    ASSERT_EQ(port, &axis.second);
    ASSERT_EQ(port->get_next(), &axis.first);
    EXPECT_EQ(port->get_next()->get_next(), nullptr);
    const OutPort<double> alone{kNoOwner, "alone"};
    EXPECT_EQ(alone.get_next(), nullptr);
    EXPECT_STREQ(alone.get_name(), "alone");
}

TEST(ComponentObjectsTest, AComponentWithoutANameIsRejected) {
    verifies("SWR-KRN-046", Technique::kBoundaryValues, Polarity::kViolation);
    Axis first{"first", "second"};
    Axis second{"second", "second"};
    for (const char* name : {static_cast<const char*>(nullptr), ""}) {
        Axis bad{name, "second"};
        const auto table = make_table(first, bad, second);

        expect_only(table, {Rule::kComponentNamedTwice, 1U, 1U}, 1U);
    }
}

TEST(ComponentObjectsTest, APortOrParameterWithoutANameIsRejected) {
    verifies("SWR-KRN-046", Technique::kBoundaryValues, Polarity::kViolation);
    Axis good{"good", "second"};
    Tuned tuned{"tuned", "second"};
    for (const char* name : {static_cast<const char*>(nullptr), ""}) {
        Axis axis{"axis", name};
        Tuned bad{"bad", name};

        expect_only(make_table(good, axis), {Rule::kPortNamedTwice, 3U, 3U}, 1U);
        expect_only(make_table(tuned, bad), {Rule::kParameterNamedTwice, 3U, 3U}, 1U);
    }
}

TEST(ComponentObjectsTest, EqualParameterNamesOfTwoComponentsAreNoFinding) {
    verifies("SWR-PAR-020");
    Tuned left{"left", "second"};
    Tuned right{"right", "second"};
    const auto table = make_table(left, right);

    EXPECT_TRUE(find_all(table).empty());
    EXPECT_EQ(find_rejected(table), kNoIndex);
}

TEST(ComponentObjectsTest, AParameterThatIsNotListedIsRejected) {
    verifies("SWR-PAR-020", Technique::kInterface, Polarity::kViolation);
    Tuned good{"good", "second"};
    CarelessTuned careless{"careless"};

    expect_only(make_table(good, careless), {Rule::kParameterNotListed, 1U, 0U}, 1U);
}

TEST(ComponentObjectsTest, AParameterOfNoComponentIsRejected) {
    verifies("SWR-PAR-020", Technique::kInterface, Polarity::kViolation);
    Tuned good{"good", "second"};
    LooseTuned loose{"loose"};

    expect_only(make_table(good, loose), {Rule::kParameterNotOwned, 2U, 2U}, 1U);
}

TEST(ComponentObjectsTest, TwoParametersOfOneNameAreRejected) {
    verifies("SWR-PAR-021", Technique::kInterface, Polarity::kViolation);
    Tuned good{"good", "second"};
    Tuned bad{"bad", "first"};

    expect_only(make_table(good, bad), {Rule::kParameterNamedTwice, 3U, 2U}, 1U);
}

TEST(ComponentObjectsTest, AComponentLeadsToItsParametersFromTheLastToTheFirst) {
    verifies("SWR-PAR-020");
    const Tuned tuned{"tuned", "second"};
    const Member* parameter = tuned.get_first(MemberKind::kParameter);

    ASSERT_EQ(parameter, &tuned.second);
    ASSERT_EQ(parameter->get_next(), &tuned.first);
    EXPECT_EQ(parameter->get_next()->get_next(), nullptr);
    EXPECT_EQ(tuned.get_first(MemberKind::kPort), nullptr);
}

}  // namespace
}  // namespace mamori
