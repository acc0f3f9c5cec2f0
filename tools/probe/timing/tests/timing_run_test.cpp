// SPDX-License-Identifier: Apache-2.0
// Goal: a real-time run leaves complete files that describe it, also if it is interrupted or its work hangs.
// Method: a system of two cores with long budgets, whose files are read. No test depends on the speed of the
// host.
#include "mamori/timing/timing_run.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::timing {
namespace {

using Json = nlohmann::json;
using ports::posix_rt::WindowThread;
using namespace verification;
using literals::operator""_ms;

/// Sends a signal to the process, or hangs, in a cycle that the test selects.
class Worker final : public Component {
  public:
    explicit Worker(const char* name) noexcept : Component(name) {}
    Status on_execute(ContextHandle) noexcept override {
        ++run_count;
        if (run_count == signal_at) {
            static_cast<void>(raise(SIGINT));
        }
        while (run_count == hang_at && !is_freed) {
            std::this_thread::yield();
        }
        return Status::kOk;
    }
    std::atomic<int> run_count{0};
    int signal_at{0};
    int hang_at{0};
    std::atomic<bool> is_freed{false};
};

std::string read_file(const std::string& path) {
    std::ifstream in{path, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

/// Number of rows in the header of an .npy file.
std::size_t read_row_count(const std::string& path) {
    const std::string file = read_file(path);
    const std::size_t place = file.find("'shape': (");
    return place == std::string::npos ? 0U : std::stoul(file.substr(place + 10U));
}

/// Planned instants in openings.npy, whose rows have 32 bytes.
std::vector<std::int64_t> read_releases(const std::string& path) {
    const std::string file = read_file(path);
    std::vector<std::int64_t> releases(read_row_count(path));
    for (std::size_t row = 0U; row < releases.size(); ++row) {
        std::memcpy(&releases[row], &file[file.size() - 32U * (releases.size() - row)], sizeof(std::int64_t));
    }
    return releases;
}

/// Delays a window by more than two major frames.
class Delayer final : public ports::posix_rt::OpeningObserver {
  public:
    void before_opening(const FrameSchedule::Opening&, Instant) noexcept override {
        ++count_;
        const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds{count_ == 2 ? 50 : 0};
        while (std::chrono::steady_clock::now() < end) {
        }
    }
    void after_opening(const FrameSchedule::Opening&, WindowOutcome) noexcept override {}

  private:
    int count_{0};
};

bool has_two_processors() {
    cpu_set_t set;
    return sched_getaffinity(0, sizeof(set), &set) == 0 && CPU_COUNT(&set) >= 2;
}

class TimingRunTest : public ::testing::Test {
  protected:
    static constexpr Duration kFrame = 20_ms;

    void SetUp() override {
        folder_ = ::testing::TempDir() + "timing_run_test";
        std::filesystem::remove_all(folder_);
        ASSERT_EQ(upper_.initialize(), Status::kOk);
        ASSERT_EQ(lower_.initialize(), Status::kOk);
        ASSERT_EQ(upper_.start(), Status::kOk);
        ASSERT_EQ(lower_.start(), Status::kOk);
        options_.out = folder_;
    }
    void expect_whole_periods() const {
        const std::vector<std::int64_t> releases = read_releases(folder_ + "/openings.npy");
        ASSERT_EQ(releases.size(), 5U);
        for (std::size_t i = 0U; i < releases.size(); ++i) {
            EXPECT_EQ(releases[i], releases[0] + static_cast<std::int64_t>(i) * kFrame.ns);
        }
    }
    Json read_facts() const { return Json::parse(read_file(folder_ + "/run.json")); }

    std::string folder_;
    Worker first_{"first"};
    Worker second_{"second"};
    SystemTable<2U, 2U, 0U, 0U> table_ =
        system(frame(kFrame), window("upper", 0_ms, 15_ms, budget(10_ms), run(first_)),
               window("lower", 0_ms, 20_ms, budget(19_ms), core(1U), run(second_)));
    IntrospectionFor<decltype(table_)> introspection_{table_};
    ExecutiveFor<decltype(table_)> upper_{table_};
    ExecutiveFor<decltype(table_)> lower_{table_, 1U};
    std::array<WindowThread, 2U> upper_threads_;
    std::array<WindowThread, 2U> lower_threads_;
    TimingOptions options_{5U, {}, 80, {}, {}};
};

TEST_F(TimingRunTest, ACompleteRunWritesAllWindowInstancesAndStepsOfAllCores) {
    verifies("SWR-TIM-003");
    if (!has_two_processors()) {
        GTEST_SKIP() << "verdict=not-shown: needs two processors";
    }
    const TimingResult result = run_timing({{upper_, upper_threads_}, {lower_, lower_threads_}}, options_);

    EXPECT_EQ(result.message, "");
    EXPECT_EQ(result.outcome, TimingOutcome::kWhole);
    const Json facts = read_facts();
    EXPECT_EQ(facts["schema"], "mamori.timing_run/1");
    EXPECT_EQ(facts["cycles"], (Json{{"asked", 5}, {"run", 5}}));
    EXPECT_FALSE(facts["is_partial"]);
    EXPECT_EQ(facts["frame_ns"], 20'000'000);
    EXPECT_GT(facts["reference_ns"], 0);
    EXPECT_EQ(facts["lost_rows"], 0);
    for (const char* right : {"priority", "processor", "memory"}) {
        EXPECT_EQ(facts["rights"][right]["is_granted"], facts["rights"][right]["errno"] == 0) << right;
    }
    EXPECT_EQ(read_row_count(folder_ + "/openings.npy"), 10U);
    EXPECT_EQ(Json::parse(read_file(folder_ + "/table.json"))["components"].size(), 2U);
    // If the host stalls for longer than a window, windows are skipped and their steps are missing.
    const auto run_count = static_cast<std::size_t>(first_.run_count + second_.run_count);
    EXPECT_GE(read_row_count(folder_ + "/steps.npy"), run_count);
    EXPECT_LE(read_row_count(folder_ + "/steps.npy"), 2U * run_count);
}

TEST_F(TimingRunTest, EachWindowAndStepHasARowOfItsUseOfTheProcessor) {
    verifies("SWR-TIM-042", Technique::kInterface);
    ASSERT_EQ(run_timing({{upper_, upper_threads_}}, options_).outcome, TimingOutcome::kWhole);

    const std::size_t steps = read_row_count(folder_ + "/steps.npy");
    EXPECT_EQ(read_row_count(folder_ + "/window_use.npy"), 5U);
    EXPECT_EQ(read_row_count(folder_ + "/step_use.npy"), steps);
    const std::string use = read_file(folder_ + "/step_use.npy");
    for (std::size_t row = 0U; row < steps; ++row) {
        std::int64_t cpu_ns = 0;
        std::memcpy(&cpu_ns, &use[use.size() - 16U * (steps - row)], sizeof cpu_ns);
        EXPECT_GT(cpu_ns, 0);
    }
    const Json switches = read_facts()["switches"];
    ASSERT_EQ(switches["cores"].size(), 1U);
    const Json& core = switches["cores"][0];
    EXPECT_EQ(core["right"]["is_granted"], core["right"]["errno"] == 0);
    EXPECT_GT(core["runner"], 0);
    EXPECT_EQ(core["window_threads"].size(), 2U);
    EXPECT_EQ(core["window_threads"][1], 0) << "this window belongs to the other core";
    EXPECT_TRUE(switches["continued_ns"].empty());
}

TEST_F(TimingRunTest, TheStateOfTheSystemIsWrittenForEachWindow) {
    verifies("SWR-TIM-046");
    options_.states = {{"slow", false}, {"fast \"one\"", true}};
    options_.get_state = [this] { return static_cast<std::size_t>(first_.run_count > 2 ? 1 : 0); };

    ASSERT_EQ(run_timing({{upper_, upper_threads_}}, options_).outcome, TimingOutcome::kWhole);

    EXPECT_EQ(read_facts()["states"], (Json{{{"name", "slow"}, {"is_operating", false}},
                                            {{"name", "fast  one "}, {"is_operating", true}}}));
    const std::string use = read_file(folder_ + "/window_use.npy");
    std::uint32_t last = 0U;
    std::memcpy(&last, &use[use.size() - 28U], sizeof last);
    EXPECT_EQ(last, 1U);
}

TEST_F(TimingRunTest, StatesWithoutGetStateAreRejected) {
    verifies("SWR-TIM-046", Technique::kErrorGuessing, Polarity::kViolation);
    options_.states = {{"slow", false}};

    EXPECT_EQ(run_timing({{upper_, upper_threads_}}, options_).outcome, TimingOutcome::kRefused);
    options_.states.clear();
    options_.get_state = [] { return std::size_t{0U}; };
    const TimingResult result = run_timing({{upper_, upper_threads_}}, options_);

    EXPECT_EQ(result.outcome, TimingOutcome::kRefused);
    EXPECT_NE(result.message.find("get_state"), std::string::npos);
}

TEST_F(TimingRunTest, PlannedInstantsAreMultiplesOfThePeriodApart) {
    verifies("SWR-PRT-038");
    ASSERT_EQ(run_timing({{upper_, upper_threads_}}, options_).outcome, TimingOutcome::kWhole);

    expect_whole_periods();
}

TEST_F(TimingRunTest, PlannedInstantsStayMultiplesApartAfterADelayOfTwoPeriods) {
    verifies("SWR-PRT-038", Technique::kFaultInjection, Polarity::kViolation);
    Delayer delayer;
    ASSERT_EQ(run_timing({{upper_, upper_threads_, &delayer}}, options_).outcome, TimingOutcome::kWhole);

    expect_whole_periods();
}

TEST_F(TimingRunTest, BlocksWithAndWithoutRequestsAlternate) {
    verifies("SWR-TIM-041");
    upper_.set_introspection(&introspection_);
    options_.with_requests = true;
    options_.introspection = &introspection_;
    options_.cycles = 110U;

    ASSERT_EQ(run_timing({{upper_, upper_threads_}}, options_).outcome, TimingOutcome::kWhole);

    const Json requests = read_facts()["requests"];
    EXPECT_EQ(requests["block_cycles"], 25);
    EXPECT_EQ(requests["paces"], (Json{0, 0, 1, 2, 1}));
    EXPECT_GT(requests["count"], 0);
}

TEST_F(TimingRunTest, RequestsWithoutIntrospectionAreRejectedBeforeTheRun) {
    verifies("SWR-TIM-041", Technique::kErrorGuessing, Polarity::kViolation);
    options_.with_requests = true;

    const TimingResult result = run_timing({{upper_, upper_threads_}}, options_);

    EXPECT_EQ(result.outcome, TimingOutcome::kRefused);
    EXPECT_NE(result.message.find("--requests"), std::string::npos) << result.message;
    EXPECT_EQ(first_.run_count, 0);
}

TEST_F(TimingRunTest, EachCoreRunsItsWindowsInAllRequestedMajorFrames) {
    verifies("SWR-TIM-002");
    if (!has_two_processors()) {
        GTEST_SKIP() << "verdict=not-shown: needs two processors";
    }
    EXPECT_EQ(run_timing({{upper_, upper_threads_}, {lower_, lower_threads_}}, options_).outcome,
              TimingOutcome::kWhole);

    EXPECT_EQ(get_exit_status(TimingOutcome::kWhole), 0);
    // If the host stalls for a complete window, the window is skipped.
    EXPECT_GE(first_.run_count, 1);
    EXPECT_LE(first_.run_count, 5);
    EXPECT_GE(second_.run_count, 1);
    EXPECT_LE(second_.run_count, 5);
}

TEST_F(TimingRunTest, AnInterruptedRunWritesItsDataAndMarksItAsPartial) {
    verifies("SWR-TIM-002", Technique::kErrorGuessing, Polarity::kViolation);
    options_.cycles = 100'000U;
    first_.signal_at = 3;

    const TimingResult result = run_timing({{upper_, upper_threads_}}, options_);

    EXPECT_EQ(result.outcome, TimingOutcome::kInterrupted);
    EXPECT_EQ(get_exit_status(result.outcome), 130);
    const Json facts = read_facts();
    EXPECT_TRUE(facts["is_partial"]);
    EXPECT_EQ(facts["cycles"]["asked"], 100'000);
    EXPECT_LT(facts["cycles"]["run"], 100'000);
    EXPECT_GE(read_row_count(folder_ + "/openings.npy"), 3U);
}

/// All data of work that never returns; exists until the process ends.
struct HangingSystem {
    Worker worker{"hanging"};
    SystemTable<1U, 1U, 0U, 0U> table =
        system(frame(20_ms), window("only", 0_ms, 15_ms, budget(10_ms), run(worker)));
    ExecutiveFor<decltype(table)> executive{table};
    std::array<WindowThread, 1U> threads;
};

TEST_F(TimingRunTest, HangingWorkIsAStepWithoutEndAndTheRunContinues) {
    verifies("SWR-TIM-002", Technique::kFaultInjection, Polarity::kViolation);
    static HangingSystem hanging;
    hanging.worker.hang_at = 2;
    ASSERT_EQ(hanging.executive.initialize(), Status::kOk);
    ASSERT_EQ(hanging.executive.start(), Status::kOk);

    options_.cycles = 50U;  // enough for two runs, even on a busy host
    const TimingResult result = run_timing({{hanging.executive, hanging.threads}}, options_);

    EXPECT_EQ(result.outcome, TimingOutcome::kWhole);
    EXPECT_EQ(read_row_count(folder_ + "/openings.npy"), 50U);
    const std::string steps = read_file(folder_ + "/steps.npy");
    EXPECT_EQ(steps.substr(steps.size() - 16U, 8U), std::string(8U, '\xFF')) << "the end of the last step";
    hanging.worker.is_freed = true;
}

TEST_F(TimingRunTest, InvalidOptionsAreRejectedBeforeTheRun) {
    verifies("SWR-TIM-002", Technique::kBoundaryValues, Polarity::kViolation);
    options_.cycles = 0U;
    EXPECT_EQ(run_timing({{upper_, upper_threads_}}, options_).outcome, TimingOutcome::kRefused);
    options_.cycles = 1U;
    EXPECT_EQ(run_timing({}, options_).outcome, TimingOutcome::kRefused);
    options_.out = "/proc/none/of/this";
    const TimingResult result = run_timing({{upper_, upper_threads_}}, options_);
    EXPECT_EQ(result.outcome, TimingOutcome::kRefused);
    EXPECT_NE(result.message.find("/proc/none/of/this"), std::string::npos);

    EXPECT_EQ(first_.run_count, 0);
    EXPECT_FALSE(std::filesystem::exists(folder_));
}

TEST_F(TimingRunTest, CyclesThatExceedTheMemoryAreRejected) {
    verifies("SWR-TIM-002", Technique::kBoundaryValues, Polarity::kViolation);
    for (const std::uint64_t cycles :
         {std::uint64_t{100'000'000'000U}, std::numeric_limits<std::uint64_t>::max()}) {
        options_.cycles = cycles;
        const TimingResult result = run_timing({{upper_, upper_threads_}}, options_);

        EXPECT_EQ(result.outcome, TimingOutcome::kRefused) << cycles;
        EXPECT_NE(result.message.find("run fewer"), std::string::npos) << result.message;
    }
    options_.cycles = 1U;
    for (const int priority : {10, 100}) {
        options_.priority = priority;
        EXPECT_EQ(run_timing({{upper_, upper_threads_}}, options_).outcome, TimingOutcome::kRefused)
            << priority;
    }
    EXPECT_FALSE(std::filesystem::exists(folder_));
}

TEST_F(TimingRunTest, AFileThatCannotBeWrittenFailsTheRunAndLeavesNoFacts) {
    verifies("SWR-TIM-003", Technique::kFaultInjection, Polarity::kViolation);
    std::filesystem::create_directories(folder_ + "/steps.npy.part");
    std::ofstream{folder_ + "/run.json"} << "of an earlier run";

    const TimingResult result = run_timing({{upper_, upper_threads_}}, options_);

    EXPECT_EQ(result.outcome, TimingOutcome::kFailed);
    EXPECT_EQ(get_exit_status(result.outcome), 1);
    EXPECT_NE(result.message.find("steps.npy: cannot be written"), std::string::npos) << result.message;
    EXPECT_FALSE(std::filesystem::exists(folder_ + "/run.json")) << "a folder with it counts as complete";
}

TEST_F(TimingRunTest, AnEarlierResultThatCannotBeRemovedIsNamedBeforeTheRun) {
    verifies("SWR-TIM-003", Technique::kFaultInjection, Polarity::kViolation);
    std::filesystem::create_directories(folder_ + "/openings.npy/full");

    const TimingResult result = run_timing({{upper_, upper_threads_}}, options_);

    EXPECT_EQ(result.outcome, TimingOutcome::kFailed);
    EXPECT_NE(result.message.find("openings.npy: an earlier result cannot be removed"), std::string::npos)
        << result.message;
    EXPECT_EQ(first_.run_count, 0);
}

TEST_F(TimingRunTest, ASignalDuringWritingLosesNoData) {
    verifies("SWR-TIM-002", Technique::kErrorGuessing, Polarity::kViolation);
    options_.tell_notes = [] {
        static_cast<void>(raise(SIGTERM));
        return std::vector<std::string>{"said \"at the end\""};
    };

    EXPECT_EQ(run_timing({{upper_, upper_threads_}}, options_).outcome, TimingOutcome::kWhole);

    EXPECT_FALSE(read_facts()["is_partial"]);
    EXPECT_EQ(read_facts()["notes"], (Json{"said  at the end "}));
}

TEST_F(TimingRunTest, FindingsOfTheProgramAreWritten) {
    verifies("SWR-TIM-005");
    ASSERT_EQ(run_timing({{upper_, upper_threads_}}, options_).outcome, TimingOutcome::kWhole);
    EXPECT_EQ(read_facts()["findings"], Json::array());

    options_.tell_findings = [] { return std::vector<std::string>{"the arm stands", "and why"}; };
    ASSERT_EQ(run_timing({{upper_, upper_threads_}}, options_).outcome, TimingOutcome::kWhole);

    EXPECT_EQ(read_facts()["findings"], (Json{"the arm stands", "and why"}));
}

TEST_F(TimingRunTest, MoreCoresThanProcessorsAreRejected) {
    verifies("SWR-TIM-002", Technique::kBoundaryValues, Polarity::kViolation);
    cpu_set_t before;
    ASSERT_EQ(sched_getaffinity(0, sizeof(before), &before), 0);
    cpu_set_t one;
    CPU_ZERO(&one);
    for (std::size_t processor = 0U; CPU_COUNT(&one) == 0; ++processor) {
        if (CPU_ISSET(processor, &before)) {
            CPU_SET(processor, &one);
        }
    }
    ASSERT_EQ(sched_setaffinity(0, sizeof(one), &one), 0);
    const TimingResult result = run_timing({{upper_, upper_threads_}, {lower_, lower_threads_}}, options_);
    ASSERT_EQ(sched_setaffinity(0, sizeof(before), &before), 0);

    EXPECT_EQ(result.outcome, TimingOutcome::kRefused);
    EXPECT_NE(result.message.find("2 cores"), std::string::npos) << result.message;
    EXPECT_EQ(first_.run_count, 0);
}

/// Binds the calling thread, and the threads that it starts, to the first processor that it may use.
class OneProcessor final {
  public:
    OneProcessor() {
        static_cast<void>(sched_getaffinity(0, sizeof(before_), &before_));
        cpu_set_t one;
        CPU_ZERO(&one);
        for (std::size_t processor = 0U; CPU_COUNT(&one) == 0; ++processor) {
            if (CPU_ISSET(processor, &before_)) {
                CPU_SET(processor, &one);
            }
        }
        static_cast<void>(sched_setaffinity(0, sizeof(one), &one));
    }
    OneProcessor(const OneProcessor&) = delete;
    OneProcessor& operator=(const OneProcessor&) = delete;
    ~OneProcessor() { static_cast<void>(sched_setaffinity(0, sizeof(before_), &before_)); }

  private:
    cpu_set_t before_{};
};

TEST(TimingBackgroundTest, BackgroundWindowsRunBelowTheOrdinaryOnesOnTheProcessorOfTheirCore) {
    verifies("SWR-PRT-084", Technique::kBoundaryValues, Polarity::kViolation);
    static Worker loop{"loop"};
    static Worker plan{"plan"};
    static constexpr auto kTable =
        system(frame(20_ms), window("plan", 0_ms, 20_ms, background(), budget(5_ms), run(plan)),
               window("loop", 0_ms, 2_ms, every(5_ms), budget(2_ms), run(loop)));
    static ExecutiveFor ordinary{kTable};
    static ExecutiveFor background_windows{kTable, 1U};
    static std::array<WindowThread, 2U> threads;
    static std::array<WindowThread, 2U> background_threads;
    for (Executive* executive :
         {static_cast<Executive*>(&ordinary), static_cast<Executive*>(&background_windows)}) {
        ASSERT_EQ(executive->initialize(), Status::kOk);
    }
    ASSERT_EQ(ordinary.start(), Status::kOk);
    ASSERT_EQ(background_windows.start(), Status::kOk);
    TimingOptions options{3U, ::testing::TempDir() + "timing_background_test", 12, {}, {}};
    // The core of a background window may follow it.
    const std::vector<TimedCore> cores{{background_windows, background_threads}, {ordinary, threads}};
    const OneProcessor one;

    const TimingResult refused = run_timing(cores, options);
    EXPECT_EQ(refused.outcome, TimingOutcome::kRefused);
    EXPECT_NE(refused.message.find("13 .. 99"), std::string::npos) << refused.message;
    options.priority = 13;
    const TimingResult whole = run_timing(cores, options);

    ASSERT_EQ(whole.outcome, TimingOutcome::kWhole) << whole.message;
    EXPECT_EQ(read_row_count(options.out + "/openings.npy"), 15U);
    // If the host stalls for a complete window, the window is skipped.
    EXPECT_GE(plan.run_count, 1);
    EXPECT_LE(plan.run_count, 3);
    EXPECT_GE(loop.run_count, 1);
    EXPECT_LE(loop.run_count, 12);
}

}  // namespace
}  // namespace mamori::timing
