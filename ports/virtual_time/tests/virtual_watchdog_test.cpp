// SPDX-License-Identifier: Apache-2.0
// Goal: the relay opens when the service fails to come, and never closes again. Method: services at chosen
// instants.
#include "mamori/ports/virtual_time/virtual_watchdog.hpp"

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::ports::virtual_time {
namespace {

using namespace verification;

TEST(VirtualWatchdogTest, RelayStaysClosedWhileTheServiceComesInTime) {
    verifies("SWR-VTM-005", Technique::kBoundaryValues);
    VirtualWatchdog sut{5_ms};
    sut.check(Instant{} + 100_ms);
    EXPECT_FALSE(sut.has_expired()) << "not started yet";
    EXPECT_FALSE(sut.is_watching());

    ASSERT_EQ(sut.service(Instant{} + 100_ms), Status::kOk);
    sut.check(Instant{} + 105_ms);
    EXPECT_FALSE(sut.has_expired());
    EXPECT_TRUE(sut.is_watching());
    EXPECT_EQ(sut.service(Instant{} + 105_ms), Status::kOk);
}

TEST(VirtualWatchdogTest, RelayOpensForGoodAfterTheTimeout) {
    verifies("SWR-VTM-005", Technique::kFaultInjection, Polarity::kViolation);
    VirtualWatchdog sut{5_ms};
    ASSERT_EQ(sut.service(Instant{}), Status::kOk);

    sut.check(Instant{} + 5_ms + 1_ns);
    EXPECT_TRUE(sut.has_expired());
    EXPECT_FALSE(sut.is_watching());
    EXPECT_EQ(sut.service(Instant{} + 6_ms), Status::kError);
    EXPECT_TRUE(sut.has_expired());
}

TEST(VirtualWatchdogTest, TimeoutThatIsNoTimeIsRejected) {
    verifies("SWR-VTM-005", Technique::kBoundaryValues, Polarity::kViolation);
    const auto make = [](Duration timeout) {
        const VirtualWatchdog watchdog{timeout};
        return watchdog.is_watching();
    };

    EXPECT_FALSE(make(1_ns));
    EXPECT_CHECK_FAILS(static_cast<void>(make(0_ns)), "virtual_watchdog.hpp", 1);
}

TEST(VirtualWatchdogTest, LateServiceDoesNotHideTheTimeout) {
    verifies("SWR-VTM-005", Technique::kErrorGuessing, Polarity::kViolation);
    VirtualWatchdog sut{5_ms};
    ASSERT_EQ(sut.service(Instant{}), Status::kOk);

    EXPECT_EQ(sut.service(Instant{} + 6_ms), Status::kError);
    EXPECT_TRUE(sut.has_expired());
}

TEST(VirtualWatchdogTest, ClockThatRunsBackwardsOpensTheRelay) {
    verifies("SWR-VTM-005", Technique::kErrorGuessing, Polarity::kViolation);
    VirtualWatchdog sut{5_ms};
    ASSERT_EQ(sut.service(Instant{} + 10_ms), Status::kOk);

    sut.check(Instant{} + 9_ms);
    EXPECT_TRUE(sut.has_expired());
}

}  // namespace
}  // namespace mamori::ports::virtual_time
