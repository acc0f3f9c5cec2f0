// SPDX-License-Identifier: Apache-2.0
// Goal: each platform property reports whether it is in effect, not in effect or not known on the running
// system. Method: the tests lock, unlock and map memory, change modes of the floating-point unit and set
// priorities of threads. The watchdog drivers are simulated, since a real watchdog would reset the computer.
#include "mamori/ports/posix_rt/provisions.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cfenv>
#include <fstream>
#include <string>
#include <thread>

#include "mamori/ports/posix_rt/real_time_rights.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/fake_driver.hpp"
#include "support/refused_call.hpp"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace mamori::ports::posix_rt {
namespace {

using safety::ProvisionCheck;
using safety::SelfTestStatus;
using namespace verification;

// ---- Memory ----

class MemoryLockedTest : public ::testing::Test {
  protected:
    void TearDown() override { munlockall(); }
    /// @return false if the host denies locked memory, or if a sanitizer disables it.
    static bool lock() {
        const std::uint64_t before = read_locked_kib();
        return lock_memory(4096U).is_granted && read_locked_kib() > before;
    }
    static std::uint64_t read_locked_kib() {
        std::ifstream file{"/proc/self/status"};
        std::string word;
        std::uint64_t locked = 0U;
        while (file >> word) {
            if (word == "VmLck:") {
                file >> locked;
            }
        }
        return locked;
    }
    MemoryLocked sut_;
};

TEST_F(MemoryLockedTest, TheFileMayHaveTheFirstNumber) {
    verifies("SWR-AOU-011", Technique::kBoundaryValues);
    EXPECT_EQ(run_in_process([] {
                  ASSERT_EQ(::close(0), 0);
                  {
                      MemoryLocked sut;
                      EXPECT_EQ(sut.open(), Status::kOk);
                      EXPECT_EQ(sut.open(), Status::kPreconditionNotMet);
                      EXPECT_NE(::fcntl(0, F_GETFD), -1);
                  }
                  EXPECT_EQ(::fcntl(0, F_GETFD), -1) << "it is closed";
              }),
              0);
}

TEST_F(MemoryLockedTest, LockedMemoryIsInEffect) {
    verifies("SWR-AOU-011");
    ASSERT_EQ(sut_.open(), Status::kOk);
    EXPECT_EQ(sut_.open(), Status::kPreconditionNotMet);
    if (!lock()) {
        GTEST_SKIP() << "verdict=no-privilege: memory cannot be locked here";
    }

    EXPECT_EQ(sut_.look(), Status::kOk);
    EXPECT_TRUE(sut_.is_in_effect());
}

TEST_F(MemoryLockedTest, MemoryThatIsNotCompletelyLockedIsNotInEffect) {
    verifies("SWR-AOU-011", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.open(), Status::kOk);
    EXPECT_EQ(sut_.look(), Status::kPreconditionNotMet) << "no memory is locked yet";
    if (!lock()) {
        GTEST_SKIP() << "verdict=no-privilege: memory cannot be locked here";
    }
    ProvisionCheck check{sut_};
    ASSERT_EQ(check.check(), SelfTestStatus::kPassed);
    constexpr std::size_t kSize = 4U << 20U;
    void* const other = mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(other, MAP_FAILED);
    EXPECT_EQ(sut_.look(), Status::kOk) << "mappings are locked immediately";

    ASSERT_EQ(munlock(other, kSize), 0);
    EXPECT_EQ(sut_.look(), Status::kPreconditionNotMet);
    MemoryLocked tolerant{MemoryLocked::kKernelBytes + kSize};
    ASSERT_EQ(tolerant.open(), Status::kOk);
    EXPECT_EQ(tolerant.look(), Status::kOk) << "the application has stated this mapping";
    EXPECT_EQ(check.check(), SelfTestStatus::kFailed);
    ASSERT_EQ(munmap(other, kSize), 0);
    EXPECT_EQ(sut_.look(), Status::kOk);
}

TEST_F(MemoryLockedTest, WithoutTheFileItIsNotKnown) {
    verifies("SWR-AOU-011", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_EQ(sut_.look(), Status::kUnsupported);
    EXPECT_FALSE(sut_.is_in_effect());
}

/// Figures in a file of the test, which gets the number of the descriptor of the open file of Linux.
class MemoryFiguresTest : public ::testing::Test {
  protected:
    Status look_at(const std::string& figures, std::uint64_t unlockable = MemoryLocked::kKernelBytes) {
        MemoryLocked sut{unlockable};
        const int next = ::dup(2);  // the lowest free number
        EXPECT_EQ(::close(next), 0);
        EXPECT_EQ(sut.open(), Status::kOk);
        const int file = ::memfd_create("figures", 0U);
        EXPECT_EQ(::write(file, figures.data(), figures.size()), static_cast<ssize_t>(figures.size()));
        EXPECT_EQ(::dup2(file, next), next);
        EXPECT_EQ(::close(file), 0);
        return sut.look();
    }
    static std::string make(const std::string& mapped, const std::string& locked,
                            const std::string& swapped) {
        return "Name:\tVmSize: 1\nVmPeak:\t9 kB\nVmSize:\t " + mapped + " kB\nVmLck:\t  " + locked +
               " kB\nVmSwap:\t" + swapped + " kB\n";
    }
};

TEST_F(MemoryFiguresTest, AllButTheStatedMemoryIsLocked) {
    verifies("SWR-AOU-011", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(look_at(make("1964", "1900", "0")), Status::kOk) << "64 KiB of the kernel";
    EXPECT_EQ(look_at(make("1965", "1900", "0")), Status::kPreconditionNotMet);
    EXPECT_EQ(look_at(make("1964", "1900", "0"), 65'535U), Status::kPreconditionNotMet);
    EXPECT_EQ(look_at(make("1023", "0", "0"), 1023U * 1024U), Status::kOk);
    EXPECT_EQ(look_at(make("1024", "0", "0"), 1023U * 1024U), Status::kPreconditionNotMet);
    EXPECT_EQ(look_at(make("9876543210", "9876543210", "0"), 0U), Status::kOk);
    EXPECT_EQ(look_at(make("9876543211", "9876543210", "0"), 0U), Status::kPreconditionNotMet);
    EXPECT_EQ(look_at("\nVmSize:\t7 kB\nVmLck:\t7 kB\nVmSwap:\t0 kB\n", 0U), Status::kOk) << "from the start";
    EXPECT_EQ(look_at(make("1964", "1900", "1")), Status::kPreconditionNotMet) << "swapped memory";
    EXPECT_EQ(look_at(make("1964", "1900", "10")), Status::kPreconditionNotMet);
}

TEST_F(MemoryFiguresTest, AMissingFigureIsNotKnown) {
    verifies("SWR-AOU-011", Technique::kEquivalenceClasses, Polarity::kViolation);
    EXPECT_EQ(look_at("Name:\tx\nVmLck:\t10 kB\nVmSwap:\t0 kB\n"), Status::kUnsupported);
    EXPECT_EQ(look_at("Name:\tx\nVmSize:\t10 kB\nVmSwap:\t0 kB\n"), Status::kUnsupported);
    EXPECT_EQ(look_at("Name:\tx\nVmSize:\t10 kB\nVmLck:\t10 kB\n"), Status::kUnsupported);
    EXPECT_EQ(look_at(make("", "10", "0")), Status::kUnsupported);
    EXPECT_EQ(look_at(make("10", "", "0")), Status::kUnsupported);
    EXPECT_EQ(look_at(make("10", "10", "")), Status::kUnsupported);
    EXPECT_EQ(look_at(""), Status::kUnsupported);
}

// ---- Timers ----

TEST(PreciseTimersTest, ResultIsThatOfTheClock) {
    verifies("SWR-AOU-012", Technique::kBackToBack);
    timespec resolution{};
    ASSERT_EQ(clock_getres(CLOCK_MONOTONIC, &resolution), 0);
    const bool is_precise = resolution.tv_sec == 0 && resolution.tv_nsec <= 1000;

    PreciseTimers sut;
    EXPECT_EQ(sut.look(), is_precise ? Status::kOk : Status::kPreconditionNotMet);
}

TEST(PreciseTimersTest, ClockWithTicksOrUnknownResolutionIsNotInEffect) {
    verifies("SWR-AOU-012", Technique::kFaultInjection, Polarity::kViolation);
    PreciseTimers coarse{CLOCK_MONOTONIC_COARSE};
    PreciseTimers none{12345};

    EXPECT_EQ(coarse.look(), Status::kPreconditionNotMet);
    EXPECT_EQ(none.look(), Status::kUnsupported);
}

// ---- Floating-point unit ----

TEST(FloatingPointModeTest, InitialModeOfAProgramIsInEffect) {
    verifies("SWR-AOU-013");
    FloatingPointMode sut;

    EXPECT_EQ(sut.look(), Status::kOk);
}

TEST(FloatingPointModeTest, OtherRoundingIsNotInEffect) {
    verifies("SWR-AOU-013", Technique::kFaultInjection, Polarity::kViolation);
    FloatingPointMode sut;
    for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
        ASSERT_EQ(std::fesetround(mode), 0);
        const Status status = sut.look();
        ASSERT_EQ(std::fesetround(FE_TONEAREST), 0);
        EXPECT_EQ(status, Status::kPreconditionNotMet) << mode;
    }
    EXPECT_EQ(sut.look(), Status::kOk);
}

TEST(FloatingPointModeTest, FlushedDenormalsAreNotInEffect) {
    verifies("SWR-AOU-013", Technique::kFaultInjection, Polarity::kViolation);
#if defined(__SSE2__)
    FloatingPointMode sut;
    const unsigned int mode = _mm_getcsr();  // of results, then of operands
    _mm_setcsr(mode | 0x8000U);
    const Status flushed = sut.look();
    _mm_setcsr(mode | 0x0040U);
    const Status zero = sut.look();
    _mm_setcsr(mode);

    EXPECT_EQ(flushed, Status::kPreconditionNotMet);
    EXPECT_EQ(zero, Status::kPreconditionNotMet);
    EXPECT_EQ(sut.look(), Status::kOk);
#else
    GTEST_SKIP() << "verdict=not-shown: the mode of this processor is set in a different way";
#endif
}

TEST(FloatingPointModeTest, ModeIsThatOfTheCallingThread) {
    verifies("SWR-AOU-013", Technique::kInterface);
    FloatingPointMode sut;
    Status other = Status::kOk;
    std::thread([&] {
        static_cast<void>(std::fesetround(FE_UPWARD));
        other = sut.look();
    }).join();

    EXPECT_EQ(other, Status::kPreconditionNotMet);
    EXPECT_EQ(sut.look(), Status::kOk);
}

// ---- Guard of budgets ----

/// Calls look() on a separate thread with the scheduling of a window. @return kError without the privilege.
Status look_with(GuardAbove& sut, int priority) {
    Status status = Status::kError;
    std::thread([&] {
        if (priority == 0 || set_priority(pthread_self(), priority).is_granted) {
            status = sut.look();
        }
    }).join();
    return status;
}

TEST(GuardAboveTest, GuardAboveTheWindowsIsInEffectAndOneAtOrBelowIsNot) {
    verifies("SWR-AOU-014", Technique::kBoundaryValues, Polarity::kViolation);
    GuardAbove sut;
    EXPECT_EQ(sut.look(), Status::kPreconditionNotMet) << "there is no guard";
    sut.set_guard();
    EXPECT_EQ(look_with(sut, 0), Status::kPreconditionNotMet) << "both are ordinary threads";
    if (!set_priority(pthread_self(), 20).is_granted) {
        GTEST_SKIP() << "verdict=no-privilege: no right for fixed priorities";
    }

    const Status below = look_with(sut, 19);
    const Status ordinary = look_with(sut, 0);  // it inherits the priority of this thread
    const Status above = look_with(sut, 21);
    ASSERT_TRUE(set_priority(pthread_self(), 0).is_granted);
    EXPECT_EQ(below, Status::kOk);
    EXPECT_EQ(ordinary, Status::kPreconditionNotMet) << "equal";
    EXPECT_EQ(above, Status::kPreconditionNotMet);
    EXPECT_EQ(look_with(sut, 19), Status::kPreconditionNotMet) << "the guard has lost its priority";
}

TEST(GuardAboveTest, GuardThatHasEndedIsNotInEffect) {
    verifies("SWR-AOU-014", Technique::kFaultInjection, Polarity::kViolation);
    GuardAbove sut;
    std::thread([&] { sut.set_guard(); }).join();

    EXPECT_EQ(sut.look(), Status::kPreconditionNotMet);
}

TEST(GuardAboveTest, GuardOfAnOrdinaryWindowIsInEffect) {
    verifies("SWR-AOU-014");
    GuardAbove sut;
    std::atomic<bool> is_ready{false};
    std::atomic<bool> is_ending{false};
    bool has_right = false;
    std::thread guard([&] {
        has_right = set_priority(pthread_self(), 20).is_granted;
        sut.set_guard();
        is_ready = true;
        while (!is_ending) {
            get_monotonic_clock().wait_until(get_monotonic_clock().read_ns() + 1'000'000);
        }
    });
    while (!is_ready) {
        std::this_thread::yield();
    }
    const Status status = sut.look();
    is_ending = true;
    guard.join();
    if (!has_right) {
        GTEST_SKIP() << "verdict=no-privilege: no right for fixed priorities";
    }

    EXPECT_EQ(status, Status::kOk);
}

// ---- Watchdogs ----

void keep_outputs(void*) noexcept {}

TEST(SoftwareWatchdogArmedTest, ItIsArmedFromTheFirstServiceUntilItIsClosed) {
    verifies("SWR-AOU-015", Technique::kStateTransition);
    const FrameClock clock = FrameClock::starting_in(0_ms);
    SoftwareWatchdog watchdog{clock, {0_ms, Duration{3'600'000'000'000}}, {&keep_outputs, nullptr, false}};
    SoftwareWatchdogArmed sut{watchdog};
    EXPECT_EQ(sut.look(), Status::kPreconditionNotMet);
    ASSERT_EQ(watchdog.open({}), Status::kOk);
    EXPECT_EQ(sut.look(), Status::kPreconditionNotMet) << "it is not active yet";

    ASSERT_EQ(watchdog.service(clock.get_now()), Status::kOk);
    EXPECT_EQ(sut.look(), Status::kOk);
    ASSERT_EQ(watchdog.close(), Status::kOk);
    EXPECT_EQ(sut.look(), Status::kPreconditionNotMet);
}

TEST(SoftwareWatchdogArmedTest, ExpiredWatchdogIsNotArmed) {
    verifies("SWR-AOU-015", Technique::kFaultInjection, Polarity::kViolation);
    const FrameClock clock = FrameClock::starting_in(0_ms);
    SoftwareWatchdog watchdog{clock, {0_ms, 1_ms}, {&keep_outputs, nullptr, false}};
    SoftwareWatchdogArmed sut{watchdog};
    ASSERT_EQ(watchdog.open({}), Status::kOk);
    ASSERT_EQ(watchdog.service(clock.get_now()), Status::kOk);
    clock.wait_until(clock.get_now() + 2_ms);

    EXPECT_EQ(sut.look(), Status::kPreconditionNotMet);
    ASSERT_EQ(watchdog.close(), Status::kOk);
    EXPECT_EQ(sut.look(), Status::kPreconditionNotMet);
}

class DeviceWatchdogArmedTest : public ::testing::Test {
  protected:
    void SetUp() override {
        FakeDriver::reset();
        ASSERT_EQ(sut_.look(), Status::kPreconditionNotMet) << "closed";
        ASSERT_EQ(device_.open("/dev/fake", 10000_ms), Status::kOk);
    }
    void TearDown() override { ASSERT_EQ(device_.disarm(), Status::kOk); }

    FakeDriver& driver_ = FakeDriver::get();
    WatchdogDevice device_{kFakeCalls};
    DeviceWatchdogArmed sut_{device_};
};

TEST_F(DeviceWatchdogArmedTest, DeviceThatCountsDownIsArmed) {
    verifies("SWR-AOU-016", Technique::kBoundaryValues);
    for (const int left_s : {1, 9}) {
        driver_.left_s = left_s;
        EXPECT_EQ(sut_.look(), Status::kOk);
        EXPECT_EQ(device_.read_time_left().get_value(), Duration{left_s * 1'000'000'000LL});
    }
}

TEST_F(DeviceWatchdogArmedTest, DeviceThatIsStoppedOrFailsIsNotArmed) {
    verifies("SWR-AOU-016", Technique::kFaultInjection, Polarity::kViolation);
    for (const int left_s : {0, -1}) {
        driver_.left_s = left_s;
        EXPECT_EQ(sut_.look(), Status::kPreconditionNotMet) << left_s;
    }
    driver_.left_s = 9;
    driver_.left_error = EIO;
    EXPECT_EQ(device_.read_time_left().get_status(), Status::kError);
    EXPECT_EQ(sut_.look(), Status::kPreconditionNotMet);
}

TEST_F(DeviceWatchdogArmedTest, DriverThatDoesNotReportTheTimeIsNotKnown) {
    verifies("SWR-AOU-016", Technique::kEquivalenceClasses, Polarity::kViolation);
    for (const int error : {EOPNOTSUPP, ENOTTY}) {
        driver_.left_error = error;
        EXPECT_EQ(sut_.look(), Status::kUnsupported);
        EXPECT_FALSE(sut_.is_in_effect());
    }
}

}  // namespace
}  // namespace mamori::ports::posix_rt
