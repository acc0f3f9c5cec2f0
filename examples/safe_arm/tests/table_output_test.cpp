// SPDX-License-Identifier: Apache-2.0
// Goal: the example's table leaves the program as it is, with the names and reactions of its faults and its
// safety rows. Method: read back
// as JSON.
#include "table_output.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "arm_faults.hpp"
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

TEST(TableOutputTest, AFileThatCannotBeWrittenIsNamed) {
    verifies("SWR-TAB-002", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_NE(save_table("/nowhere/table.json").find("/nowhere/table.json: "), std::string::npos);
}

}  // namespace
}  // namespace safe_arm
