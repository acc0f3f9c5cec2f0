// SPDX-License-Identifier: Apache-2.0
// Goal: the notice contains the state and health of each component of the table, in every n-th major frame,
// and a description that differs from the table does not start. Method: a system with a host that only counts
// time.
#include "mamori/safety/notice/survival_notifier.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/safety/e2e/checker.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;
using literals::operator""_us;
using literals::operator""_ms;

constexpr NoticeNode kNode{77U, 1_ms, 3U,
                           std::array<const char*, 4U>{"reader", "idle", "supervisor", "notifier"}};
constexpr NoticeNode kShort{77U, 1_ms, 3U, std::array<const char*, 3U>{"reader", "idle", "supervisor"}};
constexpr NoticeNode kRenamed{77U, 1_ms, 3U,
                              std::array<const char*, 4U>{"reader", "idle", "supervisor", "notifer"}};
using Notice = NoticeFor<kNode>;
static_assert(Notice::kLength == 41U && Notice::Message::kLengthMax == 41U);
static_assert(Notice::Message::kLengthMin == Notice::Message::kLengthMax);

extern ExecutionSupervisor g_supervision;

class Part final : public Component {
  public:
    constexpr explicit Part(const char* name) noexcept : Component(name) {}
    Status on_execute(ContextHandle) noexcept override { return result; }
    Status result{Status::kOk};
};
class Supervisor final : public Component {
  public:
    constexpr Supervisor() noexcept : Component("supervisor") {}
    Status on_execute(ContextHandle context) noexcept override {
        static_cast<void>(g_supervision.step(context.now));
        return Status::kOk;
    }
};
Part g_reader{"reader"};
Part g_idle{"idle"};
Supervisor g_supervisor;
SurvivalNotifier<kNode> g_notifier{"notifier", g_supervision};
constexpr auto kSystem = system(frame(1_ms), window("all", 0_us, 500_us, budget(400_us),
                                                    run(g_reader, g_idle, g_supervisor, g_notifier)));
MAMORI_CHECK(kSystem);
ExecutionStorageFor<kSystem> g_storage;
ExecutionSupervisor g_supervision{g_storage, 10_us};
constexpr std::array kWatched = {watch(g_reader, {{1U, 2U}, {0_us, 400_us}})};

/// Runs all work at once, in no time.
class InstantHost final : public WindowHost {
  public:
    Instant get_now() const noexcept override { return now; }
    Instant get_step_end() const noexcept override { return now; }
    std::size_t run_within(const Work& work, Instant) noexcept override {
        work.run(work.argument, 0U, work.count);
        return work.count;
    }
    bool has_returned(std::size_t) const noexcept override { return true; }
    Instant now{};
};

class SurvivalNotifierTest : public ::testing::Test {
  protected:
    SurvivalNotifierTest() {
        static_cast<void>(g_supervision.watch(kWatched));
        g_reader.result = Status::kOk;
        executive_.set_observer(&g_supervision);
        EXPECT_EQ(executive_.initialize(), Status::kOk);
        EXPECT_EQ(executive_.start(), Status::kOk);
    }
    ~SurvivalNotifierTest() override {
        static_cast<void>(executive_.stop());
        static_cast<void>(executive_.finalize());
        static_cast<void>(g_supervision.acknowledge(g_reader));
    }

    void run_frame() {
        static_cast<void>(executive_.run_window(0U, host_));
        host_.now = host_.now + 1_ms;
    }
    /// Runs until the next notice. @return its content.
    Notice::Value run_until_notice() {
        const std::uint64_t before = g_notifier.notice.get_sequence();
        for (int i = 0; i < 3 && g_notifier.notice.get_sequence() == before; ++i) {
            run_frame();
        }
        const Notice::Frame& frame = g_notifier.notice.get_published();
        const CheckStatus status = checker_.check(detail::view_bytes(frame));
        EXPECT_NE(status, CheckStatus::kError);
        Notice::Value value;
        EXPECT_EQ(
            decode(detail::view_bytes(frame).subspan(20U, frame.size() - 20U), ByteOrder::kLittle, value),
            Status::kOk);
        return value;
    }

    ExecutiveFor<std::remove_const_t<decltype(kSystem)>> executive_{kChecked<kSystem>};
    InstantHost host_{};
    E2eChecker<E2eProfile07<>> checker_{Notice::kChannel, {1U}};
};

TEST_F(SurvivalNotifierTest, NoticeIsSentInEachNthMajorFrameWithItsNumber) {
    verifies("SWR-NTC-002");
    const std::uint64_t before = g_notifier.notice.get_sequence();
    for (std::uint64_t frame = 0U; frame < 12U; ++frame) {
        run_frame();
        EXPECT_EQ(g_notifier.notice.get_sequence() - before, frame / 3U + 1U) << frame;
    }
    EXPECT_EQ(run_until_notice().frame, 12U);
    EXPECT_EQ(run_until_notice().frame, 15U);
    EXPECT_EQ(checker_.get_cause(), FrameCause::kGood) << "with the next counter";
}

TEST_F(SurvivalNotifierTest, NoticeHasStateAndHealthOfEachComponent) {
    verifies("SWR-NTC-001");
    Notice::Value value = run_until_notice();
    value = run_until_notice();
    EXPECT_EQ(value.version, calc_version(kNode));
    EXPECT_EQ(value.health, static_cast<std::uint8_t>(GlobalStatus::kOk));
    for (const std::uint8_t byte : value.components) {
        EXPECT_EQ(byte, to_byte({LifecycleState::kActive, LocalStatus::kOk}));
    }

    ASSERT_EQ(executive_.get_context(0U).deactivate_component(g_idle, host_.now), Status::kOk);
    EXPECT_EQ(run_until_notice().components[1], to_byte({LifecycleState::kInactive, LocalStatus::kOk}));
    ASSERT_EQ(g_idle.exit(host_.now), Status::kOk);
    EXPECT_EQ(run_until_notice().components[1], to_byte({LifecycleState::kCreated, LocalStatus::kOk}));
    g_reader.result = Status::kError;
    value = run_until_notice();
    EXPECT_EQ(value.components[0], to_byte({LifecycleState::kError, LocalStatus::kExpired}));
    EXPECT_EQ(value.health, static_cast<std::uint8_t>(GlobalStatus::kExpired));
    EXPECT_EQ(value.components[2], to_byte({LifecycleState::kActive, LocalStatus::kOk}));
}

TEST_F(SurvivalNotifierTest, DescriptionThatDiffersFromTheTableDoesNotStart) {
    verifies("SWR-NTC-003", Technique::kFaultInjection, Polarity::kViolation);
    SurvivalNotifier<kShort> fewer{"notifier", g_supervision};
    SurvivalNotifier<kRenamed> renamed{"notifier", g_supervision};
    ExecutionStorage<4U> storage_without_table{};
    const ExecutionSupervisor without_table{storage_without_table, 10_us};
    SurvivalNotifier<kNode> unknown{"notifier", without_table};

    EXPECT_EQ(g_notifier.on_startup({}), Status::kOk);
    EXPECT_EQ(fewer.on_startup({}), Status::kPreconditionNotMet);
    EXPECT_EQ(renamed.on_startup({}), Status::kPreconditionNotMet);
    EXPECT_EQ(unknown.on_startup({}), Status::kPreconditionNotMet);
}

TEST(SurvivalNotifierAloneTest, ComponentWithoutAContextIsNotAlive) {
    verifies("SWR-NTC-001", Technique::kBoundaryValues, Polarity::kViolation);
    std::array<std::uint8_t, 4U> bytes{};
    detail::report_components(g_supervision.get_components(), g_supervision, bytes);

    for (const std::uint8_t byte : bytes) {
        EXPECT_EQ(to_report(byte).state, LifecycleState::kCreated);
    }
}

}  // namespace
}  // namespace mamori::safety
