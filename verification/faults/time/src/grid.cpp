// SPDX-License-Identifier: Apache-2.0
#include "grid.hpp"

#include <array>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/core_runner.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"
#include "mamori/verification/stall_watch.hpp"

namespace mamori::time_faults {
namespace {

using ports::posix_rt::CoreRunner;
using ports::posix_rt::FrameClock;
using ports::posix_rt::GuardedHost;
using ports::posix_rt::OpeningObserver;
using ports::posix_rt::WindowThread;
using verification::find_processor;
using namespace literals;  // NOLINT: units of the table below

constexpr int kRunnerPriority = 80;
constexpr int kWindowPriority = 70;

std::int64_t to_ns(const timespec& time) {
    return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

/// Static like the threads that read it.
const FrameClock& get_clock() {
    static const FrameClock clock = FrameClock::starting_in(100_ms);
    return clock;
}

class Starter final : public Component {
  public:
    constexpr explicit Starter(const char* name) noexcept : Component(name) {}
    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&Starter::out>;

    Status on_execute(ContextHandle handle) noexcept override {
        started_ns_ = to_ns(get_clock().to_timespec(get_clock().get_now()));
        out.write(handle.now.ns);
        return Status::kOk;
    }
    /// @return 0 when it did not run since the last call. To be asked when no work is out.
    std::int64_t take_started() noexcept {
        const std::int64_t started = started_ns_;
        started_ns_ = 0;
        return started;
    }

  private:
    std::int64_t started_ns_{0};
};

Starter starter{"starter"};
constexpr auto kSystem =
    system(frame(kGridPeriod), window("only", 0_us, 800_us, budget(500_us), run(starter)));
MAMORI_CHECK(kSystem);
ExecutiveFor executive{kSystem};
IntrospectionFor introspection{kSystem};
std::array<WindowThread, 1U> threads;

GuardedHost& get_host() {
    static GuardedHost host{threads, get_clock(), {kWindowPriority, find_processor()}};
    return host;
}

class Notes final : public OpeningObserver {
  public:
    explicit Notes(std::uint64_t frame_count) { rows.reserve(frame_count); }

    void before_opening(const FrameSchedule::Opening& opening, Instant woke) noexcept override {
        rows.push_back(
            {to_ns(get_clock().to_timespec(opening.release)), to_ns(get_clock().to_timespec(woke)), 0});
    }
    void after_opening(const FrameSchedule::Opening&, WindowOutcome outcome) noexcept override {
        if (outcome == WindowOutcome::kCompleted) {
            rows.back().started_ns = starter.take_started();
        }
    }

    std::vector<GridRow> rows;
};

}  // namespace

Status Grid::open() {
    static_cast<void>(ports::posix_rt::lock_memory(std::size_t{256U} * 1024U));
    const ports::posix_rt::Right right =
        combine(ports::posix_rt::set_priority(pthread_self(), kRunnerPriority),
                ports::posix_rt::set_processor(pthread_self(), find_processor()));
    executive.set_introspection(&introspection);
    Status result = get_host().open();
    has_priority_ =
        combine(right, combine(get_host().get_priority_right(), get_host().get_processor_right())).is_granted;
    result = result == Status::kOk ? executive.initialize() : result;
    return result == Status::kOk ? executive.start() : result;
}

std::vector<GridRow> Grid::run(std::uint64_t frame_count) {
    Notes notes{frame_count};
    CoreRunner runner{executive, get_host(), get_clock()};
    runner.set_observer(&notes);
    runner.run(frame_count);
    return std::move(notes.rows);
}

void Grid::close() {
    static_cast<void>(ports::posix_rt::set_priority(pthread_self(), 0));
    while (get_host().close() != Status::kOk) {
        get_clock().wait_until(get_clock().get_now() + kGridPeriod);
    }
}

const Introspection& Grid::get_introspection() const noexcept {
    return introspection;
}

}  // namespace mamori::time_faults
