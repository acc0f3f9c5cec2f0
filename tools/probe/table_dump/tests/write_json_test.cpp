// SPDX-License-Identifier: Apache-2.0
// Goal: the JSON of a table has the content of the table, for any rows, and its file is written atomically.
// Method: a JSON library reads the text, and the test compares each value.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "mamori/table_dump/table_dump.hpp"
#include "mamori/trace/verifies.hpp"
#include "parts.hpp"

namespace mamori::table_dump {
namespace {

using nlohmann::json;
using namespace testing_support;
using namespace verification;

Source g_encoder{"encoder"};
Filter g_monitor{"monitor"};
Filter g_reporter{"reporter"};
Filter g_planner{"planner"};
Logger g_logger{"logger"};
Crossing<double> g_crossing;

constexpr auto kSystem = system(frame(10_ms),
                                window("sense", 0_us, 200_us, every(1_ms), rate(1000_hz, 500_hz),
                                       budget(150_us), run(g_encoder, worst_case(g_monitor, 40_us))),
                                window("report", 300_us, 100_us, budget(50_us), run(g_reporter)),
                                window("plan", 1200_us, 8_ms, core(1U), partition("open"), budget(7_ms),
                                       event_driven(3U), run(g_planner, g_logger)),
                                connect(g_encoder.out, g_monitor.in, fresh_within(2_ms)),
                                connect(g_monitor.out, g_planner.in, through(g_crossing), any_age()),
                                connect(g_monitor.out, g_logger.in, any_age()),
                                connect(g_monitor.out, g_monitor.hint, any_age(), delayed_by_a_frame()),
                                connect(g_planner.out, g_planner.hint, any_age(), delayed_by_a_frame()),
                                connect(g_reporter.out, g_reporter.hint, any_age(), delayed_by_a_frame()),
                                connect(g_monitor.out, g_reporter.in, any_age()),
                                faults<Fault::kOverspeed, Fault::kTrackingLost>(),
                                react(Fault::kOverspeed, Reaction::kSs1, within(20_ms)),
                                react(Fault::kTrackingLost, Reaction::kSto, within(5_ms)));

json dump(const SystemView& view, const Names& names = {}) {
    std::ostringstream out;
    write_json(out, view, names);
    return json::parse(out.str());
}

TEST(WriteJsonTest, WindowsContainTimesRatesAndIndices) {
    verifies("SWR-TAB-001");
    const json table = dump(make_view(kSystem));

    EXPECT_EQ(table["schema"], "mamori.table/5");
    EXPECT_EQ(table["frame_ns"], 10'000'000);
    EXPECT_EQ(table["abort_policy"], "spec_only");
    ASSERT_EQ(table["windows"].size(), 3U);
    EXPECT_EQ(table["windows"][0],
              json::parse(R"({"name": "sense", "core": 0, "background_of": null, "partition": "",
        "kind": "periodic", "offset_ns": 0, "length_ns": 200000, "period_ns": 1000000, "budget_ns": 150000, "rate_hz": 1000.0,
        "slower_periods_ns": [2000000], "events_per_cycle": null})"));
    EXPECT_EQ(table["windows"][2]["partition"], "open");
    EXPECT_EQ(table["windows"][2]["kind"], "event_driven");
    EXPECT_EQ(table["windows"][2]["core"], 1);
    EXPECT_EQ(table["windows"][2]["events_per_cycle"], 3);
    EXPECT_TRUE(table["windows"][2]["rate_hz"].is_null());
}

TEST(WriteJsonTest, ABackgroundWindowContainsItsCoreAndItsProcessorTime) {
    verifies("SWR-TAB-001");
    const auto system_with_background =
        system(frame(10_ms), window("loop", 0_ms, 1_ms, core(1), budget(1_ms), run(g_encoder)),
               window("plan", 0_ms, 9_ms, core(1), background(), budget(3_ms), run(g_planner)));

    const json table = dump(make_view(system_with_background));

    EXPECT_TRUE(table["windows"][0]["background_of"].is_null());
    EXPECT_EQ(table["windows"][1]["background_of"], 1);
    EXPECT_EQ(table["windows"][1]["core"], 2);
    EXPECT_EQ(table["windows"][1]["budget_ns"], 3'000'000);
}

Status do_nothing(ContextHandle) noexcept {
    return Status::kOk;
}

TEST(WriteJsonTest, ASystemWindowIsMarkedAndContainsItsFunction) {
    verifies("SWR-KRN-096");
    SystemFunction<&do_nothing> function{"send"};
    const auto system_with_function =
        system(frame(10_ms), system_window("notice", 1_ms, 2_ms, budget(1_ms), function));

    const json table = dump(make_view(system_with_function));

    EXPECT_EQ(table["windows"][0]["name"], "notice");
    EXPECT_EQ(table["windows"][0]["kind"], "system");
    EXPECT_EQ(table["components"][0]["name"], "send");
    EXPECT_EQ(table["components"][0]["window"], 0);
    EXPECT_TRUE(table["findings"].empty());
}

TEST(WriteJsonTest, ComponentsContainTheirWindowWorstCaseAndPorts) {
    verifies("SWR-TAB-001");
    const json table = dump(make_view(kSystem));

    ASSERT_EQ(table["components"].size(), 5U);
    EXPECT_EQ(table["components"][1],
              json::parse(R"({"name": "monitor", "window": 0, "worst_case_ns": 40000, "ports": [
        {"name": "in", "direction": "in", "mandatory": true, "payload_bytes": 8},
        {"name": "hint", "direction": "in", "mandatory": false, "payload_bytes": 8},
        {"name": "out", "direction": "out", "mandatory": false, "payload_bytes": 8}]})"));
    EXPECT_TRUE(table["components"][0]["worst_case_ns"].is_null());
}

TEST(WriteJsonTest, ASizeOf64KiBOrMoreIsNull) {
    verifies("SWR-CIF-012", Technique::kBoundaryValues);
    auto table = kSystem;
    table.ports[0].payload_bytes = 0U;
    table.ports[1].payload_bytes = 0xFFFFU;

    const json components = dump(make_view(table))["components"];

    EXPECT_TRUE(components[0]["ports"][0]["payload_bytes"].is_null());
    EXPECT_EQ(components[1]["ports"][0]["payload_bytes"], 0xFFFF);
}

TEST(WriteJsonTest, ConnectionsStateWhenTheirValueArrives) {
    verifies("SWR-TAB-001");
    const json table = dump(make_view(kSystem));

    EXPECT_EQ(table["connections"][0], json::parse(R"({"from": {"component": 0, "port": "out"},
        "to": {"component": 1, "port": "in"}, "way": "same_window", "fresh_within_ns": 2000000,
        "only_in": null, "modes": []})"));
    std::vector<std::string> ways;
    for (const json& row : table["connections"]) {
        ways.push_back(row["way"]);
    }
    EXPECT_EQ(ways, (std::vector<std::string>{"same_window", "crossing", "queue", "later_window",
                                              "next_frame", "next_frame", "later_window"}));
}

TEST(WriteJsonTest, FaultsAndReactionsHaveTheGivenNames) {
    verifies("SWR-TAB-001");
    const json table = dump(make_view(kSystem), {{"Overspeed"}, {"None", "Ss1", "Sto"}});

    EXPECT_EQ(table["faults"],
              json::parse(R"([{"number": 0, "name": "Overspeed"}, {"number": 1, "name": "1"}])"));
    EXPECT_EQ(table["reactions"][0],
              json::parse(R"({"fault": 0, "reaction": "Ss1", "within_ns": 20000000, "modes": []})"));
    EXPECT_EQ(dump(make_view(kSystem))["reactions"][1]["reaction"], "2");
}

TEST(WriteJsonTest, FindingsArePartOfTheDocument) {
    verifies("SWR-TAB-003");
    auto table = kSystem;
    table.windows[0].budget = 1_s;
    table.faults[0].fault = 5U;

    const json document = dump(make_view(table));
    EXPECT_EQ(document["findings"].size(), 3U);
    EXPECT_EQ(document["findings"][0],
              "window 'sense': its budget of 1 s is not in 1 ns .. its length of 200 us; rule: the budget of "
              "a window is positive and not longer than the window");
    EXPECT_EQ(dump(make_view(kSystem))["findings"], json::array());
}

TEST(WriteJsonTest, NamesWithAnyCharactersGiveValidJson) {
    verifies("SWR-TAB-001", Technique::kErrorGuessing, Polarity::kViolation);
    auto table = kSystem;
    table.windows[0].name = "a \"b\" \\ \n\t\x01 \xe5\xae\x88";
    EXPECT_EQ(dump(make_view(table))["windows"][0]["name"], table.windows[0].name);
}

TEST(WriteJsonTest, RowsWithInvalidIndicesGiveValidJson) {
    verifies("SWR-TAB-001", Technique::kErrorGuessing, Polarity::kViolation);
    auto table = kSystem;
    table.windows[0].name = nullptr;
    table.windows[0].partition = nullptr;
    table.windows[0].alternative_count = 99U;
    table.windows[1].has_rate = true;
    table.windows[1].rate_hz = std::numeric_limits<double>::infinity();
    table.components[0] = nullptr;
    table.component_rows[1].window = 99U;
    table.ports[1].input = nullptr;
    table.connections[0] = ConnectionRow{};
    table.connections[1].source_window = 99U;
    table.windows[2].offset = {std::numeric_limits<std::int64_t>::max()};

    const json document = dump(make_view(table));
    EXPECT_EQ(document["windows"][0]["name"], "?");
    EXPECT_TRUE(document["windows"][1]["rate_hz"].is_null());
    EXPECT_TRUE(document["components"][1]["window"].is_null());
    EXPECT_TRUE(document["connections"][0]["from"]["component"].is_null());
    EXPECT_GE(document["findings"].size(), 4U);
    EXPECT_EQ(dump(SystemView{})["windows"], json::array());
}

class SaveJsonTest : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ =
            std::filesystem::path{::testing::TempDir()} /
            ("table_dump_" + std::string{::testing::UnitTest::GetInstance()->current_test_info()->name()});
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path folder_;
};

TEST_F(SaveJsonTest, AFileContainsTheCompleteTableAndNoTemporaryFileRemains) {
    verifies("SWR-TAB-002");
    const std::string path = folder_ / "table.json";
    std::ofstream{path} << "old";

    EXPECT_EQ(save_json(path, make_view(kSystem)), "");
    EXPECT_EQ(json::parse(std::ifstream{path}), dump(make_view(kSystem)));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator{folder_}, {}), 1);
}

TEST_F(SaveJsonTest, AFileThatCannotBeWrittenIsNamedAndItsContentIsUnchanged) {
    verifies("SWR-TAB-002", Technique::kFaultInjection, Polarity::kViolation);
    const std::string missing = folder_ / "missing" / "table.json";

    EXPECT_EQ(
        save_json(missing, make_view(kSystem)),
        missing + ": the table cannot be written; check the folder, its permissions and the free space");
    EXPECT_EQ(save_json(folder_, make_view(kSystem)),
              folder_.string() + ": is a folder; name the file for the table itself");
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(SaveJsonTest, AFullDiskLeavesNoFile) {
    verifies("SWR-TAB-002", Technique::kFaultInjection, Polarity::kViolation);
    const std::string path = folder_ / "table.json";
    std::filesystem::create_symlink("/dev/full", path + ".part");

    EXPECT_NE(save_json(path, make_view(kSystem)), "");
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace mamori::table_dump
