// SPDX-License-Identifier: Apache-2.0
// Goal: the arm behind links behaves as the arm in one process. Method: both programs with the same scenario;
// their records are compared.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "mamori/trace/verifies.hpp"

namespace safe_arm {
namespace {

using namespace mamori::verification;

nlohmann::json run(const std::string& program, const std::string& arguments) {
    const std::filesystem::path out =
        std::filesystem::path{::testing::TempDir()} / ("hil_" + std::to_string(::getpid()));
    const std::string command = program + " --model " + SAFE_ARM_MODEL_FILE + " --motion " +
                                SAFE_ARM_MOTION_FILE + " --frames 1600 --out " + out.string() + " " +
                                arguments;
    EXPECT_EQ(std::system(command.c_str()), 0) << command;  // NOLINT(concurrency-mt-unsafe)
    std::ifstream file{out / "run.json"};
    nlohmann::json record = nlohmann::json::parse(file);
    std::filesystem::remove_all(out);
    for (const char* host : {"trace_hash", "wall_s"}) {
        record.erase(host);
    }
    return record;
}

TEST(VirtualHilTest, WithoutAFaultTheRecordEqualsThatOfOneProcess) {
    verifies("SWR-HIL-006", Technique::kBackToBack, Polarity::kNominal);
    EXPECT_EQ(run(HIL_VIRTUAL_PROGRAM, ""), run(std::string{SAFE_ARM_PROGRAM} + " run", ""));
}

TEST(VirtualHilTest, AFaultOfThePlantGivesTheRecordOfOneProcess) {
    verifies("SWR-HIL-006", Technique::kBackToBack, Polarity::kViolation);
    const std::string fault = "--fault kind=encoder_freeze,joint=2,channel=a,at=0.3";
    EXPECT_EQ(run(HIL_VIRTUAL_PROGRAM, fault), run(std::string{SAFE_ARM_PROGRAM} + " run", fault));
}

TEST(VirtualHilTest, LostCommandsGiveTheRecordOfOneProcess) {
    verifies("SWR-HIL-006", Technique::kBackToBack, Polarity::kViolation);
    const std::string fault = "--fault kind=message_lost,at=0.3";
    nlohmann::json record = run(HIL_VIRTUAL_PROGRAM, fault);
    nlohmann::json reference = run(std::string{SAFE_ARM_PROGRAM} + " run", fault);
    // The kernel reports the setpoint that it received, the program of one process the one that was sent.
    record["physics"].erase("max_tracking_error_rad");
    reference["physics"].erase("max_tracking_error_rad");
    EXPECT_EQ(record, reference);
}

TEST(VirtualHilTest, AHangOfTheSupervisorOpensTheRelayAsInOneProcess) {
    verifies("SWR-HIL-006", Technique::kBackToBack, Polarity::kViolation);
    const std::string fault = "--fault kind=supervisor_hang,at=0.3";
    const nlohmann::json record = run(HIL_VIRTUAL_PROGRAM, fault);
    const nlohmann::json reference = run(std::string{SAFE_ARM_PROGRAM} + " run", fault);
    EXPECT_TRUE(record["watchdog_bitten"]);
    EXPECT_EQ(record["final_state"], reference["final_state"]);
    EXPECT_EQ(record["detected_fault"], reference["detected_fault"]);
    EXPECT_EQ(record["reacted_at_s"], reference["reacted_at_s"]);
}

TEST(VirtualHilTest, DamagedAnswersOfThePlantStopTheArm) {
    verifies("SWR-HIL-002", Technique::kFaultInjection, Polarity::kViolation);
    const nlohmann::json record =
        run(HIL_VIRTUAL_PROGRAM, "--fault kind=message_lost,at=0.3 --link device --error corruption");
    EXPECT_EQ(record["detected_fault"], "MeasurementStale");
    EXPECT_EQ(record["final_state"], "Safe");
    EXPECT_LE(record["reacted_at_s"].get<double>() - 0.8, 0.006);
}

TEST(VirtualHilTest, DamagedDriveMessagesStopTheArm) {
    verifies("SWR-HIL-003", Technique::kFaultInjection, Polarity::kViolation);
    const nlohmann::json record =
        run(HIL_VIRTUAL_PROGRAM, "--fault kind=message_lost,at=0.3 --link drive --error addressing");
    EXPECT_EQ(record["final_state"], "Safe");
    EXPECT_LE(record["reacted_at_s"].get<double>() - 0.8, 0.007);
}

TEST(HilProgramTest, WrongArgumentsAreRefusedWithStatusTwo) {
    verifies("SWR-HIL-005", Technique::kEquivalenceClasses, Polarity::kViolation);
    const std::string common = std::string{" --model "} + SAFE_ARM_MODEL_FILE + " --motion " +
                               SAFE_ARM_MOTION_FILE + " --out /tmp/unused --frames 10 ";
    for (const std::string wrong :
         {"--link nowhere", "--error flood", "--error loss", "--fault kind=none_such", "--frames 0",
          "--fault kind=power_loss,at=0.1 --error loss", "--seed -x"}) {
        const std::string command = HIL_VIRTUAL_PROGRAM + common + wrong + " 2> /dev/null";
        const int status = std::system(command.c_str());  // NOLINT(concurrency-mt-unsafe)
        EXPECT_EQ(WEXITSTATUS(status), 2) << wrong;
    }
}

TEST(HilProgramTest, AFileThatIsNoLogIsNotReplayed) {
    verifies("SWR-HIL-015", Technique::kEquivalenceClasses, Polarity::kViolation);
    const std::string common = std::string{" --model "} + SAFE_ARM_MODEL_FILE + " --motion " +
                               SAFE_ARM_MOTION_FILE + " --out /tmp/unused --frames 10 2> /dev/null --replay ";
    for (const char* log : {"/dev/null", "/no/such/file", SAFE_ARM_MOTION_FILE}) {
        const std::string command = HIL_KERNEL_PROGRAM + common + log;
        const int status = std::system(command.c_str());  // NOLINT(concurrency-mt-unsafe)
        EXPECT_EQ(WEXITSTATUS(status), 2) << log;
    }
}

TEST(HilProgramTest, AUrlThatCannotBeOpenedIsRefusedByEachProgram) {
    verifies("SWR-HIL-005", Technique::kFaultInjection, Polarity::kViolation);
    const std::string common = std::string{" --model "} + SAFE_ARM_MODEL_FILE + " --motion " +
                               SAFE_ARM_MOTION_FILE + " --out " + ::testing::TempDir() +
                               "/hil_url --frames 10 --url nothing://here 2> /dev/null";
    for (const char* program : {HIL_PLANT_PROGRAM, HIL_KERNEL_PROGRAM, HIL_CONTROLLER_PROGRAM}) {
        const int status = std::system((program + common).c_str());  // NOLINT(concurrency-mt-unsafe)
        EXPECT_TRUE(WEXITSTATUS(status) == 1 || WEXITSTATUS(status) == 3) << program;
    }
}

}  // namespace
}  // namespace safe_arm
