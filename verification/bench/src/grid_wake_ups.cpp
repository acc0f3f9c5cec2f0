// SPDX-License-Identifier: Apache-2.0
#include "grid_wake_ups.hpp"

#include <array>
#include <cstring>
#include <stdexcept>
#include <string>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/core_runner.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"

namespace mamori::verification::bench {
namespace {

using ports::posix_rt::CoreRunner;
using ports::posix_rt::FrameClock;
using ports::posix_rt::GuardedHost;
using ports::posix_rt::OpeningObserver;
using ports::posix_rt::Right;
using ports::posix_rt::WindowThread;
using namespace literals;  // NOLINT: units of the table below

class Idle final : public Component {
  public:
    constexpr explicit Idle(const char* name) noexcept : Component(name) {}
    Status on_execute(ContextHandle) noexcept override { return Status::kOk; }
};

Idle idle{"idle"};
constexpr auto kSystem = system(frame(1_ms), window("only", 0_us, 800_us, budget(500_us), mamori::run(idle)));
MAMORI_CHECK(kSystem);
ExecutiveFor executive{kSystem};
std::array<WindowThread, 1U> threads;

class Lateness final : public OpeningObserver {
  public:
    explicit Lateness(std::size_t cycles) { values.reserve(cycles); }
    void before_opening(const FrameSchedule::Opening& opening, Instant woke) noexcept override {
        values.push_back((woke - opening.release).ns);
    }
    void after_opening(const FrameSchedule::Opening&, WindowOutcome) noexcept override {}
    std::vector<std::int64_t> values;
};

}  // namespace

std::vector<std::int64_t> measure_grid(const GridRequest& request) {
    // Page faults would increase the lateness of this program. A denied lock affects the figures of both
    // programs.
    static_cast<void>(ports::posix_rt::lock_memory(std::size_t{256U} * 1024U));
    const Right right = combine(ports::posix_rt::set_processor(pthread_self(), request.processor),
                                ports::posix_rt::set_priority(pthread_self(), request.priority));
    if (!right.is_granted) {
        throw std::runtime_error("the machine grants no fixed priority on processor " +
                                 std::to_string(request.processor) + ": " +
                                 std::strerror(right.system_error));
    }
    static const FrameClock clock = FrameClock::starting_in(20_ms);
    static GuardedHost host{threads, clock, {request.priority - 1, request.processor}};
    Lateness lateness{request.cycles};
    CoreRunner runner{executive, host, clock};
    runner.set_observer(&lateness);
    if (host.open() != Status::kOk || executive.initialize() != Status::kOk ||
        executive.start() != Status::kOk) {
        throw std::runtime_error("the system did not start");
    }
    runner.run(request.cycles);
    while (host.close() != Status::kOk) {
        clock.wait_until(clock.get_now() + 1_ms);
    }
    return std::move(lateness.values);
}

}  // namespace mamori::verification::bench
