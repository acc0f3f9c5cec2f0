// SPDX-License-Identifier: Apache-2.0
// Goal: a cost run leaves complete files that state what was run, and rejects invalid options. Method: a
// small system whose files are read. The proof under callgrind (verification/proofs/test_cost.py) checks the
// counts.
#include "mamori/timing/cost_run.hpp"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::timing {
namespace {

using Json = nlohmann::json;
using namespace verification;
using literals::operator""_ms;

class Worker final : public Component {
  public:
    Worker() noexcept : Component("worker") {}
    Status on_execute(ContextHandle) noexcept override { return Status::kOk; }
};

class CountingDevices final : public Devices {
  public:
    void sample(std::uint64_t, Instant) noexcept override { ++begun; }
    void apply(std::uint64_t, Instant, Duration) noexcept override { ++ended; }
    std::uint64_t begun{0U};
    std::uint64_t ended{0U};
};

std::string read_file(const std::string& path) {
    std::ifstream in{path, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

class CostRunTest : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = ::testing::TempDir() + "cost_run_test";
        std::filesystem::remove_all(folder_);
        ASSERT_EQ(executive_.initialize(), Status::kOk);
        ASSERT_EQ(executive_.start(), Status::kOk);
        options_.out = folder_;
        options_.cycles = 10U;
        options_.counted = {4U, 2U};
    }
    TimingResult run() { return run_cost({{executive_, clock_}}, devices_, options_); }

    std::string folder_;
    Worker worker_;
    SystemTable<1U, 1U, 0U, 0U> table_ =
        system(frame(1_ms), window("only", 0_ms, 1_ms, budget(1_ms), mamori::run(worker_)));
    ExecutiveFor<decltype(table_)> executive_{table_};
    ports::virtual_time::IndexedVirtualHost clock_{{}};
    CountingDevices devices_;
    CostOptions options_;
};

TEST_F(CostRunTest, FilesDescribeTheRunAndTheBuild) {
    verifies("SWR-TIM-030");
    options_.tell_notes = [] { return std::vector<std::string>{"a note"}; };

    const TimingResult result = run();

    EXPECT_EQ(result.message, "");
    EXPECT_EQ(result.outcome, TimingOutcome::kWhole);
    const Json facts = Json::parse(read_file(folder_ + "/run.json"));
    EXPECT_EQ(facts["schema"], "mamori.cost_run/1");
    EXPECT_EQ(facts["cycles"], 10);
    EXPECT_EQ(facts["first"], 4);
    EXPECT_EQ(facts["every"], 2);
    EXPECT_FALSE(facts["is_paced"]);
    EXPECT_EQ(facts["frame_ns"], 1'000'000);
    EXPECT_EQ(facts["calibration_count"], 1);
    EXPECT_EQ(facts["lost_rows"], 0);
    EXPECT_EQ(facts["notes"], Json::array({"a note"}));
    for (const char* key : {"compiler", "flags", "c_library"}) {
        EXPECT_FALSE(facts[key].get<std::string>().empty()) << key;
    }
    EXPECT_NE(read_file(folder_ + "/steps.npy").find("'shape': (3,)"), std::string::npos);
    EXPECT_EQ(Json::parse(read_file(folder_ + "/table.json"))["components"].size(), 1U);
    EXPECT_EQ(devices_.begun, 10U);
    EXPECT_EQ(devices_.ended, 10U);
}

TEST_F(CostRunTest, InRealTimePrivilegesAndReferenceAreRecorded) {
    verifies("SWR-TIM-033");
    options_.is_paced = true;

    EXPECT_EQ(run().outcome, TimingOutcome::kWhole);

    const Json facts = Json::parse(read_file(folder_ + "/run.json"));
    EXPECT_TRUE(facts["is_paced"]);
    EXPECT_GT(facts["calibration_count"], 1);
    EXPECT_GT(facts["reference_ns"], facts["empty_ns"]);
    for (const char* right : {"priority", "processor", "memory"}) {
        EXPECT_EQ(facts["rights"][right]["is_granted"], facts["rights"][right]["errno"] == 0) << right;
    }
}

TEST_F(CostRunTest, InvalidOptionsAreRejectedBeforeTheRun) {
    verifies("SWR-TIM-030", Technique::kBoundaryValues, Polarity::kViolation);
    const auto refuse = [this](CostOptions bad) {
        const TimingResult result = run_cost({{executive_, clock_}}, devices_, bad);
        EXPECT_EQ(result.outcome, TimingOutcome::kRefused);
        EXPECT_NE(result.message, "");
    };
    CostOptions bad = options_;
    bad.cycles = 0U;
    refuse(bad);
    bad = options_;
    bad.cycles = 100'000'001U;
    refuse(bad);
    bad = options_;
    bad.counted.first = 10U;
    refuse(bad);
    bad = options_;
    bad.counted.every = 0U;
    refuse(bad);
    bad = options_;
    bad.out.clear();
    refuse(bad);
    bad = options_;
    bad.priority = 0;
    refuse(bad);
    bad.priority = 100;
    refuse(bad);
    EXPECT_EQ(run_cost({}, devices_, options_).outcome, TimingOutcome::kRefused);

    EXPECT_EQ(devices_.begun, 0U);
    EXPECT_FALSE(std::filesystem::exists(folder_));
}

TEST_F(CostRunTest, AFolderThatIsAFileIsRejected) {
    verifies("SWR-TIM-030", Technique::kErrorGuessing, Polarity::kViolation);
    std::ofstream{folder_} << "in the way";

    const TimingResult result = run();

    EXPECT_EQ(result.outcome, TimingOutcome::kRefused);
    EXPECT_NE(result.message.find(folder_), std::string::npos);
    std::filesystem::remove(folder_);
}

TEST_F(CostRunTest, ATableThatCannotBeWrittenLeavesNoCompleteFolder) {
    verifies("SWR-TIM-030", Technique::kFaultInjection, Polarity::kViolation);
    options_.save_table = [](const std::string&) { return std::string{"no room"}; };

    const TimingResult result = run();

    EXPECT_EQ(result.outcome, TimingOutcome::kFailed);
    EXPECT_EQ(result.message, "no room");
    EXPECT_FALSE(std::filesystem::exists(folder_ + "/run.json"));
}

}  // namespace
}  // namespace mamori::timing
