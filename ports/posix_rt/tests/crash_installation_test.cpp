// SPDX-License-Identifier: Apache-2.0
// Goal: one object owns the crash handlers, and only this object removes them. Method: the test reads the
// signal actions back from the system.
#include <gtest/gtest.h>

#include <csignal>

#include "mamori/ports/posix_rt/crash_handlers.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;

struct sigaction read_action(int signal) {
    struct sigaction action{};
    EXPECT_EQ(::sigaction(signal, nullptr, &action), 0);
    return action;
}

CrashPlan make_plan() {
    return {[](void*) noexcept {}, nullptr, {}, 0U, FrameClock::starting_in(Duration{0})};
}

TEST(CrashInstallationTest, ObjectThatIsNotInstalledRemovesNothing) {
    verifies("SWR-PRT-026", Technique::kErrorGuessing, Polarity::kViolation);
    const struct sigaction before = read_action(SIGBUS);
    CrashHandlers owner;
    ASSERT_EQ(owner.install(make_plan()), Status::kOk);
    const struct sigaction installed = read_action(SIGBUS);
    EXPECT_NE(installed.sa_sigaction, before.sa_sigaction);
    {
        CrashHandlers other;
        EXPECT_EQ(other.install(make_plan()), Status::kPreconditionNotMet);
        other.remove();
    }

    for (const int signal : kCrashSignals) {
        EXPECT_EQ(read_action(signal).sa_sigaction, installed.sa_sigaction) << signal;
        EXPECT_EQ(read_action(signal).sa_flags & (SA_SIGINFO | SA_ONSTACK), SA_SIGINFO | SA_ONSTACK)
            << signal;
    }
    CrashHandlers third;
    EXPECT_EQ(third.install(make_plan()), Status::kPreconditionNotMet) << "the owner is still installed";
    owner.remove();
    EXPECT_EQ(read_action(SIGBUS).sa_sigaction, before.sa_sigaction);
    EXPECT_EQ(third.install(make_plan()), Status::kOk);
}

TEST(CrashInstallationTest, PlanWithoutAClosingFunctionIsRejected) {
    verifies("SWR-PRT-026", Technique::kBoundaryValues, Polarity::kViolation);
    const struct sigaction before = read_action(SIGBUS);
    CrashHandlers sut;
    CrashPlan plan = make_plan();
    plan.close_outputs = nullptr;

    EXPECT_EQ(sut.install(plan), Status::kBadParameter);
    EXPECT_EQ(read_action(SIGBUS).sa_sigaction, before.sa_sigaction);
    EXPECT_EQ(sut.install(make_plan()), Status::kOk);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
