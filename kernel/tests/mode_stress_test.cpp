// SPDX-License-Identifier: Apache-2.0
// Goal: two real threads agree on modes and sets while other threads ask for them, on this machine's memory
// order. Method: a fixed number of frames, no core ever a whole frame behind, requests at full speed from
// two more threads; run under the thread sanitizer too. What the cores did is compared, never times.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <thread>

#include "mamori/trace/verifies.hpp"
#include "support/mode_system.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

constexpr std::int64_t kFrames = 20'000;

/// Lets two cores run their frames at their own speed, neither more than one ahead.
class FrameGate {
  public:
    void wait_for_other(std::size_t core, std::int64_t frame) const {
        while (finished_[1U - core].load(std::memory_order_acquire) + 1 < frame) {
            std::this_thread::yield();
        }
    }
    void finish(std::size_t core, std::int64_t frame) {
        finished_[core].store(frame, std::memory_order_release);
    }

  private:
    std::array<std::atomic<std::int64_t>, 2U> finished_{{{-1}, {-1}}};
};

/// Runs both cores on threads of their own while `ask` is called again and again on two more.
template <typename Ask>
void run_with_requests(Robot& robot, Ask ask) {
    for (ModeHost& host : robot.hosts) {
        host.aside = ModeHost::Aside::kNothing;  // the stacks aside are for one thread
    }
    ASSERT_TRUE(robot.begin());
    FrameGate gate;
    std::atomic<bool> is_done{false};
    const auto run_core = [&](std::size_t core) {
        for (std::int64_t frame = 0; frame < kFrames; ++frame) {
            gate.wait_for_other(core, frame);
            static_cast<void>(robot.run_core(core));
            gate.finish(core, frame);
        }
    };
    const auto ask_on = [&](std::uint32_t first) {
        for (std::uint32_t i = first; !is_done.load(std::memory_order_acquire); ++i) {
            ask(i);
            std::this_thread::yield();
        }
    };
    std::array<std::thread, 2U> askers{{std::thread(ask_on, 0U), std::thread(ask_on, 1U)}};
    std::array<std::thread, 2U> cores{{std::thread(run_core, 0U), std::thread(run_core, 1U)}};
    for (std::thread& core : cores) {
        core.join();
    }
    is_done.store(true, std::memory_order_release);
    for (std::thread& asker : askers) {
        asker.join();
    }
}

TEST(ModeStressTest, CoresTakeTheSameStepsWhileThreadsAsk) {
    verifies("SWR-MOD-006", Technique::kErrorGuessing);
    Robot robot;
    constexpr std::array<Command, 3U> kCommands{Command::kStart, Command::kTeach, Command::kStop};
    run_with_requests(robot, [&](std::uint32_t i) {
        static_cast<void>(robot.modes.request(kCommands[i % kCommands.size()]));
        static_cast<void>(robot.modes.get_configuration().activate_configuration_set(i % 2U));
        static_cast<void>(robot.modes.get_failure());
    });

    EXPECT_EQ(robot.modes.get_failure().cause, ModeFailureCause::kNone);
    // The last step may have reached one core only: the frames end in its middle.
    const std::size_t count = std::min(robot.observers[0].steps.size(), robot.observers[1].steps.size());
    EXPECT_LE(std::max(robot.observers[0].steps.size(), robot.observers[1].steps.size()), count + 1U);
    ASSERT_GT(count, 10U);
    for (std::size_t i = 0U; i < count; ++i) {
        ASSERT_EQ(robot.observers[0].steps[i], robot.observers[1].steps[i]) << i;
    }
}

TEST(ModeStressTest, TheSafeModeIsReachedFromTheMiddleOfRequests) {
    verifies("SWR-MOD-007", Technique::kErrorGuessing);
    Robot robot;
    run_with_requests(robot, [&](std::uint32_t i) {
        static_cast<void>(robot.modes.request(i % 2U == 0U ? Command::kStart : Command::kStop));
        if (i == 20U) {
            static_cast<void>(robot.modes.request_safe_mode());
        }
    });

    EXPECT_EQ(robot.modes.get_failure().cause, ModeFailureCause::kRequested);
    EXPECT_EQ(robot.modes.get_mode(), kHalt);
    EXPECT_EQ(robot.get_active(), "monitor guard ");
}

}  // namespace
}  // namespace mamori
