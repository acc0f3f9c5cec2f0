// SPDX-License-Identifier: Apache-2.0
// Goal: the JSON of a table contains its modes, transitions, parameters and sets, for any rows. Method: a
// JSON library reads the text; the table of the manual is compared with the file that the tests of the
// command use; rows with invalid indices are written and described.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "mamori/table_dump/table_dump.hpp"
#include "mamori/trace/verifies.hpp"
#include "parts.hpp"
#include "robot_with_modes.hpp"

namespace mamori::table_dump {
namespace {

using nlohmann::json;
using robot::kSystem;
using namespace verification;

MAMORI_CHECK(kSystem);

constexpr std::size_t kNowhere = 99U;

json dump(const SystemView& view, const Names& names = {}) {
    std::ostringstream out;
    write_json(out, view, names);
    return json::parse(out.str());
}

json dump_rows(const std::remove_const_t<decltype(kSystem)>& table) {
    return dump(make_view(table));
}

TEST(WriteModesTest, TheTableOfTheManualEqualsTheTestFileOfTheCommand) {
    verifies("SWR-TAB-010", Technique::kBackToBack);
    const std::string path = ::testing::TempDir() + "robot_with_modes.json";

    ASSERT_EQ(robot::save_table(path), "");
    const json stored = json::parse(std::ifstream{MAMORI_ROBOT_TABLE});
    EXPECT_EQ(json::parse(std::ifstream{path}), stored);
    EXPECT_EQ(stored["findings"], json::array());
    std::filesystem::remove(path);
}

TEST(WriteModesTest, ModesContainComponentsSetsAndInitialAndSafeMode) {
    verifies("SWR-TAB-010");
    const json modes = dump(make_view(kSystem))["modes"];

    ASSERT_EQ(modes.size(), 4U);
    EXPECT_EQ(modes[0], json::parse(R"({"name": "idle", "safe": false, "initial": true, "components": [0, 1],
        "set": null})"));
    EXPECT_EQ(modes[1], json::parse(R"({"name": "work", "safe": false, "initial": false,
        "components": [0, 1, 2, 4], "set": {"index": 0, "name": "fast"}})"));
    EXPECT_EQ(modes[3]["safe"], true);
}

TEST(WriteModesTest, TransitionsHaveTheGivenNameOfTheirEvent) {
    verifies("SWR-TAB-010");
    const json transitions = dump(make_view(kSystem), {{}, {}, {"Start"}})["transitions"];

    ASSERT_EQ(transitions.size(), 4U);
    EXPECT_EQ(transitions[0], json::parse(R"({"from": {"index": 0, "name": "idle"}, "event": 0,
        "event_name": "Start", "to": {"index": 1, "name": "work"}})"));
    EXPECT_EQ(transitions[3]["event"], 2);
    EXPECT_EQ(transitions[3]["event_name"], "2");
}

TEST(WriteModesTest, ConnectionsContainTheirDeclaredAndEffectiveModes) {
    verifies("SWR-TAB-010");
    const json connections = dump(make_view(kSystem))["connections"];

    EXPECT_TRUE(connections[0]["only_in"].is_null());
    EXPECT_EQ(connections[0]["modes"], json::parse("[0, 1, 2, 3]"));
    EXPECT_EQ(connections[3]["only_in"], json::parse("[1]"));
    EXPECT_EQ(connections[3]["modes"], json::parse("[1]"));
    EXPECT_TRUE(connections[4]["only_in"].is_null());
    EXPECT_EQ(connections[4]["modes"], json::parse("[2]"));
}

TEST(WriteModesTest, ParametersHaveTheirOwnerTypeConstraintAndActiveValue) {
    verifies("SWR-TAB-010");
    const json document = dump(make_view(kSystem));

    EXPECT_EQ(document["parameters"], json::parse(R"([
        {"owner": {"index": 1, "name": "monitor"}, "name": "limit_rad_s", "type": "real",
         "constraint": "0.1<=x<=3", "values": [1.0]},
        {"owner": {"index": 4, "name": "drive"}, "name": "gain", "type": "whole", "constraint": "1<=x<=40",
         "values": [10]}])"));
    EXPECT_EQ(document["configuration_sets"][1], json::parse(R"({"name": "slow", "assignments": [
        {"parameter": {"index": 0, "name": "limit_rad_s"}, "values": [0.25]},
        {"parameter": {"index": 1, "name": "gain"}, "values": [5]}]})"));
}

class Limited final : public Component {
  public:
    constexpr Limited() noexcept : Component("limited") {}
    Parameter<std::array<double, 6U>> each{*this,         "each",      {1.0, 1.0, 1.0, 1.0, 0.0, 9.5},
                                           at_least(0.1), above(-2.5), at_most(1.0e300),
                                           below(3.0),    any_value(), between(above(-0.5), below(1.0e1))};
    Parameter<std::array<double, 2U>> every{*this, "every", {1.0, 2.0}, between(above(0.0), at_most(2.0))};
    Parameter<std::int64_t, 3U> choices{*this, "choices", 7, one_of(-7, 7, 9)};
    Parameter<std::uint8_t> value{*this, "value", 255U, one_of(255)};
    Parameter<std::array<int, 2U>> last{*this, "last", {1, 2}, any_value(), one_of(2, 3)};
    using Parameters = mamori::Parameters<&Limited::each, &Limited::every, &Limited::choices, &Limited::value,
                                          &Limited::last>;
};

Limited g_limited;

TEST(WriteModesTest, ConstraintsAreWrittenInTheNotationOfTheRtcProfile) {
    verifies("SWR-TAB-010", Technique::kEquivalenceClasses);
    constexpr auto kTable = system(frame(1_ms), window("w", 0_us, 1_ms, budget(1_ms), run(g_limited)));
    const json parameters = dump(make_view(kTable))["parameters"];
    std::vector<std::string> constraints;
    for (const json& parameter : parameters) {
        constraints.push_back(parameter["constraint"]);
    }

    EXPECT_EQ(constraints, (std::vector<std::string>{"x>=0.1,x>-2.5,x<=1e+300,x<3,,-0.5<x<10", "0<x<=2",
                                                     "(-7,7,9)", "255", ",(2,3)"}));
}

class Misdeclared final : public Component {
  public:
    explicit Misdeclared(double lower) noexcept
        : Component("misdeclared"), limit{*this, "limit", 1.0, between(lower, 2.0)} {}
    Parameter<double> limit;
    using Parameters = mamori::Parameters<&Misdeclared::limit>;
};

TEST(WriteModesTest, TheConstraintOfAnInvalidParameterIsATextThatTheReaderRejects) {
    verifies("SWR-PAR-011", Technique::kInterface, Polarity::kViolation);
    Misdeclared component{3.0};
    const auto table = system(frame(1_ms), window("w", 0_us, 1_ms, budget(1_ms), run(component)));

    EXPECT_EQ(dump(make_view(table))["parameters"][0]["constraint"], "invalid");
}

enum class Grip { kOpen, kClosed };

class Tuned final : public Component {
  public:
    constexpr Tuned() noexcept : Component("tuned") {}
    Parameter<std::array<double, 3U>> gains{*this, "gains", {0.1, -2.5, 1.0e300}};
    Parameter<std::int64_t> low{*this, "low", std::numeric_limits<std::int64_t>::min()};
    Parameter<std::uint64_t> high{*this, "high", std::numeric_limits<std::uint64_t>::max()};
    Parameter<bool> is_on{*this, "is_on", true};
    Parameter<Grip> grip{*this, "grip", Grip::kClosed};
    using Parameters =
        mamori::Parameters<&Tuned::gains, &Tuned::low, &Tuned::high, &Tuned::is_on, &Tuned::grip>;
};

Tuned g_tuned;

TEST(WriteModesTest, ValuesOfEveryTypeKeepAllTheirDigits) {
    verifies("SWR-TAB-010", Technique::kBoundaryValues);
    constexpr auto kTable = system(frame(1_ms), window("w", 0_us, 1_ms, budget(1_ms), run(g_tuned)));
    std::ostringstream out;
    write_json(out, make_view(kTable));

    const std::string text = out.str();
    for (const char* values : {"\"type\": \"real\", \"constraint\": \"\", \"values\": [0.1, -2.5, 1e+300]",
                               "\"values\": [-9223372036854775808]", "\"values\": [18446744073709551615]"}) {
        EXPECT_NE(text.find(values), std::string::npos) << values << " in " << text;
    }
    const json parameters = json::parse(text)["parameters"];
    EXPECT_EQ(parameters[3]["values"], json::parse("[1]"));
    EXPECT_EQ(parameters[4]["type"], "whole");
}

TEST(WriteModesTest, ATableWithoutModesHasEmptyLists) {
    verifies("SWR-TAB-010", Technique::kBoundaryValues);
    static testing_support::Source source{"source"};
    constexpr auto kTable = system(frame(1_ms), window("w", 0_us, 1_ms, budget(1_ms), run(source)));
    const json document = dump(make_view(kTable));

    for (const char* key : {"modes", "transitions", "parameters", "configuration_sets", "findings"}) {
        EXPECT_EQ(document[key], json::array()) << key;
    }
}

TEST(WriteModesTest, ModesWithInvalidIndicesAreWrittenWithTheirFindings) {
    verifies("SWR-TAB-013", Technique::kErrorGuessing, Polarity::kViolation);
    auto table = kSystem;
    table.modes.modes[1].set_name = "fsat";
    table.modes.modes[1].set = kNowhere;
    table.modes.modes[2].set_name = nullptr;
    table.modes.members[0].component = nullptr;
    table.modes.members[0].index = kNowhere;
    table.modes.transitions[0] = {nullptr, nullptr, 7U, kNowhere, kNoIndex};
    table.modes.transitions[1].source_name = nullptr;
    table.modes.connection_modes[0] = {nullptr, 3U, kNowhere};

    const json document = dump_rows(table);
    EXPECT_EQ(document["modes"][0]["components"], json::parse("[0, 1, null]"));
    EXPECT_EQ(document["modes"][1]["set"], json::parse(R"({"index": null, "name": "fsat"})"));
    EXPECT_EQ(document["modes"][2]["set"], json::parse(R"({"index": 1, "name": "slow"})"));
    EXPECT_EQ(document["transitions"][0], json::parse(R"({"from": {"index": null, "name": "?"}, "event": 7,
        "event_name": "7", "to": {"index": null, "name": "?"}})"));
    EXPECT_EQ(document["transitions"][1]["from"], json::parse(R"({"index": 0, "name": "idle"})"));
    EXPECT_EQ(document["connections"][3]["only_in"], json::parse("[null]"));
    EXPECT_GE(document["findings"].size(), 4U);
}

TEST(WriteModesTest, AModeWithoutANameOrBeyondTheMaskIsWritten) {
    verifies("SWR-TAB-013", Technique::kBoundaryValues, Polarity::kViolation);
    std::array<SystemModeRow, kSystemModeMax + 1U> many{};
    SystemView view = make_view(kSystem);
    view.modes.modes = many;
    const json document = dump(view);

    ASSERT_EQ(document["modes"].size(), kSystemModeMax + 1U);
    EXPECT_EQ(document["modes"][0]["name"], "?");
    EXPECT_EQ(document["modes"][kSystemModeMax]["components"], json::array());
    EXPECT_NE(document["findings"].dump().find("row 32 is invalid; rule: a mode has a name"),
              std::string::npos);
}

TEST(WriteModesTest, ParametersWithInvalidIndicesAreWritten) {
    verifies("SWR-TAB-013", Technique::kErrorGuessing, Polarity::kViolation);
    auto table = kSystem;
    table.configuration.parameters[0] = {};
    table.configuration.parameters[1].owner = &g_tuned;

    const json document = dump_rows(table);
    EXPECT_EQ(document["parameters"][0], json::parse(R"({"owner": {"index": null, "name": "?"}, "name": "?",
        "type": null, "constraint": "", "values": null})"));
    EXPECT_EQ(document["parameters"][1]["owner"], json::parse(R"({"index": null, "name": "tuned"})"));
    const std::string rule = get_sentence(Rule::kParameterRowInvalid);
    EXPECT_EQ(document["findings"], json({"parameter '?.?': row 0 is invalid; rule: " + rule}));
}

TEST(WriteModesTest, SetsWithInvalidIndicesAreWrittenAndNamed) {
    verifies("SWR-TAB-013", Technique::kErrorGuessing, Polarity::kViolation);
    auto table = kSystem;
    table.configuration.sets[0] = {nullptr, 1U, std::numeric_limits<std::size_t>::max()};
    table.configuration.assignments[2].parameter = nullptr;
    table.configuration.assignments[3].first_value = kNowhere;

    const json document = dump_rows(table);
    EXPECT_EQ(document["configuration_sets"][0], json::parse(R"({"name": "?", "assignments": null})"));
    EXPECT_EQ(document["configuration_sets"][1]["assignments"],
              json::parse(R"([{"parameter": {"index": null, "name": "?"}, "values": [0.25]},
                              {"parameter": {"index": 1, "name": "gain"}, "values": null}])"));
    const std::string invalid = " is invalid, with assignment ";
    const std::string rule = std::string("; rule: ") + get_sentence(Rule::kSetRowInvalid);
    EXPECT_EQ(document["findings"], (json{"configuration set '?': row 0" + invalid + "0" + rule,
                                          "configuration set 'slow': row 1" + invalid + "0" + rule,
                                          "configuration set 'slow': row 1" + invalid + "1" + rule}));
    EXPECT_EQ(describe({Rule::kConfigurationRefused, 0U, 0U}, make_view(table)).substr(0U, 39U),
              "configuration set '?' cannot be checked");
}

TEST(WriteModesTest, InvalidRowsAreReportedFirstAndTogether) {
    verifies("SWR-TAB-013", Technique::kFaultInjection, Polarity::kViolation);
    auto table = kSystem;
    table.configuration.sets[0].name = nullptr;
    table.modes.modes[0].name = nullptr;
    table.modes.modes[3].is_safe = false;  // rules of modes are checked only if their rows are valid

    const std::vector<std::string> sentences = describe_all(make_view(table));
    ASSERT_EQ(sentences.size(), 2U);
    EXPECT_EQ(sentences[0].substr(0U, 15U), "mode '?': row 0");
    EXPECT_EQ(sentences[1].substr(0U, 28U), "configuration set '?': row 0");
}

}  // namespace
}  // namespace mamori::table_dump
