// SPDX-License-Identifier: Apache-2.0
// Goal: 1000 requests per second of virtual time change no hash and no window, and neither does a tool that
// asks without pause. Method: one system run three times: unseen, asked from the devices of each frame of
// one millisecond, and with a real thread that hammers beside it. One window overruns now and then.
#include "mamori/kernel/run/introspection.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/frame_runner.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::ports::virtual_time {
namespace {

using namespace verification;

constexpr int kFrames = 5000;

/// A value that depends on all that came before.
class Mixer final : public Component {
  public:
    constexpr explicit Mixer(const char* name) noexcept : Component(name) {}
    InPort<std::uint64_t, Need::kOptional> in{*this, "in"};
    OutPort<std::uint64_t> out{*this, "out"};
    using Ports = mamori::Ports<&Mixer::in, &Mixer::out>;

    Status on_execute(ContextHandle context) noexcept override {
        value_ = (value_ ^ in.read()) * 6364136223846793005U + static_cast<std::uint64_t>(context.now.ns);
        out.write(value_);
        return Status::kOk;
    }

  private:
    std::uint64_t value_{1U};
};

/// All that a tool can ask for, once.
std::uint64_t ask_all(const Introspection& introspection) noexcept {
    std::uint64_t row_count = 0U;
    const auto count = [&row_count](std::size_t, const auto&) noexcept { ++row_count; };
    static_cast<void>(introspection.for_each_window(count));
    static_cast<void>(introspection.for_each_component(count));
    static_cast<void>(introspection.for_each_port(count));
    return row_count;
}

/// Makes every seventh frame overrun, and asks once per frame when there is something to ask.
class AskingDevices final : public Devices {
  public:
    AskingDevices(VirtualHost& host, const Introspection* introspection) noexcept
        : host_(host), introspection_(introspection) {}
    std::uint64_t row_count{0U};

    void sample(std::uint64_t frame, Instant) noexcept override {
        EXPECT_EQ(host_.set_duration(0U, frame % 7U == 0U ? 301_us : 100_us), Status::kOk);
        ask();
    }
    void apply(std::uint64_t, Instant, Duration) noexcept override { ask(); }

  private:
    void ask() noexcept {
        if (introspection_ != nullptr) {
            row_count += ask_all(*introspection_);
        }
    }
    VirtualHost& host_;
    const Introspection* introspection_;
};

enum class Tool : std::uint8_t { kNone, kPerFrame, kThread };

struct Course {
    std::uint64_t trace_hash;
    std::uint64_t overrun_count;
    Instant end;
    std::uint64_t row_count;
};

/// Runs kFrames frames of 1 ms: two mixers in a ring, one window each.
Course run(Tool tool) {
    Mixer first{"first"};
    Mixer second{"second"};
    const auto table =
        system(frame(1_ms), trace_hash(), window("first", 0_us, 400_us, budget(300_us), run(first)),
               window("second", 500_us, 400_us, budget(300_us), run(second)),
               connect(first.out, second.in, any_age()), connect(second.out, first.in, any_age()));
    ExecutiveFor executive{table};
    IntrospectionFor introspection{table};
    if (tool != Tool::kNone) {
        executive.set_introspection(&introspection);
    }
    EXPECT_EQ(executive.initialize(), Status::kOk);
    EXPECT_EQ(executive.start(), Status::kOk);
    VirtualHostFor host{table};
    AskingDevices devices{host, tool == Tool::kPerFrame ? &introspection : nullptr};
    SimulatedCore core{executive, host};
    FrameRunner runner{{&core, 1U}, devices};
    std::atomic<bool> is_done{false};
    std::uint64_t hammered_count = 0U;
    std::thread hammer([&] {
        while (tool == Tool::kThread && !is_done.load(std::memory_order_acquire)) {
            hammered_count += ask_all(introspection);
        }
    });
    for (int i = 0; i < kFrames; ++i) {
        runner.run_frame();
    }
    is_done.store(true, std::memory_order_release);
    hammer.join();
    return {executive.get_trace_hash(), runner.get_overrun_count(), host.get_now(),
            devices.row_count + hammered_count};
}

void expect_same_course(const Course& seen, const Course& unseen) {
    EXPECT_EQ(seen.trace_hash, unseen.trace_hash);
    EXPECT_EQ(seen.overrun_count, unseen.overrun_count);
    EXPECT_EQ(seen.end, unseen.end);
}

TEST(IntrospectionInVirtualTimeTest, AThousandRequestsPerSecondChangeNoHashAndNoWindow) {
    verifies("SWR-INS-002", Technique::kBackToBack);
    const Course unseen = run(Tool::kNone);
    const Course seen = run(Tool::kPerFrame);

    expect_same_course(seen, unseen);
    EXPECT_GT(unseen.overrun_count, 0U);
    EXPECT_EQ(seen.row_count, 2U * kFrames * (2U + 2U + 4U)) << "two requests per millisecond, all rows each";
}

TEST(IntrospectionInVirtualTimeTest, AToolThatAsksWithoutPauseChangesNoHashAndNoWindow) {
    verifies("SWR-INS-002", Technique::kFaultInjection, Polarity::kViolation);
    const Course unseen = run(Tool::kNone);
    const Course seen = run(Tool::kThread);

    expect_same_course(seen, unseen);
}

}  // namespace
}  // namespace mamori::ports::virtual_time
