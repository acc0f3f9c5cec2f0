// SPDX-License-Identifier: Apache-2.0
// Goal: the checks that the arm puts behind its assumptions of use tell a machine that keeps them from one
// that does not. Method: a watchdog that is served or not; the real processor, in its mode and in another
// one.
#include "arm_assumptions.hpp"

#include <cfenv>
#include <string>

#include "mamori/safety/assumptions/assumption_monitor.hpp"
#include "mamori/safety/cycle/system.hpp"
#include "mamori/trace/verifies.hpp"

namespace safe_arm {
namespace {

using mamori::Instant;
using mamori::safety::AssumptionMonitor;
using mamori::safety::SelfTestStatus;
using namespace mamori::verification;

mamori::ports::virtual_time::VirtualWatchdog g_served{kWatchdogTimeout};
ArmChecks g_sound{g_served};
constexpr auto kSound = mamori::safety::system(mamori::frame(kFrame), make_arm_assumptions(g_sound));

mamori::ports::virtual_time::VirtualWatchdog g_expired{kWatchdogTimeout};
ArmChecks g_lost{g_expired};
constexpr auto kLost = mamori::safety::system(mamori::frame(kFrame), make_arm_assumptions(g_lost));

mamori::ports::virtual_time::VirtualWatchdog g_other{kWatchdogTimeout};
ArmChecks g_rounding{g_other};
constexpr auto kRounding = mamori::safety::system(mamori::frame(kFrame), make_arm_assumptions(g_rounding));

/// @return answer of the last of `frames`.
SelfTestStatus run(AssumptionMonitor& monitor, std::uint32_t frames) {
    SelfTestStatus status = SelfTestStatus::kRunning;
    for (std::uint32_t frame = 0U; frame < frames; ++frame) {
        status = monitor.step(Instant{} + kFrame * static_cast<std::int64_t>(frame));
    }
    return status;
}

TEST(ArmAssumptionsTest, MachineThatKeepsThemPassesBeforeTheSelfTestEnds) {
    verifies("SWR-SAF-021");
    AssumptionMonitor sut{kSound.assumptions};
    EXPECT_EQ(run(sut, kSelfTestFrames), SelfTestStatus::kRunning) << "the watchdog was not served yet";

    ASSERT_EQ(g_served.service(Instant{}), mamori::Status::kOk);
    EXPECT_EQ(sut.step(Instant{} + kFrame), SelfTestStatus::kPassed);
}

TEST(ArmAssumptionsTest, WatchdogThatHasOpenedItsRelayFailsAndIsNamed) {
    verifies("SWR-SAF-021", Technique::kFaultInjection, Polarity::kViolation);
    AssumptionMonitor sut{kLost.assumptions};
    ASSERT_EQ(g_expired.service(Instant{}), mamori::Status::kOk);
    ASSERT_EQ(run(sut, kSelfTestFrames), SelfTestStatus::kPassed);

    g_expired.check(Instant{} + kWatchdogTimeout + 1_ns);
    EXPECT_EQ(sut.step(Instant{} + kWatchdogTimeout + 1_ns), SelfTestStatus::kFailed);
    EXPECT_EQ(sut.get_failed(), static_cast<mamori::safety::AssumptionIndex>(ArmAssumption::kWatchdog));
    EXPECT_EQ(std::string(sut.get_failed_name()), "watchdog");
}

TEST(ArmAssumptionsTest, ProcessorInAnotherModeFailsAndIsNamed) {
    verifies("SWR-SAF-021", Technique::kFaultInjection, Polarity::kViolation);
    AssumptionMonitor sut{kRounding.assumptions};
    ASSERT_EQ(g_other.service(Instant{}), mamori::Status::kOk);

    ASSERT_EQ(std::fesetround(FE_UPWARD), 0);
    const SelfTestStatus status = run(sut, kSelfTestFrames);
    ASSERT_EQ(std::fesetround(FE_TONEAREST), 0);
    EXPECT_EQ(status, SelfTestStatus::kFailed);
    EXPECT_EQ(std::string(sut.get_failed_name()), "processor");
}

}  // namespace
}  // namespace safe_arm
