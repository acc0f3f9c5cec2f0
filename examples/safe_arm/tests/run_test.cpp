// SPDX-License-Identifier: Apache-2.0
// Goal: one run of the program writes its whole record, or one line and nothing. Method: the real program as
// a process, with a short motion made here.
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "mamori/verification/verifies.hpp"

namespace safe_arm {
namespace {

namespace fs = std::filesystem;
using mamori::verification::Polarity;
using mamori::verification::Technique;
using mamori::verification::verifies;

class RunTest : public ::testing::Test {
  protected:
    void SetUp() override {
        const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
        folder_ = fs::path{::testing::TempDir()} / ("safe_arm_run_" + name + std::to_string(::getpid()));
        fs::create_directories(folder_);
        std::ofstream{folder_ / "motion.dat"} << "0 0 0.8 0 0.8 0 0.8 1.57\n1 0.2 0.9 0.2 0.9 0.2 0.9 1.7\n";
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string arguments(const std::string& more) const {
        return "run --model '" SAFE_ARM_MODEL_FILE "' --motion '" + (folder_ / "motion.dat").string() +
               "' --out '" + (folder_ / "out").string() + "' " + more;
    }
    /// Exit status of the program; its messages are in `messages_`.
    int run(const std::string& arguments) {
        const fs::path log = folder_ / "log.txt";
        const std::string line = "'" SAFE_ARM_PROGRAM "' " + arguments + " >'" + log.string() + "' 2>&1";
        const int status = std::system(line.c_str());
        std::ostringstream text;
        text << std::ifstream{log}.rdbuf();
        messages_ = text.str();
        return WEXITSTATUS(status);
    }
    nlohmann::json read_summary() const {
        return nlohmann::json::parse(std::ifstream{folder_ / "out" / "run.json"});
    }
    void expect_one_line(const std::string& part) const {
        EXPECT_NE(messages_.find(part), std::string::npos) << messages_;
        EXPECT_EQ(std::count(messages_.begin(), messages_.end(), '\n'), 1) << messages_;
        EXPECT_FALSE(fs::exists(folder_ / "out" / "run.json"));
    }

    fs::path folder_;
    std::string messages_;
};

TEST_F(RunTest, FaultFreeRunStaysOperationalAndIsRecorded) {
    verifies("SWR-SAF-016");
    ASSERT_EQ(run(arguments("--frames 1800 --seed 7")), 0) << messages_;

    const nlohmann::json summary = read_summary();
    EXPECT_EQ(summary["schema"], "mamori.run/1");
    EXPECT_EQ(summary["seed"], 7);
    EXPECT_EQ(summary["frames"], 1800);
    EXPECT_EQ(summary["final_state"], "Operational");
    EXPECT_TRUE(summary["fault"].is_null());
    EXPECT_EQ(summary["trace_hash"].get<std::string>().size(), 16U);
    EXPECT_LT(summary["physics"]["max_tracking_error_rad"], 0.02);
    EXPECT_TRUE(fs::exists(folder_ / "out" / "series.csv"));
    EXPECT_TRUE(fs::exists(folder_ / "out" / "events.csv"));
}

TEST_F(RunTest, FaultAndItsReactionAreRecorded) {
    verifies("SWR-SAF-016", Technique::kFaultInjection);
    ASSERT_EQ(run(arguments("--fault kind=power_loss,at=0.3 --frames 1800")), 0) << messages_;

    const nlohmann::json summary = read_summary();
    EXPECT_EQ(summary["fault"]["kind"], "power_loss");
    EXPECT_DOUBLE_EQ(summary["fault"]["at_s"], 0.8);
    EXPECT_EQ(summary["detected_fault"], "PowerLost");
    EXPECT_EQ(summary["reaction"], "Sto");
    EXPECT_EQ(summary["final_state"], "Safe");
    EXPECT_FALSE(summary["standstill_at_s"].is_null());
}

TEST_F(RunTest, PathThatLeavesTheRangeIsStoppedInsideTheMechanicalRange) {
    verifies("SWR-SAF-007", Technique::kFaultInjection, Polarity::kViolation);
    struct Row {
        std::size_t joint;
        double begin_rad;
        double speed_rad_s;
    };
    // Every joint towards its end at the fastest planned speed: 80 % of the mechanical limit.
    const std::array<Row, 7U> rows{{{0U, 2.3, 0.8},
                                    {1U, 0.9, 0.8},
                                    {2U, 2.0, 1.6},
                                    {3U, 1.2, 1.6},
                                    {4U, 2.0, 5.0},
                                    {5U, 0.5, 5.0},
                                    {6U, 2.0, 5.0}}};
    for (const Row& row : rows) {
        std::ofstream motion{folder_ / "motion.dat"};
        for (int i = 0; i <= 150; ++i) {
            // The speed rises for 0.4 s and stays.
            const double time_s = 0.01 * i;
            const double travel_rad =
                time_s < 0.4 ? row.speed_rad_s * time_s * time_s / 0.8 : row.speed_rad_s * (time_s - 0.2);
            std::array<double, 7U> position_rad{0.0, 0.3, 0.0, 0.8, 0.0, 0.8, 0.0};
            position_rad[row.joint] = row.begin_rad + travel_rad;
            motion << time_s;
            for (const double value : position_rad) {
                motion << ' ' << value;
            }
            motion << '\n';
        }
        motion.close();
        ASSERT_EQ(run(arguments("")), 0) << messages_;

        const nlohmann::json summary = read_summary();
        EXPECT_EQ(summary["detected_fault"], "PositionLimit") << row.joint;
        EXPECT_EQ(summary["reaction"], "Sto") << row.joint;
        EXPECT_EQ(summary["final_state"], "Safe") << row.joint;
        EXPECT_GT(summary["physics"]["min_position_margin_rad"].get<double>(), 0.0) << row.joint;
    }
}

TEST_F(RunTest, TrackingIsJudgedBehindAToleratedFaultToo) {
    verifies("SWR-SAF-016", Technique::kFaultInjection);
    const std::string bias = "--fault kind=encoder_bias,joint=7,channel=a,magnitude=0.0038,at=";
    ASSERT_EQ(run(arguments(bias + "1.2 --frames 1650")), 0) << messages_;
    const double before = read_summary()["physics"]["max_tracking_error_rad"];
    ASSERT_EQ(run(arguments(bias + "0.6 --frames 1800")), 0) << messages_;

    const nlohmann::json summary = read_summary();
    EXPECT_EQ(summary["final_state"], "Operational");
    EXPECT_GT(summary["physics"]["max_tracking_error_rad"].get<double>(), before + 0.0005);
}

TEST_F(RunTest, SameRunGivesTheSameHashAndAnotherFaultAnotherOne) {
    verifies("SWR-SAF-016", Technique::kBackToBack);
    ASSERT_EQ(run(arguments("--frames 1200")), 0) << messages_;
    const nlohmann::json first = read_summary()["trace_hash"];
    ASSERT_EQ(run(arguments("--frames 1200")), 0) << messages_;
    EXPECT_EQ(read_summary()["trace_hash"], first);

    ASSERT_EQ(run(arguments("--frames 1200 --fault kind=power_loss,at=0.3")), 0) << messages_;
    EXPECT_NE(read_summary()["trace_hash"], first);
}

TEST_F(RunTest, BrokenInputGivesOneLineAndNoRecord) {
    verifies("SWR-SAF-016", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_EQ(run(arguments("--fault kind=encoder_freze,joint=2,channel=a,at=1")), 2);
    expect_one_line("encoder_freeze");
    EXPECT_EQ(run(arguments("--fualt kind=power_loss,at=1")), 2);
    expect_one_line("did you mean '--fault'");
    EXPECT_EQ(run("rnu"), 2);
    expect_one_line("'run'");
    EXPECT_EQ(run(arguments("--frames nine")), 2);
    expect_one_line("--frames");
    EXPECT_EQ(run(arguments("--frames -1")), 2);
    expect_one_line("--frames");
    EXPECT_EQ(run(arguments("--seed -1")), 2);
    expect_one_line("--seed");
    EXPECT_EQ(run("run --model /nowhere.yaml --motion x --out '" + (folder_ / "out").string() + "'"), 2);
    expect_one_line("/nowhere.yaml");
    std::ofstream{folder_ / "motion.dat"} << "0 0 0 0 0 0 0 0\n1 0 0 nan 0 0 0 0\n";
    EXPECT_EQ(run(arguments("")), 2);
    expect_one_line("motion.dat:2:");
}

TEST_F(RunTest, FolderThatCannotBeWrittenGivesOneLine) {
    verifies("SWR-SAF-016", Technique::kErrorGuessing, Polarity::kViolation);
    std::ofstream{folder_ / "out"} << "a file where the folder should be\n";

    EXPECT_EQ(run(arguments("--frames 700")), 2);
    EXPECT_NE(messages_.find("cannot be written"), std::string::npos) << messages_;
}

}  // namespace
}  // namespace safe_arm
