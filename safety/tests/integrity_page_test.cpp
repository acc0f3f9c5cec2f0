// SPDX-License-Identifier: Apache-2.0
// Goal: what docs/manual/integrity.md shows compiles and does what the page says. Method: its blocks, run
// with and without a fault each. verification/checks/manual_samples.py compares the two.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "mamori/trace/verifies.hpp"

// clang-format off
#include <array>

#include "mamori/safety/assumptions/assumption_checks.hpp"
#include "mamori/safety/assumptions/assumption_monitor.hpp"
#include "mamori/safety/reaction/fault_register.hpp"
#include "mamori/safety/redundancy/complement_stored.hpp"
#include "mamori/safety/redundancy/cross_comparison.hpp"
#include "mamori/safety/redundancy/time_base_check.hpp"
#include "mamori/safety/redundancy/voter.hpp"
#include "mamori/safety/self_test/cpu_check.hpp"
#include "mamori/safety/self_test/march.hpp"
#include "mamori/safety/self_test/ram_area.hpp"
#include "mamori/safety/self_test/region_crc.hpp"
#include "mamori/safety/self_test/schedule.hpp"

namespace arm {

namespace safety = mamori::safety;
using namespace mamori::literals;

enum class Fault : safety::FaultIndex { kLimitCorrupted, kSpeedUnknown, kSpeedChannelA, kChannelsDiffer, kTimeBase, kCount };

std::array<safety::FaultRecord, static_cast<std::size_t>(Fault::kCount)> fault_records;
safety::FaultRegister faults{fault_records};

void report(Fault fault, bool is_present, mamori::Instant now) {
    faults.report(static_cast<safety::FaultIndex>(fault), is_present, now);
}

}  // namespace arm
// clang-format on
namespace arm {
namespace {

// What the page leaves to the build and to the hardware.
constexpr std::array<std::byte, 9U> kDigits{std::byte{'1'}, std::byte{'2'}, std::byte{'3'},
                                            std::byte{'4'}, std::byte{'5'}, std::byte{'6'},
                                            std::byte{'7'}, std::byte{'8'}, std::byte{'9'}};
mamori::Span<const std::byte> get_constants() {
    return {kDigits.data(), kDigits.size()};
}
std::uint32_t get_constants_crc_as_built() {
    return 0xCBF43926U;
}
constexpr std::uint32_t kWatchdogEnabled = 1U;
std::uint32_t watchdog_register = kWatchdogEnabled;
const volatile std::uint32_t* const watchdog_control = &watchdog_register;

}  // namespace
}  // namespace arm
// clang-format off

namespace arm {

safety::ComplementStored<double> limit_rad_s{1.5};

bool is_too_fast(double speed_rad_s, mamori::Instant now) {
    const mamori::Result<double> limit = limit_rad_s.read();
    report(Fault::kLimitCorrupted, !limit.has_value(), now);  // a bit has changed: nothing is calculated with it
    return !limit.has_value() || !(speed_rad_s <= limit.get_value());
}

}  // namespace arm
namespace arm {

safety::ValueVoter2oo3 speed{{0.05, 20_ms, safety::WorseValue::kFurtherFromZero}};  // tolerance [rad/s], discrepancy time

void judge_speed(const std::array<double, 3U>& channels_rad_s, mamori::Instant now) {
    const mamori::Result<double> voted = speed.step(channels_rad_s, now);
    report(Fault::kSpeedUnknown, !voted.has_value() || is_too_fast(voted.get_value(), now), now);
    report(Fault::kSpeedChannelA, speed.get_discrepancy(0U) == safety::Discrepancy::kLatched, now);
}

}  // namespace arm
namespace arm {

/// All that is compared.
struct PortSet {
    double measured_rad{0.0};
    double commanded_nm{0.0};
    bool is_stop_demanded{false};
};

}  // namespace arm
MAMORI_FIELDS(arm::PortSet, measured_rad, commanded_nm, is_stop_demanded)
namespace arm {

constexpr PortSet kTolerance{0.002, 0.5, false};  // absolute, one per number; 0 and false for what is compared exactly
safety::CrossComparison<PortSet, kTolerance> comparison{10_ms};
safety::TimeBaseCheck time_base{{2U, {1_s, 200U}}};  // cycles apart; window and deviation [ppm] of the clocks

/// One controller: its own values and those of the other one, which came over a protected channel.
struct Controller {
    PortSet ports{};
    safety::ChannelTime time{};
};

void compare(const Controller& own, const Controller& other) {
    const mamori::Instant now = own.time.now;
    report(Fault::kChannelsDiffer, comparison.step(own.ports, other.ports, now) == safety::Discrepancy::kLatched, now);
    report(Fault::kTimeBase, time_base.step(own.time, other.time) != safety::TimeBaseFinding::kNone, now);
}

}  // namespace arm
namespace arm {

std::array<safety::RamArea::Word, 256U> reserved_words;  // used by nobody else
safety::RamArea reserved{reserved_words.data(), reserved_words.size()};
safety::RamMarch<safety::RamArea> march{reserved, 64U};                        // words per step
safety::RegionCrc constants{get_constants(), get_constants_crc_as_built(), 256U};  // bytes per step
safety::CpuCheck<safety::NativeCpu> cpu;
const std::array<safety::SelfTest*, 3U> tests{{&march, &constants, &cpu}};
safety::SelfTestSchedule schedule{{tests.data(), tests.size()}, 60_s};  // the test interval

/// At power-up, and whenever the safe-state machine comes back to kSelfTest.
mamori::Status begin_self_tests(mamori::Instant now) {
    return schedule.start(now, 10_ms);  // kBadParameter: steps of 10 ms do not fit into the interval
}

}  // namespace arm
namespace arm {

class WatchdogArmed final : public safety::Provision {
  public:
    bool is_in_effect() noexcept override { return (*watchdog_control & kWatchdogEnabled) != 0U; }
};

WatchdogArmed watchdog_armed;
safety::ProvisionCheck watchdog_check{watchdog_armed};
safety::CpuCheck<safety::NativeCpu> fpu;
safety::SelfTestCheck fpu_check{fpu};

enum class Assumption : safety::AssumptionIndex { kWatchdog, kFpuMode, kCount };
constexpr std::array kAssumptions{
    safety::assume(Assumption::kWatchdog, "watchdog", watchdog_check, 100_ms),
    safety::assume(Assumption::kFpuMode, "mode of the floating-point unit", fpu_check, 100_ms),
};
static_assert(safety::checks_all<kAssumptions, Assumption::kCount>());  // every declared one has a check
safety::AssumptionMonitor assumptions{kAssumptions};

/// For SafeStateInputs::self_test, in every cycle.
safety::SelfTestStatus step_self_tests(mamori::Instant now) {
    return safety::combine(schedule.step(now), assumptions.step(now));
}

}  // namespace arm
// clang-format on

namespace arm {
namespace {

using mamori::Instant;
using mamori::verification::Polarity;
using mamori::verification::Technique;
using mamori::verification::verifies;
using safety::SelfTestStatus;

class IntegrityPageTest : public ::testing::Test {
  protected:
    void SetUp() override {
        limit_rad_s.set(1.5);
        watchdog_register = kWatchdogEnabled;
        fault_records.fill({});
        faults = safety::FaultRegister{fault_records};
        speed = decltype(speed){{0.05, 20_ms, safety::WorseValue::kFurtherFromZero}};
        comparison = decltype(comparison){10_ms};
        assumptions = safety::AssumptionMonitor{kAssumptions};
    }
    static bool is_latched(Fault fault) { return faults.is_latched(static_cast<safety::FaultIndex>(fault)); }
    /// Both tests of the page, cycle by cycle. @return the answer of the last one of `cycles`.
    SelfTestStatus run(int cycles) {
        SelfTestStatus status = SelfTestStatus::kRunning;
        for (int i = 0; i < cycles; ++i) {
            now_ = now_ + 10_ms;
            status = step_self_tests(now_);
        }
        return status;
    }
    Instant now_{0};
};

TEST_F(IntegrityPageTest, ExampleIsQuietWhileNothingIsWrong) {
    verifies("SWR-AOU-010", Technique::kInterface);
    for (std::uint32_t cycle = 0U; cycle < 300U; ++cycle) {
        now_ = now_ + 10_ms;
        judge_speed({{1.0, 1.01, 1.02}}, now_);
        const Controller own{{1.0, 2.0, false}, {cycle, now_}};
        const Controller other{{1.001, 2.4, false}, {cycle + 1U, now_ + 1_ms}};
        compare(own, other);
    }

    EXPECT_EQ(faults.get_latched_count(), 0U);
    ASSERT_EQ(begin_self_tests(now_), mamori::Status::kOk);
    EXPECT_EQ(run(static_cast<int>(schedule.calc_step_count())), SelfTestStatus::kPassed);
}

TEST_F(IntegrityPageTest, ExampleSaysWhatIsWrong) {
    verifies("SWR-AOU-010", Technique::kFaultInjection);
    EXPECT_TRUE(is_too_fast(1.6, now_));
    EXPECT_FALSE(is_too_fast(1.5, now_));
    EXPECT_TRUE(is_too_fast(std::numeric_limits<double>::quiet_NaN(), now_));
    ASSERT_FALSE(is_latched(Fault::kLimitCorrupted));
    reinterpret_cast<unsigned char*>(&limit_rad_s)[3] ^= 4U;  // NOLINT: memory that changes by itself
    EXPECT_TRUE(is_too_fast(0.0, now_));
    EXPECT_TRUE(is_latched(Fault::kLimitCorrupted));
    limit_rad_s.set(1.5);

    for (std::uint32_t cycle = 0U; cycle < 4U; ++cycle) {
        now_ = now_ + 10_ms;
        judge_speed({{9.0, 1.0, 1.0}}, now_);
        compare({{1.0, 0.0, false}, {cycle, now_}}, {{1.0, 0.0, true}, {cycle + 3U, now_}});
    }
    EXPECT_TRUE(is_latched(Fault::kSpeedChannelA));
    EXPECT_FALSE(is_latched(Fault::kSpeedUnknown)) << "two agree";
    EXPECT_TRUE(is_latched(Fault::kChannelsDiffer));
    EXPECT_TRUE(is_latched(Fault::kTimeBase));
}

TEST_F(IntegrityPageTest, ExampleNamesTheAssumptionThatIsLost) {
    verifies("SWR-AOU-010", Technique::kFaultInjection);
    ASSERT_EQ(begin_self_tests(now_), mamori::Status::kOk);
    ASSERT_EQ(run(static_cast<int>(schedule.calc_step_count())), SelfTestStatus::kPassed);

    watchdog_register = 0U;
    EXPECT_EQ(run(1), SelfTestStatus::kFailed);
    EXPECT_STREQ(assumptions.get_failed_name(), "watchdog");
}

}  // namespace
}  // namespace arm
