// SPDX-License-Identifier: Apache-2.0
// Goal: one run of the program writes its whole record, or one line and nothing. Method: the real program as
// a process, with a short motion made here.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "arm_faults.hpp"
#include "arm_limits.hpp"
#include "mamori/kernel/record/flight_reader.hpp"
#include "mamori/trace/verifies.hpp"
#include "run_recorder.hpp"
#include "safety_supervisor.hpp"
#include "table_output.hpp"
#include "timing_command.hpp"

namespace safe_arm {
namespace {

namespace fs = std::filesystem;
using namespace mamori::verification;

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

    /// Upper bound of the true speed of the flange in operation: each joint with its longest lever [m/s].
    double read_flange_speed() const {
        const std::array<double, 7U> levers_m{1.03, 1.03, 0.58, 0.58, 0.083, 0.08, 0.0};
        std::ifstream series{folder_ / "out" / "series.csv"};
        double fastest = 0.0;
        std::string line;
        while (std::getline(series, line)) {
            std::istringstream cells{line};
            std::string cell;
            double sum = 0.0;
            for (std::size_t column = 0U; std::getline(cells, cell, ','); ++column) {
                // The time and the positions come first.
                const bool is_speed =
                    column >= 8U && column < 15U && cell != "qd" + std::to_string(column - 7U);
                sum += is_speed ? levers_m[column - 8U] * std::abs(std::stod(cell)) : 0.0;
            }
            fastest = line.find(",Operational,") == std::string::npos ? fastest : std::max(fastest, sum);
        }
        EXPECT_GT(fastest, 0.0);
        return fastest;
    }

    std::string recorder_path() const { return (folder_ / "run.rec").string(); }
    /// Every record of the recorder file, in the order of the ring's places; a damaged place is a failure.
    std::vector<mamori::FlightRecord> read_recorder() const {
        std::ifstream file{recorder_path(), std::ios::binary};
        const std::string text{std::istreambuf_iterator<char>{file}, {}};
        mamori::FlightReader reader;
        std::vector<mamori::FlightRecord> records;
        if (reader.open({reinterpret_cast<const std::byte*>(text.data()), text.size()}) !=
            mamori::Status::kOk) {
            return records;
        }
        for (std::size_t slot = 0U; slot < reader.get_capacity(); ++slot) {
            mamori::FlightRecord record{};
            const mamori::SlotState state = reader.read(slot, record);
            EXPECT_NE(state, mamori::SlotState::kCorrupt) << slot;
            if (state == mamori::SlotState::kWhole) {
                records.push_back(record);
            }
        }
        return records;
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

TEST_F(RunTest, CommandsMayBeMissingOrLateForTheToleratedLossesAndNoFrameLonger) {
    verifies("SWR-SAF-008", Technique::kBoundaryValues, Polarity::kViolation);
    const double tolerated_s = static_cast<double>(kCommandLossesMax) * kFrameS;
    for (const std::string kind : {"message_lost,at=0.5,duration=", "message_late,at=0.5,magnitude="}) {
        const auto disturb = [&](double time_s) {
            EXPECT_EQ(run(arguments("--frames 1600 --fault kind=" + kind + std::to_string(time_s))), 0)
                << messages_;
            return read_summary();
        };
        EXPECT_EQ(disturb(tolerated_s)["final_state"], "Operational") << kind;

        const nlohmann::json stale = disturb(tolerated_s + kFrameS);
        EXPECT_EQ(stale["detected_fault"], "CommandStale") << kind;
        EXPECT_EQ(stale["reaction"], "Ss1") << kind;
    }
}

TEST_F(RunTest, ReleasedEmergencyStopNeedsResetAndStart) {
    verifies("SWR-SAF-032", Technique::kStateTransition);
    const std::string pushed = "--fault kind=emergency_stop,channel=both,at=0.3,duration=0.5 --frames ";
    // The operator releases reset 1.05 s, and start 1.45 s after the demand.
    for (const auto& [frames, state] :
         {std::pair{"1849", "Safe"}, std::pair{"2249", "Standby"}, std::pair{"2252", "Operational"}}) {
        ASSERT_EQ(run(arguments(pushed + frames)), 0) << messages_;
        EXPECT_EQ(read_summary()["final_state"], state) << frames;
        EXPECT_EQ(read_summary()["reaction"], "Ss1");
    }
}

TEST_F(RunTest, ClosedProtectiveStopNeedsStartOnlyAndTheArmNeverLosesItsTorque) {
    verifies("SWR-SAF-033", Technique::kStateTransition);
    const std::string opened = "--fault kind=protective_stop,channel=both,at=0.3,duration=0.5 --frames ";
    // The operator releases start 1.45 s after the demand.
    for (const auto& [frames, state] : {std::pair{"2249", "StandstillHold"}, std::pair{"2253", "Operational"},
                                        std::pair{"3000", "Operational"}}) {
        ASSERT_EQ(run(arguments(opened + frames)), 0) << messages_;
        const nlohmann::json summary = read_summary();
        EXPECT_EQ(summary["final_state"], state) << frames;
        EXPECT_EQ(summary["reaction"], "Ss2");
        EXPECT_LT(summary["physics"]["hold_drift_rad"], 0.002);
    }
    std::ifstream events{folder_ / "out" / "events.csv"};
    const std::string lines{std::istreambuf_iterator<char>{events}, {}};
    EXPECT_EQ(lines.find("Safe"), std::string::npos) << lines;
}

TEST_F(RunTest, BrakeThatCreepsInStandbyIsFoundWithinFiveMilliradiansAndTheStartRefused) {
    verifies("SWR-SAF-034", Technique::kFaultInjection, Polarity::kViolation);
    const std::string creep = "--fault kind=brake_creep,joint=2,magnitude=0.02,at=0.3 --frames ";
    ASSERT_EQ(run(arguments(creep + "799")), 0) << messages_;
    EXPECT_EQ(read_summary()["final_state"], "Standby");
    ASSERT_EQ(run(arguments(creep + "2500")), 0) << messages_;

    const nlohmann::json summary = read_summary();
    EXPECT_EQ(summary["final_state"], "Safe");
    EXPECT_EQ(summary["detected_fault"], "MovementAtRest");
    EXPECT_TRUE(summary["operational_at_s"].is_null());
    const double time_s = summary["detected_at_s"].get<double>() - 0.8;
    EXPECT_GT(0.02 * time_s, kRestTravelRad * 0.9);
    EXPECT_LT(0.02 * time_s, kRestTravelRad * 1.1);
}

TEST_F(RunTest, AWrongClockIsFoundBelowTheMechanicalSpeedAndASmallDeviationIsTolerated) {
    verifies("SWR-SAF-050", Technique::kFaultInjection);
    for (const auto& [rate, state] :
         {std::pair{"0.5", "Safe"}, std::pair{"0.94", "Safe"}, std::pair{"0.96", "Operational"},
          std::pair{"1.04", "Operational"}, std::pair{"1.06", "Safe"}, std::pair{"2", "Safe"}}) {
        const double true_rate = std::stod(rate);
        ASSERT_EQ(
            run(arguments(std::string{"--frames 2000 --fault kind=clock_wrong,at=0.25,magnitude="} + rate)),
            0)
            << messages_;
        const nlohmann::json summary = read_summary();
        EXPECT_EQ(summary["final_state"], state) << rate;
        for (std::size_t j = 0U; j < kArmJointCount; ++j) {
            EXPECT_LT(summary["physics"]["max_speed_rad_s"][j].get<double>(), kNoLoadSpeedRadS[j]) << rate;
        }
        if (summary["final_state"] == "Safe") {
            // The record counts frames, which are longer with a slow clock.
            EXPECT_LT((summary["detected_at_s"].get<double>() - 0.75) / true_rate, 0.21) << rate;
            if (true_rate > 0.9 && true_rate < 1.1) {
                EXPECT_EQ(summary["detected_fault"], "ClockDeviation") << rate;
            }
            EXPECT_LT(summary["physics"]["hold_drift_rad"], 0.002);
        }
    }
}

TEST_F(RunTest, SlowModesKeepTheFlangeBelow250MillimetresPerSecond) {
    verifies("SWR-SAF-037");
    for (const char* const mode : {"reduced_speed", "hold_to_run"}) {
        ASSERT_EQ(run(arguments(std::string{"--frames 4000 --fault kind=none,latent="} + mode)), 0)
            << messages_;
        const nlohmann::json summary = read_summary();
        EXPECT_EQ(summary["final_state"], "Operational") << mode;
        EXPECT_LT(summary["physics"]["max_tracking_error_rad"], 0.02);
        EXPECT_LT(read_flange_speed(), kFlangeSpeedMax) << mode;
    }
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
        EXPECT_EQ(summary["reaction"], "Ss1") << row.joint;
        EXPECT_EQ(summary["final_state"], "Safe") << row.joint;
        EXPECT_GT(summary["physics"]["min_position_margin_rad"].get<double>(), 0.0) << row.joint;
    }
}

TEST_F(RunTest, TrackingIsJudgedBehindAToleratedFaultToo) {
    verifies("SWR-SAF-016", Technique::kFaultInjection);
    const std::string bias = "--fault kind=encoder_bias,joint=7,channel=a,magnitude=0.0038,at=";
    ASSERT_EQ(run(arguments("--frames 1650")), 0) << messages_;
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

TEST_F(RunTest, RecorderHoldsTheEventsOfTheRunAndGoesOnInTheNext) {
    verifies("SWR-REC-014");
    const std::string recorder = "--recorder '" + recorder_path() + "' --frames 1200 ";
    ASSERT_EQ(run(arguments(recorder + "--fault kind=power_loss,at=0.3")), 0) << messages_;

    const std::vector<mamori::FlightRecord> first = read_recorder();
    std::ifstream events{folder_ / "out" / "events.csv"};
    const std::string lines{std::istreambuf_iterator<char>{events}, {}};
    ASSERT_GT(first.size(), 3U);
    EXPECT_EQ(static_cast<std::ptrdiff_t>(first.size()), std::count(lines.begin(), lines.end(), '\n') - 1);
    EXPECT_EQ(first.back().session, 1U);
    const nlohmann::json names = nlohmann::json::parse(std::ifstream{recorder_path() + ".names.json"});
    EXPECT_EQ(names["sources"]["0"], "supervisor");
    EXPECT_EQ(names["codes"]["1"]["name"], "fault_latched");
    EXPECT_EQ(names["arguments"]["fault"].size(), kArmFaultCount);
    EXPECT_EQ(names["arguments"]["state"]["8"], "Safe");
    EXPECT_EQ(names["arguments"]["reaction"]["4"], "Sto");

    ASSERT_EQ(run(arguments(recorder)), 0) << messages_;
    const std::vector<mamori::FlightRecord> second = read_recorder();
    ASSERT_GT(second.size(), first.size());
    EXPECT_EQ(second[first.size()].session, 2U);
    EXPECT_EQ(second[first.size()].sequence, first.size() + 1U);
}

TEST_F(RunTest, RecorderChangesNothingInTheRun) {
    verifies("SWR-REC-014", Technique::kBackToBack);
    ASSERT_EQ(run(arguments("--frames 800")), 0) << messages_;
    const nlohmann::json without = read_summary()["trace_hash"];
    ASSERT_EQ(run(arguments("--frames 800 --recorder '" + recorder_path() + "'")), 0) << messages_;

    EXPECT_EQ(read_summary()["trace_hash"], without);
}

TEST_F(RunTest, KilledRunLeavesItsEventsInTheRecorder) {
    verifies("SWR-REC-014", Technique::kFaultInjection, Polarity::kViolation);
    const std::string out = (folder_ / "out").string();
    const std::string motion = (folder_ / "motion.dat").string();
    const std::string path = recorder_path();
    const pid_t child = ::fork();
    if (child == 0) {
        ::execl(SAFE_ARM_PROGRAM, SAFE_ARM_PROGRAM, "run", "--model", SAFE_ARM_MODEL_FILE, "--motion",
                motion.c_str(), "--out", out.c_str(), "--recorder", path.c_str(), "--frames", "100000000",
                nullptr);
        ::_exit(127);
    }
    int status = 0;
    while (read_recorder().size() < 2U && ::waitpid(child, &status, WNOHANG) == 0) {
    }
    const std::size_t before = read_recorder().size();
    ASSERT_EQ(::kill(child, SIGKILL), 0);
    ASSERT_EQ(::waitpid(child, &status, 0), child);

    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_FALSE(fs::exists(folder_ / "out" / "run.json"));
    const std::vector<mamori::FlightRecord> records = read_recorder();
    ASSERT_GE(records.size(), before);
    EXPECT_EQ(records[0].code, static_cast<std::uint16_t>(mamori::safety::CycleEvent::kStateEntered));
    EXPECT_EQ(records[0].argument, static_cast<std::int64_t>(mamori::safety::SafeState::kStandby));
}

TEST_F(RunTest, RecorderFileThatCannotBeUsedIsRefusedBeforeTheRun) {
    verifies("SWR-REC-014", Technique::kErrorGuessing, Polarity::kViolation);
    const auto expect_refused = [this](const std::string& path, const std::string& part) {
        EXPECT_EQ(run(arguments("--frames 700 --recorder '" + path + "'")), 2);
        expect_one_line(part);
    };
    expect_refused(folder_.string(), "not a regular file");
    expect_refused((folder_ / "gone" / "run.rec").string(), "No such file");
    std::ofstream{folder_ / "other"} << "other content\n";
    expect_refused((folder_ / "other").string(), "another size");
    const std::string foreign(mamori::flight::calc_region_size(kRecorderCapacity), 'x');
    std::ofstream{folder_ / "foreign", std::ios::binary} << foreign;
    expect_refused((folder_ / "foreign").string(), "no recorder that can go on");
    std::string newer = foreign;
    for (std::size_t i = 0U; i < mamori::flight::kMagic.size(); ++i) {
        newer[i] = static_cast<char>(mamori::flight::kMagic[i]);
    }
    std::ofstream{folder_ / "newer", std::ios::binary} << newer;
    expect_refused((folder_ / "newer").string(), "another release");
    EXPECT_FALSE(fs::exists(folder_ / "foreign.names.json"));
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

TEST_F(RunTest, FaultIsInjectedBeforeTheEndOfTheMotionOnly) {
    verifies("SWR-SAF-024", Technique::kBoundaryValues, Polarity::kViolation);
    for (const char* const at : {"1", "1.001", "99"}) {
        EXPECT_EQ(run(arguments(std::string{"--frames 700 --fault kind=power_loss,at="} + at)), 2) << at;
        expect_one_line("is not before the end of the motion at 1.0 s");
        EXPECT_FALSE(fs::exists(folder_ / "out")) << at;
    }
}

TEST_F(RunTest, FaultJustBeforeTheEndOfTheMotionIsInjectedAndNoFaultNeedsNoInstant) {
    verifies("SWR-SAF-024", Technique::kBoundaryValues);

    ASSERT_EQ(run(arguments("--frames 1600 --fault kind=power_loss,at=0.999")), 0) << messages_;
    EXPECT_EQ(read_summary()["detected_fault"], "PowerLost");
    EXPECT_EQ(run(arguments("--frames 700 --fault kind=power_loss,at=0.999999999")), 0) << messages_;
    EXPECT_EQ(run(arguments("--frames 700 --fault kind=none")), 0) << messages_;
}

TEST_F(RunTest, HelpListsTheKindsOfFaultsAndAWrongKindListsThemToo) {
    verifies("SWR-SIM-015", Technique::kErrorGuessing, Polarity::kViolation);
    const std::string wrong = arguments("--fault kind=nonsense,at=0.3");

    ASSERT_EQ(run("run --help"), 0);
    std::string help = messages_;
    help.erase(std::remove_if(help.begin(), help.end(), [](char c) { return c == '\n' || c == ' '; }),
               help.end());
    ASSERT_EQ(run(wrong), 2);
    for (const char* const kind :
         {"none", "encoder_freeze", "encoder_bit_flip", "encoder_bias", "torque_runaway", "power_loss",
          "brake_fade", "controller_hang", "message_lost", "message_late", "supervisor_hang"}) {
        EXPECT_NE(help.find(kind), std::string::npos) << kind;
        expect_one_line(kind);
    }
}

TEST_F(RunTest, FolderThatCannotBeWrittenGivesOneLine) {
    verifies("SWR-SAF-016", Technique::kErrorGuessing, Polarity::kViolation);
    std::ofstream{folder_ / "out"} << "a file where the folder should be\n";

    EXPECT_EQ(run(arguments("--frames 700")), 2);
    EXPECT_NE(messages_.find("cannot be written"), std::string::npos) << messages_;
}

TEST_F(RunTest, TimingLeavesTheTimesOfEveryWindowOfEveryFrame) {
    verifies("SWR-TIM-004");
    const std::string place = "--model '" SAFE_ARM_MODEL_FILE "' --out '" + (folder_ / "out").string() + "' ";
    ASSERT_EQ(run("timing --cycles 300 --requests " + place + "--motion '" +
                  (folder_ / "motion.dat").string() + "'"),
              0)
        << messages_;

    const nlohmann::json facts = read_summary();
    EXPECT_EQ(facts["schema"], "mamori.timing_run/1");
    EXPECT_EQ(facts["cycles"]["run"], 300);
    EXPECT_EQ(facts["requests"]["block_cycles"], 500);
    EXPECT_GT(fs::file_size(folder_ / "out" / "openings.npy"), 300U * 4U * 32U);
    EXPECT_GT(fs::file_size(folder_ / "out" / "steps.npy"), 32U);
    EXPECT_EQ(nlohmann::json::parse(std::ifstream{folder_ / "out" / "table.json"})["modes"].size(), 4U);
    ASSERT_EQ(facts["notes"].size(), 2U);
    EXPECT_EQ(facts["notes"][0].get<std::string>().find("the arm ended in state "), 0U) << facts["notes"];
    EXPECT_NE(messages_.find("the simulated arm was not ready for "), std::string::npos) << messages_;
}

TEST_F(RunTest, TimingOfAnArmThatOperatesOrHasNotBegunHasNoFinding) {
    verifies("SWR-TIM-005");
    using mamori::safety::SafeState;
    for (const SafeState state : {SafeState::kSelfTest, SafeState::kStandby, SafeState::kOperational}) {
        EXPECT_TRUE(make_findings(state, 0U).empty()) << static_cast<int>(state);
    }
}

TEST_F(RunTest, TimingOfAnArmThatLeftItsOperatingStateIsAFinding) {
    verifies("SWR-TIM-005", Technique::kFaultInjection, Polarity::kViolation);
    using mamori::safety::SafeState;
    for (auto state = static_cast<int>(SafeState::kDegraded);
         state <= static_cast<int>(SafeState::kLockedOut); ++state) {
        EXPECT_EQ(make_findings(static_cast<SafeState>(state), kArmFaultCount).size(), 1U) << state;
    }
    EXPECT_EQ(make_findings(SafeState::kLockedOut, 0U).front(),
              std::string{"the arm left its operating state and ended in LockedOut, first fault "} +
                  get_fault_names()[0]);
    EXPECT_EQ(make_findings(SafeState::kLockedOut, kArmFaultCount).front(),
              "the arm left its operating state and ended in LockedOut");
}

TEST_F(RunTest, TimingOfNoCyclesIsRefused) {
    verifies("SWR-TIM-004", Technique::kBoundaryValues, Polarity::kViolation);
    for (const char* cycles : {"0", "-1", "many"}) {
        EXPECT_EQ(run("timing --model '" SAFE_ARM_MODEL_FILE "' --out '" + (folder_ / "out").string() +
                      "' --cycles " + cycles),
                  2)
            << cycles;
        expect_one_line("--cycles");
    }
}

}  // namespace
}  // namespace safe_arm
