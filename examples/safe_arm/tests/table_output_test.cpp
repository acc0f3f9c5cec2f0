// SPDX-License-Identifier: Apache-2.0
// Goal: the example's table leaves the program as it is, with the names and reactions of its faults and its
// safety rows. Method: read back as JSON.
#include "table_output.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "arm_faults.hpp"
#include "arm_limits.hpp"
#include "mamori/trace/verifies.hpp"
#include "safe_arm_system.hpp"

namespace safe_arm {
namespace {

using namespace mamori::verification;

TEST(TableOutputTest, TheWholeTableIsWrittenWithTheReactionOfEachFault) {
    verifies("SWR-TAB-001");
    const std::string path = ::testing::TempDir() + "safe_arm_table.json";

    ASSERT_EQ(save_table(path), "");
    const nlohmann::json table = nlohmann::json::parse(std::ifstream{path});
    EXPECT_EQ(table["windows"].size(), 4U);
    EXPECT_EQ(table["components"].size(), executive.get_view().components.size());
    EXPECT_EQ(table["connections"].size(), 14U);
    EXPECT_EQ(table["reactions"].size(), kArmFaultCount + 3U) << "three faults count in some modes only";
    EXPECT_EQ(table["modes"].size(), 4U);
    EXPECT_EQ(table["faults"][0]["name"], "EncoderImplausible");
    EXPECT_EQ(table["reactions"][0]["reaction"], "Ss1");
    EXPECT_EQ(table["findings"], nlohmann::json::array());
}

TEST(TableOutputTest, TheSafetyRowsAreWrittenAndTheNamesOfFaultsAreTheirEnumerators) {
    verifies("SWR-CYC-032");
    const std::string path = ::testing::TempDir() + "safe_arm_safety.json";

    ASSERT_EQ(save_table(path), "");
    const nlohmann::json table = nlohmann::json::parse(std::ifstream{path});
    EXPECT_EQ(table["safety"]["supervised"].size(), 6U);
    EXPECT_EQ(table["safety"]["self_tests"].size(), 2U);
    EXPECT_EQ(table["safety"]["cycle"]["ss1_within_ns"], kStopBounds.ss1_within.ns);
    EXPECT_EQ(get_fault_names().size(), kArmFaultCount);
    EXPECT_EQ(get_fault_names()[to_index(ArmFault::kReactionLate)], "ReactionLate");
    EXPECT_EQ(get_fault_names().back(), "RunReleased");
}

/// `component.port`
std::string show_end(const nlohmann::json& table, const nlohmann::json& end) {
    return table["components"][end["component"].get<std::size_t>()]["name"].get<std::string>() + '.' +
           end["port"].get<std::string>();
}

TEST(TableOutputTest, WindowsAndConnectionsAreThoseOfTheDesign) {
    verifies("SWR-SAF-017");
    const std::string path = ::testing::TempDir() + "safe_arm_wiring.json";
    ASSERT_EQ(save_table(path), "");
    const nlohmann::json table = nlohmann::json::parse(std::ifstream{path});

    std::vector<std::string> rows;
    for (std::size_t i = 0U; i < table["windows"].size(); ++i) {
        const nlohmann::json& window = table["windows"][i];
        std::string row = window["name"];
        for (const char* const key : {"offset_ns", "length_ns", "budget_ns"}) {
            row += ' ' + std::to_string(window[key].get<int>() / 1000);
        }
        for (const nlohmann::json& component : table["components"]) {
            row += component["window"] == i ? ' ' + component["name"].get<std::string>() : "";
        }
        rows.push_back(row);
    }
    const std::vector<std::string> windows{"protect 0 300 250 arm_reader joint_monitor safety_supervisor",
                                           "control 300 400 350 motion_controller command_sender",
                                           "transport 700 100 80 channel",
                                           "act 800 100 80 command_receiver drive_gate"};
    EXPECT_EQ(rows, windows);

    rows.clear();
    for (const nlohmann::json& row : table["connections"]) {
        EXPECT_TRUE(row["fresh_within_ns"].is_null());
        rows.push_back(show_end(table, row["from"]) + " > " + show_end(table, row["to"]) + ", " +
                       row["way"].get<std::string>());
    }
    const std::vector<std::string> connections{
        "arm_reader.reading > joint_monitor.reading, same_window",
        "command_receiver.out > joint_monitor.command, next_frame",
        "drive_gate.drive > joint_monitor.drive, next_frame",
        "arm_reader.reading > safety_supervisor.reading, same_window",
        "joint_monitor.state > safety_supervisor.arm_state, same_window",
        "drive_gate.drive > safety_supervisor.drive, next_frame",
        "joint_monitor.state > motion_controller.state, later_window",
        "safety_supervisor.stop > motion_controller.stop, later_window",
        "motion_controller.command > command_sender.in, same_window",
        "command_sender.out > channel.in, later_window",
        "channel.out > command_receiver.in, later_window",
        "safety_supervisor.stop > drive_gate.stop, later_window",
        "joint_monitor.state > drive_gate.arm_state, later_window",
        "command_receiver.out > drive_gate.command, same_window"};
    EXPECT_EQ(rows, connections);
}

TEST(TableOutputTest, AFileThatCannotBeWrittenIsNamed) {
    verifies("SWR-TAB-002", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_NE(save_table("/nowhere/table.json").find("/nowhere/table.json: "), std::string::npos);
}

}  // namespace
}  // namespace safe_arm
