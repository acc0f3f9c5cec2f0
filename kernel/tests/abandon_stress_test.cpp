// SPDX-License-Identifier: Apache-2.0
// Goal: an executive and the work that it has given up share nothing but what they may, on this machine's
// memory order. Method: a real thread does the work of one window and is given up after a random short time,
// often before it has begun; run under the thread sanitizer too. What was published is judged, never times.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <limits>
#include <random>
#include <thread>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/fake_host.hpp"

namespace mamori {
namespace {

using testing_support::SpyRecords;
using namespace verification;
using literals::operator""_ns;

constexpr std::int64_t kFrames = 20'000;
constexpr std::uint32_t kForEver = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kSeed = 20261122U;

/// Both words are equal; a mixture of two writes is not.
using Pair = std::array<std::int64_t, 2U>;

class Writer final : public Component {
  public:
    explicit Writer() noexcept : Component("writer") {}
    OutPort<Pair> out{*this, "out"};
    using Ports = mamori::Ports<&Writer::out>;

    Status on_execute(ContextHandle) noexcept override {
        ++count_;
        for (std::int64_t i = count_ % 64; i > 0; --i) {
            is_idle_.store(false, std::memory_order_relaxed);  // takes its time
        }
        out.write({count_, count_});
        return Status::kOk;
    }

  private:
    std::int64_t count_{0};
    std::atomic<bool> is_idle_{true};
};

/// Reads what is handed on within its window, or latched at the opening.
class Reader final : public Component {
  public:
    explicit Reader(const char* name) noexcept : Component(name) {}
    InPort<Pair> in{*this, "in"};
    using Ports = mamori::Ports<&Reader::in>;
    std::int64_t last{0};
    bool is_whole{true};

    Status on_execute(ContextHandle) noexcept override {
        if (in.has_value()) {
            const Pair value = in.read();
            is_whole = is_whole && value[0] == value[1] && value[0] >= last;
            last = value[0];
        }
        return Status::kOk;
    }
};

/// Window 0 on a thread of its own, which is waited for as long as `patience` says; the rest at once.
class ImpatientHost final : public WindowHost {
  public:
    Instant now{};
    std::uint32_t patience{0U};  ///< looks at the progress before the work is given up

    ImpatientHost() : thread_([this] { serve(); }) {}
    ~ImpatientHost() {
        is_ended_.store(true, std::memory_order_release);
        thread_.join();
    }

    Instant get_now() const noexcept override { return now; }
    Instant get_step_end() const noexcept override { return Instant{}; }
    std::size_t run_within(const Work& work, Instant) noexcept override {
        if (work.window != 0U) {
            work.run(work.argument, work.first, work.first + work.count);
            return work.count;
        }
        work_ = work;
        finished_count_.store(0U, std::memory_order_relaxed);
        is_out_.store(true, std::memory_order_release);
        for (std::uint32_t i = 0U; i < patience; ++i) {
            if (!is_out_.load(std::memory_order_acquire)) {
                return work_.count;
            }
            pause(i);
        }
        // Who has finished the last step may still be on the way out of it.
        const std::size_t finished = finished_count_.load(std::memory_order_acquire);
        return patience == 0U ? 0U : std::min(finished, work_.count - 1U);
    }
    bool has_returned(std::size_t) const noexcept override {
        return !is_out_.load(std::memory_order_acquire);
    }

  private:
    /// Close to the other thread at first, so that both are at work at once; then out of its way.
    static void pause(std::uint32_t round) {
        if (round > 200U) {
            std::this_thread::yield();
        }
    }
    void serve() {
        std::uint32_t idle_rounds = 0U;
        while (!is_ended_.load(std::memory_order_acquire)) {
            if (!is_out_.load(std::memory_order_acquire)) {
                pause(++idle_rounds);
                continue;
            }
            idle_rounds = 0U;
            for (std::size_t i = 0U; i < work_.count; ++i) {
                work_.run(work_.argument, work_.first + i, work_.first + i + 1U);
                finished_count_.store(i + 1U, std::memory_order_release);
            }
            is_out_.store(false, std::memory_order_release);
        }
    }

    Work work_{};
    std::atomic<std::size_t> finished_count_{0U};
    std::atomic<bool> is_out_{false};
    std::atomic<bool> is_ended_{false};
    std::thread thread_;
};

class RecordingObserver final : public SpyRecords, public ExecutionObserver {
  public:
    RecordingObserver() : ExecutionObserver(records) {}
    std::int64_t overruns{0};
    void on_budget_overrun(std::size_t, std::size_t, Instant) noexcept override { ++overruns; }
    void on_late_release(std::size_t, Duration, Instant) noexcept override {}
};

TEST(AbandonStressTest, WorkThatIsGivenUpAtAnyMomentSharesNothingThatItMayNot) {
    verifies("SWR-KRN-032", Technique::kFaultInjection, Polarity::kViolation);
    Writer writer;
    Reader inside{"inside"};
    Reader outside{"outside"};
    const auto table =
        system(frame(1000_ns), window("worker", 0_ns, 400_ns, budget(300_ns), run(writer, inside)),
               window("reader", 400_ns, 600_ns, budget(500_ns), run(outside)),
               connect(writer.out, inside.in, any_age()), connect(writer.out, outside.in, any_age()));
    ExecutiveFor sut{table};
    RecordingObserver observer;
    std::int64_t completed = 0;
    std::int64_t refused = 0;
    {
        ImpatientHost host;
        ASSERT_EQ(sut.initialize(), Status::kOk);
        ASSERT_EQ(sut.start(), Status::kOk);
        sut.set_observer(&observer);
        std::mt19937 random{kSeed};
        for (std::int64_t frame = 0; frame < kFrames; ++frame) {
            const std::uint32_t draw = random() % 16U;
            host.patience = draw == 0U ? 0U : draw == 1U ? kForEver : 1U << draw;
            while (host.patience == kForEver && !host.has_returned(0U)) {
                std::this_thread::yield();  // some openings find their window closed, but never all of them
            }
            host.now = Instant{frame * 1000};
            const bool is_through = sut.run_window(0U, host.now, host) == WindowOutcome::kCompleted;
            completed += is_through ? 1 : 0;
            if (!is_through && random() % 4U == 0U) {
                std::this_thread::yield();  // so that the work comes back now and then
            }
            refused += sut.get_context(0U).deactivate_component(inside, host.now) == Status::kOk ? 0 : 1;
            static_cast<void>(sut.get_context(0U).activate_component(inside, host.now));
            host.now = Instant{frame * 1000 + 400};
            ASSERT_EQ(sut.run_window(1U, host.now, host), WindowOutcome::kCompleted);
            static_cast<void>(observer.take_seen(3U));
        }
        while (!host.has_returned(0U)) {
            std::this_thread::yield();
        }
        EXPECT_EQ(sut.stop(), Status::kOk);
    }

    std::printf("%lld of %lld openings came through\n", static_cast<long long>(completed),
                static_cast<long long>(kFrames));
    EXPECT_GT(completed, 0) << "seed " << kSeed;
    EXPECT_EQ(observer.overruns, kFrames - completed);
    EXPECT_GT(observer.overruns, 0);
    EXPECT_LE(refused, observer.overruns) << "a window that came through has nothing to hide";
    EXPECT_TRUE(inside.is_whole);
    EXPECT_TRUE(outside.is_whole);
    EXPECT_GT(outside.last, 0);
}

}  // namespace
}  // namespace mamori
