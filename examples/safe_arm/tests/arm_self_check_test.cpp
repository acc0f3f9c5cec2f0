// SPDX-License-Identifier: Apache-2.0
// Goal: the arm tests its constant table and the memory of its measured values while it moves, and stops when
// a bit of the table changes. Method: the simulated arm in motion; the read-only page of the table is made
// writable and one bit is changed. One process per run, since the table is static.
#include "arm_self_check.hpp"

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "arm_start.hpp"
#include "machine.hpp"
#include "mamori/simbody_sim/computed_torque_controller.hpp"
#include "mamori/trace/verifies.hpp"
#include "safe_arm_system.hpp"

namespace safe_arm {
namespace {

using mamori::Duration;
using mamori::Instant;
using mamori::safety::SafeState;
using namespace mamori::verification;

constexpr Instant kNever{-1};
constexpr std::uint64_t kFrames = 2400U;

struct Outcome {
    Instant operational_at{kNever};
    Instant found_at{kNever};
    Instant torque_off_at{kNever};  ///< after operation
    bool is_only_fault{true};
    std::uint32_t table_passes{0U};
    std::uint32_t memory_passes{0U};
};

/// Changes one bit of the compiled table, of a time that this run does not need.
bool change_table() {
    const auto row = executive.get_view().reactions.data() + to_index(ArmFault::kPowerLost);
    const auto address = reinterpret_cast<std::uintptr_t>(&row->within);  // NOLINT: memory that changes
    const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
    auto* const first = reinterpret_cast<void*>(address / page * page);  // NOLINT: as above
    if (::mprotect(first, page, PROT_READ | PROT_WRITE) != 0) {
        return false;
    }
    *reinterpret_cast<volatile unsigned char*>(address) ^= 0x10U;  // NOLINT: as above
    return true;
}

class Watch final : public mamori::Devices {
  public:
    Watch(Machine& machine, Instant changes_at, Outcome& outcome) noexcept
        : machine_(machine), changes_at_(changes_at), outcome_(outcome) {}

    void sample(std::uint64_t frame, Instant now) noexcept override {
        if (now == changes_at_ && !change_table()) {
            simulation.request_stop();
        }
        machine_.sample(frame, now);
    }
    void apply(std::uint64_t frame, Instant now, Duration length) noexcept override {
        machine_.apply(frame, now, length);
        note(outcome_.operational_at, supervisor.get_state() == SafeState::kOperational, now);
        const mamori::safety::FaultRegister& faults = safety_state.get_faults();
        note(outcome_.found_at, faults.is_latched(to_index(ArmFault::kSelfTestFailed)), now);
        note(outcome_.torque_off_at, outcome_.operational_at != kNever && !outputs.torque_enable, now);
        outcome_.is_only_fault = faults.get_latched_count() <= 1U && outcome_.is_only_fault;
    }

  private:
    static void note(Instant& at, bool is_true, Instant now) noexcept {
        at = is_true && at == kNever ? now : at;
    }

    Machine& machine_;
    Instant changes_at_;
    Outcome& outcome_;
};

Outcome move_arm(const mamori::sim::ArmModel& model, Instant changes_at) {
    const std::string path = ::testing::TempDir() + "arm_self_check_" + std::to_string(::getpid()) + ".txt";
    std::ofstream{path} << "0 0 0.8 0 0.8 0 0.8 1.57\n3 0.2 0.9 0.2 0.9 0.2 0.9 1.7\n";
    MotionTrack track;
    std::string error;
    const bool is_read = track.read(path, kFrameS, error);
    std::remove(path.c_str());
    Outcome outcome{};
    mamori::sim::ComputedTorqueController law{model};
    if (!is_read || !prepare_system(model, track, law).empty()) {
        return outcome;
    }
    mamori::sim::ArmPlant plant{model};
    plant.reset(track.calc_point(0.0).position_rad);
    RunRecord record{{}, model, {}, Instant{} + kMotionStart, Instant{} + kMotionStart};
    Machine machine{plant, virtual_host, {}, record};
    Watch devices{machine, changes_at, outcome};
    static_cast<void>(simulate(kFrames, devices));
    const auto tests = safety_state.get_self_tests();
    outcome.table_passes = tests[0U].get_pass_count();
    outcome.memory_passes = tests[1U].get_pass_count();
    return outcome;
}

/// move_arm() in a process of its own.
Outcome run(Instant changes_at) {
    const mamori::sim::LoadedModel loaded = mamori::sim::load_arm_model(SAFE_ARM_MODEL_FILE);
    Outcome outcome{};
    std::array<int, 2U> ends{};
    EXPECT_TRUE(loaded.model.has_value()) << loaded.error;
    EXPECT_EQ(::pipe(ends.data()), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        const Outcome result = move_arm(*loaded.model, changes_at);
        ::_exit(::write(ends[1], &result, sizeof(result)) == sizeof(result) ? 0 : 1);
    }
    static_cast<void>(::close(ends[1]));
    EXPECT_EQ(::read(ends[0], &outcome, sizeof(outcome)), static_cast<ssize_t>(sizeof(outcome)));
    static_cast<void>(::close(ends[0]));
    EXPECT_EQ(::waitpid(child, nullptr, 0), child);
    return outcome;
}

TEST(ArmSelfCheckTest, ASoundArmRepeatsItsSelfTestsAndMoves) {
    verifies("SWR-SAF-060");
    const Outcome outcome = run(kNever);

    EXPECT_NE(outcome.operational_at, kNever);
    EXPECT_LE(outcome.operational_at, Instant{} + 301_ms) << "the first passes delay no start";
    EXPECT_EQ(outcome.found_at, kNever);
    EXPECT_EQ(outcome.torque_off_at, kNever);
    EXPECT_TRUE(outcome.is_only_fault);
    // Two passes at most within the stated time.
    constexpr auto kPassesMin =
        static_cast<std::uint32_t>(kFrames * 2U * 1'000'000U / kSelfTestFoundWithin.ns);
    EXPECT_GE(outcome.table_passes, kPassesMin);
    EXPECT_GE(outcome.memory_passes, kPassesMin);
}

TEST(ArmSelfCheckTest, AChangedBitOfTheTableStopsTheArmInTime) {
    verifies("SWR-SAF-060", Technique::kFaultInjection, Polarity::kViolation);
    for (const Duration after : {400_ms, 637_ms, 851_ms, 1100_ms}) {
        const Outcome outcome = run(Instant{} + after);

        ASSERT_NE(outcome.operational_at, kNever);
        ASSERT_NE(outcome.found_at, kNever) << after.ns;
        EXPECT_LE(outcome.found_at - Instant{}, after + kSelfTestFoundWithin);
        EXPECT_LE(outcome.torque_off_at, outcome.found_at + kFrame);
        EXPECT_TRUE(outcome.is_only_fault);
    }
}

TEST(ArmSelfCheckTest, TheMarchCoversAllMeasuredValuesAndKeepsThem) {
    verifies("SWR-SAF-060", Technique::kInterface);
    static constexpr int kTable = 1;
    mamori::safety::ArmInputs measured{};
    measured.encoder_a_counts.fill(0x12345678);
    measured.mode_selected.fill(true);
    ArmSelfCheck sut{kTable, measured};

    EXPECT_EQ(sut.area.size() * sizeof(mamori::safety::RamArea::Word), sizeof(measured));
    sut.memory.begin();
    auto status = mamori::safety::SelfTestStatus::kRunning;
    for (std::size_t i = 0U; i < sut.memory.get_step_count(); ++i) {
        ASSERT_EQ(status, mamori::safety::SelfTestStatus::kRunning);
        status = sut.memory.step();
    }
    EXPECT_EQ(status, mamori::safety::SelfTestStatus::kPassed);
    EXPECT_EQ(measured.encoder_a_counts[6U], 0x12345678);
    EXPECT_TRUE(measured.mode_selected[2U]);
    EXPECT_FALSE(measured.power_good);
}

}  // namespace
}  // namespace safe_arm
