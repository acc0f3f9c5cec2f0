// SPDX-License-Identifier: Apache-2.0
// Goal: a device is accepted only if it protects within the requested time, and only disarm() stops it.
// Method: a simulated driver that complies with the Linux documentation, and device files of the host that
// are not watchdogs. No real watchdog is opened: it would reset the computer.
#include "mamori/ports/posix_rt/watchdog_device.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "mamori/trace/verifies.hpp"
#include "support/fake_driver.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;

constexpr Duration kTimeout = 10000_ms;

class WatchdogDeviceTest : public ::testing::Test {
  protected:
    WatchdogDeviceTest() { FakeDriver::reset(); }

    /// Checks that the device is rejected, and stopped if its driver permits it.
    void expect_refused(WatchdogDeviceError error, int system_error) {
        WatchdogDevice sut{kFakeCalls};
        EXPECT_EQ(sut.open("/dev/fake", kTimeout), Status::kError);
        EXPECT_EQ(sut.get_error(), error) << describe(sut.get_error());
        EXPECT_EQ(sut.get_system_error(), system_error);
        EXPECT_FALSE(sut.is_open());
        EXPECT_EQ(sut.get_timeout(), Duration{0});
        EXPECT_FALSE(driver_.is_open);
        EXPECT_FALSE(driver_.is_running);
        EXPECT_EQ(driver_.services, 0);
    }

    FakeDriver& driver_ = FakeDriver::get();
};

TEST_F(WatchdogDeviceTest, IsOpenedOnRequestOnlyAndThenSupervises) {
    verifies("SWR-PRT-023");
    WatchdogDevice sut{kFakeCalls};
    ASSERT_EQ(driver_.opens, 0);
    ASSERT_FALSE(sut.is_open());

    EXPECT_EQ(sut.open("/dev/fake", kTimeout), Status::kOk);

    EXPECT_EQ(driver_.path, "/dev/fake");
    EXPECT_TRUE(driver_.is_running);
    EXPECT_TRUE(sut.is_open());
    EXPECT_EQ(sut.get_timeout(), kTimeout);
    EXPECT_EQ(sut.service(Instant{}), Status::kOk);
    EXPECT_EQ(driver_.services, 1);
    EXPECT_EQ(sut.open("/dev/fake", kTimeout), Status::kPreconditionNotMet);
    EXPECT_EQ(sut.disarm(), Status::kOk);
}

TEST_F(WatchdogDeviceTest, TimeoutIsThatOfTheDriverAndAtMostTheRequestedOne) {
    verifies("SWR-PRT-023", Technique::kBoundaryValues, Polarity::kViolation);
    for (const Duration asked : {1000_ms, 1999_ms}) {
        WatchdogDevice sut{kFakeCalls};
        ASSERT_EQ(sut.open("/dev/fake", asked), Status::kOk);
        EXPECT_EQ(sut.get_timeout(), 1000_ms) << "rounded down to seconds";
        EXPECT_EQ(sut.disarm(), Status::kOk);
    }
    driver_.longest_s = 4;
    WatchdogDevice shorter{kFakeCalls};
    ASSERT_EQ(shorter.open("/dev/fake", kTimeout), Status::kOk);
    EXPECT_EQ(shorter.get_timeout(), 4000_ms);
    EXPECT_EQ(shorter.disarm(), Status::kOk);

    driver_.options &= ~static_cast<std::uint32_t>(WDIOF_SETTIMEOUT);
    driver_.timeout_s = 10;
    WatchdogDevice fixed{kFakeCalls};
    ASSERT_EQ(fixed.open("/dev/fake", kTimeout), Status::kOk) << "fixed timeout that is short enough";
    EXPECT_EQ(fixed.disarm(), Status::kOk);
    driver_.timeout_s = 11;
    expect_refused(WatchdogDeviceError::kCannotSetTimeout, 0);
    driver_.timeout_s = 0;
    expect_refused(WatchdogDeviceError::kCannotSetTimeout, 0);
}

TEST_F(WatchdogDeviceTest, DriverThatRejectsOrHidesItsTimeoutIsRejected) {
    verifies("SWR-PRT-023", Technique::kFaultInjection, Polarity::kViolation);
    driver_.set_error = EINVAL;
    expect_refused(WatchdogDeviceError::kCannotSetTimeout, EINVAL);
    driver_.set_error = 0;
    driver_.get_error = ENOTTY;
    expect_refused(WatchdogDeviceError::kCannotSetTimeout, ENOTTY);
}

TEST_F(WatchdogDeviceTest, DeviceThatDoesNotProtectIsRejectedAndStopped) {
    verifies("SWR-PRT-023", Technique::kEquivalenceClasses, Polarity::kViolation);
    driver_.options = WDIOF_SETTIMEOUT;
    expect_refused(WatchdogDeviceError::kStopsOnClose, 0);
    driver_.options = WDIOF_SETTIMEOUT | WDIOF_MAGICCLOSE | WDIOF_ALARMONLY;
    expect_refused(WatchdogDeviceError::kDoesNotReset, 0);
    driver_.is_watchdog = false;
    expect_refused(WatchdogDeviceError::kNotAWatchdog, ENOTTY);
    EXPECT_EQ(driver_.other_writes, 0) << "nothing is written to other devices";
}

TEST_F(WatchdogDeviceTest, DeviceThatCannotBeOpenedIsReportedWithItsCause) {
    verifies("SWR-PRT-023", Technique::kFaultInjection, Polarity::kViolation);
    driver_.open_error = EBUSY;
    expect_refused(WatchdogDeviceError::kInUse, EBUSY);
    driver_.open_error = EACCES;
    expect_refused(WatchdogDeviceError::kCannotOpen, EACCES);
}

TEST_F(WatchdogDeviceTest, ParameterOutOfRangeOpensNothing) {
    verifies("SWR-PRT-023", Technique::kBoundaryValues, Polarity::kViolation);
    WatchdogDevice sut{kFakeCalls};
    EXPECT_EQ(sut.open(nullptr, kTimeout), Status::kBadParameter);
    EXPECT_EQ(sut.open("/dev/fake", 999_ms), Status::kBadParameter);
    EXPECT_EQ(sut.open("/dev/fake", Duration{-1}), Status::kBadParameter);
    EXPECT_EQ(sut.open("/dev/fake", Duration{std::int64_t{2'147'483'648} * 1'000'000'000}),
              Status::kBadParameter);
    EXPECT_EQ(driver_.opens, 0);
}

TEST_F(WatchdogDeviceTest, FilesOfTheHostThatAreNotWatchdogsAreRejected) {
    verifies("SWR-PRT-023", Technique::kInterface, Polarity::kViolation);
    struct Case {
        const char* path;
        WatchdogDeviceError error;
        int system_error;
    };
    const std::array<Case, 4U> cases{{{"/dev/null", WatchdogDeviceError::kNotAWatchdog, ENOTTY},
                                      {"/dev/full", WatchdogDeviceError::kNotAWatchdog, ENOTTY},
                                      {"/dev", WatchdogDeviceError::kCannotOpen, EISDIR},
                                      {"/dev/null/watchdog", WatchdogDeviceError::kCannotOpen, ENOTDIR}}};
    for (const Case& example : cases) {
        WatchdogDevice sut;
        EXPECT_EQ(sut.open(example.path, kTimeout), Status::kError) << example.path;
        EXPECT_EQ(sut.get_error(), example.error) << example.path;
        EXPECT_EQ(sut.get_system_error(), example.system_error) << example.path;
        EXPECT_FALSE(sut.is_open());
    }
}

TEST_F(WatchdogDeviceTest, ResetByTheDeviceIsReported) {
    verifies("SWR-PRT-023");
    for (const int status : {0, WDIOF_CARDRESET, WDIOF_POWERUNDER}) {
        driver_.boot_status = status;
        WatchdogDevice sut{kFakeCalls};
        ASSERT_EQ(sut.open("/dev/fake", kTimeout), Status::kOk);
        EXPECT_EQ(sut.has_reset_machine(), status == WDIOF_CARDRESET);
        ASSERT_EQ(sut.disarm(), Status::kOk);
    }
}

TEST_F(WatchdogDeviceTest, TheLongestTimeoutOfADriverIsAccepted) {
    verifies("SWR-PRT-023", Technique::kBoundaryValues);
    constexpr Duration kLongest{std::int64_t{2'147'483'647} * 1'000'000'000};
    driver_.longest_s = std::numeric_limits<int>::max();
    WatchdogDevice sut{kFakeCalls};
    ASSERT_EQ(sut.open("/dev/fake", kLongest), Status::kOk);
    EXPECT_EQ(sut.get_timeout(), kLongest);
    EXPECT_EQ(sut.get_system_error(), 0);
    EXPECT_EQ(sut.disarm(), Status::kOk);
    EXPECT_EQ(sut.get_timeout(), Duration{0});
}

TEST_F(WatchdogDeviceTest, TheFirstDescriptorIsOneLikeAnyOther) {
    verifies("SWR-PRT-024", Technique::kBoundaryValues);
    driver_.device = 0;
    WatchdogDevice sut{kFakeCalls};
    ASSERT_EQ(sut.open("/dev/fake", kTimeout), Status::kOk);
    EXPECT_TRUE(sut.is_open());
    EXPECT_EQ(sut.service(Instant{}), Status::kOk);
    EXPECT_EQ(sut.disarm(), Status::kOk);
    EXPECT_FALSE(driver_.is_open);
    EXPECT_FALSE(driver_.is_running);
}

TEST_F(WatchdogDeviceTest, DisarmStopsIt) {
    verifies("SWR-PRT-024");
    WatchdogDevice sut{kFakeCalls};
    EXPECT_EQ(sut.disarm(), Status::kPreconditionNotMet);
    ASSERT_EQ(sut.open("/dev/fake", kTimeout), Status::kOk);

    EXPECT_EQ(sut.disarm(), Status::kOk);

    EXPECT_FALSE(driver_.is_running);
    EXPECT_FALSE(sut.is_open());
    EXPECT_EQ(sut.service(Instant{}), Status::kError);
    EXPECT_EQ(sut.open("/dev/fake", kTimeout), Status::kOk) << "it can be opened again";
    EXPECT_EQ(sut.disarm(), Status::kOk);
}

TEST_F(WatchdogDeviceTest, DestructionWithoutDisarmLeavesItRunning) {
    verifies("SWR-PRT-024", Technique::kFaultInjection, Polarity::kViolation);
    {
        WatchdogDevice sut{kFakeCalls};
        ASSERT_EQ(sut.open("/dev/fake", kTimeout), Status::kOk);
        ASSERT_EQ(sut.service(Instant{}), Status::kOk);
    }
    EXPECT_FALSE(driver_.is_open);
    EXPECT_TRUE(driver_.is_running);
}

TEST_F(WatchdogDeviceTest, AfterARejectedDisarmItCanStillBeServiced) {
    verifies("SWR-PRT-024", Technique::kFaultInjection, Polarity::kViolation);
    WatchdogDevice sut{kFakeCalls};
    ASSERT_EQ(sut.open("/dev/fake", kTimeout), Status::kOk);
    driver_.write_error = EIO;
    EXPECT_EQ(sut.service(Instant{}), Status::kError);
    EXPECT_EQ(sut.get_system_error(), EIO);
    EXPECT_EQ(sut.disarm(), Status::kError);
    driver_.write_error = 0;

    EXPECT_TRUE(sut.is_open());
    EXPECT_EQ(sut.service(Instant{}), Status::kOk);
    EXPECT_EQ(sut.disarm(), Status::kOk);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
