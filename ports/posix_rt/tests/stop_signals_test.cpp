// SPDX-License-Identifier: Apache-2.0
// Goal: stop signals reach the listener while it is installed, and the handlers of the application
// afterwards. Method: signals that this thread raises.
#include "mamori/ports/posix_rt/stop_signals.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <vector>

#include "mamori/trace/verifies.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;

struct Ear final : StopListener {
    void on_stop_signal(int signal) noexcept override {
        heard.push_back(signal);
        errno = EBADF;
    }
    std::vector<int> heard;
};

std::vector<int> g_own;
void note(int signal) {
    g_own.push_back(signal);
}
void note_with_info(int signal, siginfo_t*, void*) {
    g_own.push_back(-signal);
}

/// Restores the disposition of SIGINT and SIGTERM.
class StopSignalsTest : public ::testing::Test {
  protected:
    void SetUp() override {
        g_own.clear();
        for (std::size_t i = 0U; i < kStopSignals.size(); ++i) {
            ASSERT_EQ(sigaction(kStopSignals[i], nullptr, &before_[i]), 0);
        }
    }
    void TearDown() override {
        for (std::size_t i = 0U; i < kStopSignals.size(); ++i) {
            ASSERT_EQ(sigaction(kStopSignals[i], &before_[i], nullptr), 0);
        }
    }
    static void set(int signal, void (*handler)(int)) {
        struct sigaction action{};
        action.sa_handler = handler;
        ASSERT_EQ(sigaction(signal, &action, nullptr), 0);
    }
    Ear ear_;

  private:
    std::array<struct sigaction, kStopSignals.size()> before_{};
};

TEST_F(StopSignalsTest, SignalsReachTheListenerUntilTheyAreForwarded) {
    verifies("SWR-PRT-072", Technique::kRequirementsBased, Polarity::kNominal);
    set(SIGINT, &note);
    struct sigaction with_info{};
    with_info.sa_sigaction = &note_with_info;
    with_info.sa_flags = SA_SIGINFO;
    ASSERT_EQ(sigaction(SIGTERM, &with_info, nullptr), 0);
    StopSignals sut;
    ASSERT_EQ(sut.install(ear_), Status::kOk);
    struct sigaction installed{};
    ASSERT_EQ(sigaction(SIGINT, nullptr, &installed), 0);
    EXPECT_EQ(installed.sa_flags & (SA_RESTART | SA_ONSTACK), SA_RESTART | SA_ONSTACK);

    errno = 0;
    ASSERT_EQ(raise(SIGINT), 0);
    ASSERT_EQ(raise(SIGTERM), 0);
    EXPECT_EQ(errno, 0);
    EXPECT_EQ(ear_.heard, (std::vector<int>{SIGINT, SIGTERM}));
    EXPECT_TRUE(g_own.empty());

    sut.remove();
    sut.forward(SIGTERM);
    sut.forward(SIGINT);
    EXPECT_EQ(g_own, (std::vector<int>{-SIGTERM, SIGINT}));
    EXPECT_EQ(ear_.heard.size(), 2U);
}

TEST_F(StopSignalsTest, DefaultActionIsNotForwardedAndAnIgnoredSignalStaysIgnored) {
    verifies("SWR-PRT-072", Technique::kErrorGuessing, Polarity::kViolation);
    set(SIGINT, SIG_IGN);
    set(SIGTERM, SIG_DFL);
    StopSignals sut;
    ASSERT_EQ(sut.install(ear_), Status::kOk);

    ASSERT_EQ(raise(SIGINT), 0);
    EXPECT_TRUE(ear_.heard.empty());
    ASSERT_EQ(raise(SIGTERM), 0);
    EXPECT_EQ(ear_.heard, (std::vector<int>{SIGTERM}));
    sut.remove();
    sut.forward(SIGTERM);  // would end this program
    struct sigaction now{};
    ASSERT_EQ(sigaction(SIGTERM, nullptr, &now), 0);
    EXPECT_EQ(now.sa_handler, SIG_DFL);
}

TEST_F(StopSignalsTest, ASecondRemovalChangesNoSignal) {
    verifies("SWR-PRT-072", Technique::kStateTransition, Polarity::kViolation);
    set(SIGTERM, SIG_DFL);
    StopSignals sut;
    ASSERT_EQ(sut.install(ear_), Status::kOk);
    sut.remove();
    set(SIGTERM, SIG_IGN);

    sut.remove();
    struct sigaction now{};
    ASSERT_EQ(sigaction(SIGTERM, nullptr, &now), 0);
    EXPECT_EQ(now.sa_handler, SIG_IGN);
    EXPECT_EQ(sut.install(ear_), Status::kOk);
}

TEST_F(StopSignalsTest, OneObjectOfAProcessIsInstalled) {
    verifies("SWR-PRT-072", Technique::kErrorGuessing, Polarity::kViolation);
    Ear other;
    StopSignals second;
    {
        StopSignals first;
        ASSERT_EQ(first.install(ear_), Status::kOk);
        EXPECT_EQ(second.install(other), Status::kPreconditionNotMet);
        second.remove();
        ASSERT_EQ(raise(SIGINT), 0);
    }
    ASSERT_EQ(second.install(other), Status::kOk);
    ASSERT_EQ(raise(SIGINT), 0);
    EXPECT_EQ(ear_.heard.size(), 1U);
    EXPECT_EQ(other.heard.size(), 1U);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
