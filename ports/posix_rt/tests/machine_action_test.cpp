// SPDX-License-Identifier: Apache-2.0
// Goal: an action outside windows that hangs on any core closes the outputs after its budget, is named, and
// prevents a further run until it has returned. Method: real threads; components whose actions wait until the
// test lets them return. Times have a lower limit only, as a slow host delays everything.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/machine.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/machine_records.hpp"
#include "support/patient_options.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;
using literals::operator""_ms;
using Clock = std::chrono::steady_clock;

constexpr Duration kBudget{60'000'000};

/// Action that is to hang or to be slow, when it began, and when the outputs closed.
std::atomic<ComponentAction> g_faulty{ComponentAction::kExecute};
std::atomic<bool> g_may_return{true};
std::atomic<std::int64_t> g_slow_ns{0};
std::atomic<std::int64_t> g_began_ns{0};
std::atomic<std::int64_t> g_closed_ns{0};
std::atomic<int> g_left{0};
std::atomic<int> g_signal{0};  ///< that the action sends to this process

std::int64_t read_ns() noexcept {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch()).count();
}
void note_closing(void*) noexcept {
    g_closed_ns = read_ns();
    ++g_closed;
}

class Idle final : public Component {
  public:
    constexpr Idle() noexcept : Component("idle") {}
};
class Hanger final : public Component {
  public:
    constexpr Hanger() noexcept : Component("hanger") {}
    std::atomic<int> shutdowns{0};

    Status on_initialize() noexcept override { return act(ComponentAction::kInitialize); }
    Status on_startup(ContextHandle) noexcept override { return act(ComponentAction::kStartup); }
    Status on_activated(ContextHandle) noexcept override { return act(ComponentAction::kActivated); }
    Status on_deactivated(ContextHandle) noexcept override { return act(ComponentAction::kDeactivated); }
    Status on_shutdown(ContextHandle) noexcept override {
        ++shutdowns;
        return act(ComponentAction::kShutdown);
    }

  private:
    static Status act(ComponentAction action) noexcept {
        if (g_faulty != action) {
            return Status::kOk;
        }
        g_began_ns = read_ns();
        if (g_signal != 0) {
            static_cast<void>(::kill(::getpid(), g_signal));
        }
        while (!g_may_return || read_ns() - g_began_ns < g_slow_ns) {
            std::this_thread::yield();
        }
        ++g_left;
        return Status::kOk;
    }
};

// One table per test: a component belongs to one executive as long as it is alive.
#define MAMORI_TEST_SYSTEM(name)                                                                     \
    Idle g_idle_##name;                                                                              \
    Hanger g_hanger_##name;                                                                          \
    constexpr auto name =                                                                            \
        system(frame(10_ms), action_budget(kBudget),                                                 \
               window("idle", 2_ms, 4_ms, core(MAMORI_IDLE_CORE), budget(4_ms), run(g_idle_##name)), \
               window("hang", 2_ms, 4_ms, core(1U - MAMORI_IDLE_CORE), budget(4_ms), run(g_hanger_##name)))

#define MAMORI_IDLE_CORE 0U
MAMORI_TEST_SYSTEM(kInitializes);
MAMORI_TEST_SYSTEM(kStarts);
MAMORI_TEST_SYSTEM(kActivates);
MAMORI_TEST_SYSTEM(kDeactivates);
MAMORI_TEST_SYSTEM(kShutsDown);
MAMORI_TEST_SYSTEM(kIsSlow);
MAMORI_TEST_SYSTEM(kReturns);
MAMORI_TEST_SYSTEM(kIsStopped);
MAMORI_TEST_SYSTEM(kIsRecorded);
#undef MAMORI_IDLE_CORE
#define MAMORI_IDLE_CORE 1U
MAMORI_TEST_SYSTEM(kOnFirstCore);
#undef MAMORI_IDLE_CORE

MachineOptions make_action_options() {
    MachineOptions options = make_options();
    options.outputs = {&note_closing, nullptr};
    return options;
}

class MachineActionTest : public ::testing::Test {
  protected:
    MachineActionTest() {
        g_may_return = false;
        g_slow_ns = 0;
        g_closed = 0;
        g_left = 0;
    }
    ~MachineActionTest() override {
        g_may_return = true;
        g_faulty = ComponentAction::kExecute;
    }

    static void let_return(int count = 1) {
        g_may_return = true;
        while (g_left < count) {
            std::this_thread::yield();
        }
    }
    /// The thread of the action reports its return a moment after the action has ended.
    template <typename Sut>
    static Status run_again(Sut& sut) {
        Status status = sut.run(1U);
        for (int i = 0; i < 1000 && sut.get_report().failed_step == MachineStep::kWindowThreads; ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds{1});
            status = sut.run(1U);
        }
        return status;
    }

    /// Runs `sut` with a hanging action, and again after its return.
    template <typename Sut>
    static void expect_named(Sut& sut, ComponentAction action, MachineStep step) {
        g_faulty = action;

        EXPECT_EQ(sut.run(1U), Status::kError);

        const MachineReport& report = sut.get_report();
        EXPECT_EQ(report.failed_step, step);
        ASSERT_NE(report.late_component, nullptr);
        EXPECT_STREQ(report.late_component, "hanger");
        EXPECT_STREQ(report.late_action, get_name(action));
        EXPECT_EQ(std::string{describe(report).c_str()},
                  std::string{describe(step)} + ": " + get_name(action) +
                      " of component hanger did not return within the action budget");
        EXPECT_EQ(g_closed, 1);
        const std::int64_t until_closed = g_closed_ns - g_began_ns;
        // At the stop, the outputs are closed before any action.
        EXPECT_TRUE(step == MachineStep::kStop ? until_closed < 0 : until_closed >= kBudget.ns - 1'000'000)
            << until_closed;
        std::printf("%s: outputs closed %lld us after its begin\n", get_name(action),
                    static_cast<long long>(until_closed / 1000));

        EXPECT_EQ(sut.run(1U), Status::kPreconditionNotMet);
        EXPECT_EQ(sut.get_report().failed_step, MachineStep::kWindowThreads);
        EXPECT_EQ(sut.get_report().late_component, nullptr);
        let_return();
        g_faulty = ComponentAction::kExecute;
        EXPECT_EQ(run_again(sut), Status::kOk) << describe(sut.get_report()).c_str();
    }
};

TEST_F(MachineActionTest, HangingInitializationIsNamedWithClosedOutputs) {
    verifies("SWR-PRT-085", Technique::kFaultInjection, Polarity::kViolation);
    static Machine<kInitializes> sut{make_action_options()};
    expect_named(sut, ComponentAction::kInitialize, MachineStep::kStart);
}

TEST_F(MachineActionTest, HangingStartupIsNamedWithClosedOutputs) {
    verifies("SWR-PRT-085", Technique::kFaultInjection, Polarity::kViolation);
    static Machine<kStarts> sut{make_action_options()};
    expect_named(sut, ComponentAction::kStartup, MachineStep::kStart);
}

TEST_F(MachineActionTest, HangingActivationIsNamedWithClosedOutputs) {
    verifies("SWR-PRT-085", Technique::kFaultInjection, Polarity::kViolation);
    static Machine<kActivates> sut{make_action_options()};
    expect_named(sut, ComponentAction::kActivated, MachineStep::kStart);
}

TEST_F(MachineActionTest, HangingDeactivationIsNamedWithClosedOutputs) {
    verifies("SWR-PRT-085", Technique::kFaultInjection, Polarity::kViolation);
    static Machine<kDeactivates> sut{make_action_options()};
    expect_named(sut, ComponentAction::kDeactivated, MachineStep::kStop);
}

TEST_F(MachineActionTest, HangingShutdownIsNamedWithClosedOutputs) {
    verifies("SWR-PRT-085", Technique::kFaultInjection, Polarity::kViolation);
    static Machine<kShutsDown> sut{make_action_options()};
    expect_named(sut, ComponentAction::kShutdown, MachineStep::kStop);
}

TEST_F(MachineActionTest, HangOnTheFirstCoreIsNamedToo) {
    verifies("SWR-PRT-085", Technique::kFaultInjection, Polarity::kViolation);
    static Machine<kOnFirstCore> sut{make_action_options()};
    expect_named(sut, ComponentAction::kStartup, MachineStep::kStart);
}

TEST_F(MachineActionTest, ActionThatReturnsWithinItsBudgetIsNoFailure) {
    verifies("SWR-PRT-085", Technique::kBoundaryValues, Polarity::kNominal);
    static Machine<kIsSlow> sut{make_action_options()};
    g_may_return = true;
    g_slow_ns = kBudget.ns / 6;
    for (const ComponentAction action :
         {ComponentAction::kInitialize, ComponentAction::kStartup, ComponentAction::kActivated,
          ComponentAction::kDeactivated, ComponentAction::kShutdown}) {
        g_faulty = action;
        EXPECT_EQ(sut.run(1U), Status::kOk) << describe(sut.get_report()).c_str();
        EXPECT_EQ(sut.get_report().late_component, nullptr);
    }
    EXPECT_EQ(g_left, 5);
    EXPECT_STREQ(describe(sut.get_report()).c_str(), "no failure");
}

TEST_F(MachineActionTest, RunAfterTheReturnOfALateActivationFirstDeactivatesTheComponent) {
    verifies("SWR-PRT-086", Technique::kErrorGuessing, Polarity::kViolation);
    static Machine<kReturns> sut{make_action_options()};
    g_faulty = ComponentAction::kActivated;
    ASSERT_EQ(sut.run(1U), Status::kError);
    EXPECT_EQ(g_hanger_kReturns.shutdowns, 0);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(sut.run(1U), Status::kPreconditionNotMet);
    }
    let_return();
    g_faulty = ComponentAction::kExecute;

    ASSERT_EQ(run_again(sut), Status::kOk) << describe(sut.get_report()).c_str();
    EXPECT_EQ(g_hanger_kReturns.shutdowns, 2);
}

TEST_F(MachineActionTest, SignalDuringAHangClosesTheOutputsAtOnce) {
    verifies("SWR-PRT-085", Technique::kErrorGuessing, Polarity::kViolation);
    static Machine<kIsStopped> sut{make_action_options()};
    g_faulty = ComponentAction::kStartup;
    g_signal = SIGTERM;
    struct sigaction own{};
    struct sigaction before{};
    own.sa_handler = [](int) {};
    ASSERT_EQ(sigaction(SIGTERM, &own, &before), 0);

    EXPECT_EQ(sut.run(1U), Status::kError);

    g_signal = 0;
    EXPECT_EQ(sigaction(SIGTERM, &before, nullptr), 0);
    EXPECT_EQ(sut.get_report().signal, SIGTERM);
    EXPECT_STREQ(sut.get_report().late_action, "on_startup");
    EXPECT_GE(g_closed, 1);
    let_return();
    g_faulty = ComponentAction::kExecute;
    EXPECT_EQ(run_again(sut), Status::kOk);
}

TEST_F(MachineActionTest, RecorderNamesComponentAndAction) {
    verifies("SWR-PRT-085", Technique::kRequirementsBased, Polarity::kNominal);
    const std::string path = ::testing::TempDir() + "machine_action.rec";
    static_cast<void>(std::remove(path.c_str()));
    MachineOptions options = make_action_options();
    options.recorder = path.c_str();
    static Machine<kIsRecorded> sut{options};
    g_faulty = ComponentAction::kStartup;
    EXPECT_EQ(sut.run(1U), Status::kError);
    let_return();

    std::vector<std::int64_t> arguments;
    for (const FlightRecord& record : read_machine_records(path)) {
        if (record.code == static_cast<std::uint16_t>(MachineEvent::kActionOverrun)) {
            arguments.push_back(record.argument);
            EXPECT_EQ(record.severity, Severity::kFault);
        }
    }
    const auto action = static_cast<std::int64_t>(ComponentAction::kStartup);
    EXPECT_EQ(arguments, (std::vector<std::int64_t>{(action << 32) + 1}));
    static_cast<void>(std::remove(path.c_str()));
}

}  // namespace
}  // namespace mamori::ports::posix_rt
