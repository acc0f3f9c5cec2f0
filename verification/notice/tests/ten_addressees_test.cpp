// SPDX-License-Identifier: Apache-2.0
// Goal: one notice reaches ten addressees, each of which supervises the node by itself. Method: a table in
// virtual time whose notifier is connected to ten monitors, as to ten link components.
#include <gtest/gtest.h>

#include <array>

#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/machine.hpp"
#include "mamori/safety/notice/node_monitor.hpp"
#include "mamori/safety/notice/survival_notifier.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;
using literals::operator""_us;
using literals::operator""_ms;

constexpr NoticeNode kNode{
    5U, 1_ms, 2U,
    std::array{"supervisor", "notifier", "m0", "m1", "m2", "m3", "m4", "m5", "m6", "m7", "m8", "m9"}};
constexpr NoticeLimits kLimits{};

extern ExecutionSupervisor g_supervision;
class Supervisor final : public Component {
  public:
    constexpr Supervisor() noexcept : Component("supervisor") {}
    Status on_execute(ContextHandle context) noexcept override {
        static_cast<void>(g_supervision.step(context.now));
        return Status::kOk;
    }
};
using Monitor = NodeMonitor<kNode, kLimits>;
Supervisor g_supervisor;
SurvivalNotifier<kNode> g_notifier{"notifier", g_supervision};
Monitor g_0{"m0"};
Monitor g_1{"m1"};
Monitor g_2{"m2"};
Monitor g_3{"m3"};
Monitor g_4{"m4"};
Monitor g_5{"m5"};
Monitor g_6{"m6"};
Monitor g_7{"m7"};
Monitor g_8{"m8"};
Monitor g_9{"m9"};
constexpr std::array<Monitor*, 10U> kMonitors{&g_0, &g_1, &g_2, &g_3, &g_4, &g_5, &g_6, &g_7, &g_8, &g_9};
constexpr auto kSystem = system(
    frame(1_ms), window("send", 0_us, 300_us, budget(200_us), run(g_supervisor, g_notifier)),
    window("supervise", 400_us, 500_us, budget(400_us),
           run(g_0, g_1, g_2, g_3, g_4, g_5, g_6, g_7, g_8, g_9)),
    connect(g_notifier.notice, g_0.notice, any_age()), connect(g_notifier.notice, g_1.notice, any_age()),
    connect(g_notifier.notice, g_2.notice, any_age()), connect(g_notifier.notice, g_3.notice, any_age()),
    connect(g_notifier.notice, g_4.notice, any_age()), connect(g_notifier.notice, g_5.notice, any_age()),
    connect(g_notifier.notice, g_6.notice, any_age()), connect(g_notifier.notice, g_7.notice, any_age()),
    connect(g_notifier.notice, g_8.notice, any_age()), connect(g_notifier.notice, g_9.notice, any_age()));
ExecutionStorageFor<kSystem> g_storage;
ExecutionSupervisor g_supervision{g_storage, 10_us};
ports::virtual_time::Machine<kSystem> g_machine;

TEST(TenAddresseesTest, EachAddresseeProvesTheNode) {
    verifies("SWR-NTC-002");
    const auto judge = [](std::uint64_t frame) {
        for (const Monitor* monitor : kMonitors) {
            EXPECT_EQ(monitor->get_status().is_proven, frame >= 4U) << frame;
            EXPECT_EQ(monitor->get_status().faults, 0U);
        }
    };

    EXPECT_EQ(g_machine.run(20U, judge), Status::kOk);
}

}  // namespace
}  // namespace mamori::safety
