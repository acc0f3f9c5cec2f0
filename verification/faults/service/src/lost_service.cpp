// SPDX-License-Identifier: Apache-2.0
#include "lost_service.hpp"

#include <array>
#include <atomic>
#include <random>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/core_runner.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"
#include "mamori/ports/posix_rt/software_watchdog.hpp"
#include "mamori/verification/awake_processor.hpp"
#include "mamori/verification/course_file.hpp"
#include "mamori/verification/stall_watch.hpp"

namespace mamori::lost_service {
namespace {

using ports::posix_rt::CoreRunner;
using ports::posix_rt::FrameClock;
using ports::posix_rt::GuardedHost;
using ports::posix_rt::OpeningObserver;
using ports::posix_rt::SoftwareWatchdog;
using ports::posix_rt::WindowThread;
using safety::GlobalStatus;
using safety::WatchdogGate;
using safety::WatchdogOutcome;
using verification::Defect;
using verification::StallWatch;
using namespace literals;  // NOLINT: units of the table below

/// Above the priorities of other programs, as far as possible.
constexpr int kStallPriority = 98;
constexpr int kWatchdogPriority = 97;
constexpr int kRunnerPriority = 96;
constexpr int kWindowPriority = 95;
constexpr safety::WatchdogWindow kWatchdogWindow{200_us, kServiceTimeout};
/// Narrower than the watchdog time, by the jitter of the window.
constexpr safety::WatchdogWindow kGateWindow{300_us, 4_ms};
/// Frames before a loss, and frames that are reserved for the reaction.
constexpr std::uint64_t kFramesBefore = 5U;
constexpr std::uint64_t kFramesSpread = 40U;
constexpr std::uint64_t kFramesAfter = 12U;
/// A watchdog that has not acted within this time never will; work that hangs for the loss then continues.
constexpr Duration kPatience = 100_ms;

/// State of one trial. The watchdog thread writes the closing, the other threads write the rest.
struct Stage {
    const FrameClock* clock{nullptr};
    SoftwareWatchdog* watchdog{nullptr};
    WatchdogGate* gate{nullptr};
    std::uint64_t loss_frame{0U};
    Defect defect{Defect::kNone};
    LossTrial trial{};
    std::atomic<bool> is_closed{false};
    std::atomic<std::int64_t> closed_at_ns{0};

    static void close_outputs(void* self) noexcept {
        auto& stage = *static_cast<Stage*>(self);
        if (stage.defect == Defect::kLateRelease) {
            stage.clock->wait_until(stage.clock->get_now() + kTick + kTick);
        }
        stage.closed_at_ns.store(stage.clock->get_now().ns, std::memory_order_relaxed);
        stage.is_closed.store(true, std::memory_order_release);
    }

    void inject() noexcept {
        trial.is_injected = true;
        trial.injected_at = clock->get_now();
    }
    bool is_hanging() const noexcept {
        return !is_closed.load(std::memory_order_acquire) && clock->get_now() < trial.injected_at + kPatience;
    }
};

Stage stage;

class Supervisor final : public Component {
  public:
    constexpr Supervisor() noexcept : Component("supervisor") {}

    /// Called before the frames of a trial.
    void begin() noexcept { frame_ = 0U; }

    Status on_execute(ContextHandle) noexcept override {
        const Loss loss = stage.trial.loss;
        const bool is_lost = loss != Loss::kNone && loss != Loss::kNoWindow && frame_ >= stage.loss_frame;
        const bool is_first = is_lost && !stage.trial.is_injected;
        ++frame_;
        if (stage.defect == Defect::kOverrun && frame_ == kFramesBefore) {
            const Instant end = stage.clock->get_now() + kServiceTimeout + kTick;
            while (stage.clock->get_now() < end) {
            }
        }
        if (is_first && loss != Loss::kRunaway) {
            stage.inject();
        }
        if (is_first && (loss == Loss::kHang || loss == Loss::kWait)) {
            while (stage.is_hanging()) {
                if (loss == Loss::kWait) {
                    stage.clock->wait_until(stage.clock->get_now() + kTick);
                }
            }
            return Status::kOk;
        }
        serve(is_lost && loss == Loss::kUnhealthy, is_lost && loss == Loss::kInconsistent);
        if (is_first && loss == Loss::kRunaway) {
            run_wild();
        }
        return Status::kOk;
    }

  private:
    void serve(bool is_unhealthy, bool is_inconsistent) noexcept {
        const Instant now = stage.clock->get_now();
        const GlobalStatus health = is_unhealthy ? GlobalStatus::kExpired : GlobalStatus::kOk;
        if (stage.gate->step(now, health, !is_inconsistent) == WatchdogOutcome::kServiced) {
            stage.trial.taken_at = stage.clock->get_now();
            stage.trial.asked_at = now;
        }
    }
    /// If the gate delayed the regular service, the first of these services may still be within the window.
    void run_wild() noexcept {
        stage.inject();
        static_cast<void>(stage.watchdog->service(stage.clock->get_now()));
        static_cast<void>(stage.watchdog->service(stage.clock->get_now()));
    }

    std::uint64_t frame_{0U};
};

Supervisor supervisor;
constexpr auto kSystem =
    system(frame(kTick), window("supervise", 0_us, 600_us, budget(400_us), mamori::run(supervisor)));
MAMORI_CHECK(kSystem);
ExecutiveFor executive{kSystem};
std::array<WindowThread, 1U> threads;

/// Hangs on the thread that starts the windows.
class Director final : public OpeningObserver {
  public:
    void begin() noexcept { frame_ = 0U; }
    void before_opening(const FrameSchedule::Opening&, Instant) noexcept override {
        if (stage.trial.loss == Loss::kNoWindow && frame_ == stage.loss_frame) {
            stage.inject();
            while (stage.is_hanging()) {
            }
        }
        ++frame_;
    }
    void after_opening(const FrameSchedule::Opening&, WindowOutcome) noexcept override {}

  private:
    std::uint64_t frame_{0U};
};

/// Objects of all trials.
struct Rig {
    const FrameClock& clock;
    GuardedHost& host;
    CoreRunner& runner;
    Director& director;
    int processor;
    ports::posix_rt::Right right;
};

/// @return major frames. Afterwards `stage.trial` has the record.
std::uint64_t run_trial(Rig& rig, Loss loss, std::uint64_t loss_frame) {
    SoftwareWatchdog watchdog{rig.clock, kWatchdogWindow, {&Stage::close_outputs, &stage, false}};
    WatchdogGate gate{watchdog, kGateWindow};
    stage.clock = &rig.clock;
    stage.watchdog = &watchdog;
    stage.gate = &gate;
    stage.loss_frame = loss_frame;
    stage.trial = LossTrial{};
    stage.trial.loss = loss;
    stage.is_closed.store(false, std::memory_order_relaxed);
    supervisor.begin();
    rig.director.begin();
    if (watchdog.open({kWatchdogPriority, rig.processor}) != Status::kOk) {
        return 0U;
    }
    rig.right = combine(rig.right, watchdog.get_priority_right());
    const std::uint64_t frames = loss_frame + kFramesAfter;
    rig.runner.run(frames);
    // A trial without a loss ends while it is still serviced. Hanging work has returned or returns soon.
    stage.trial.ended_at = rig.clock.get_now();
    MAMORI_ENSURE(1, watchdog.close() == Status::kOk);
    while (!rig.host.has_returned(0U)) {
        rig.clock.wait_until(rig.clock.get_now() + kTick);
    }
    stage.trial.cause = watchdog.get_cause();
    stage.trial.is_closed = stage.is_closed.load(std::memory_order_acquire);
    stage.trial.closed_at = Instant{stage.closed_at_ns.load(std::memory_order_relaxed)};
    return frames;
}

}  // namespace

LossRun run_losses(const LossRequest& request) {
    static const FrameClock clock = FrameClock::starting_in(100_ms);
    static_cast<void>(ports::posix_rt::lock_memory(256U * 1024U));
    static const int processor = verification::find_processor();
    const ports::posix_rt::Right right =
        combine(ports::posix_rt::set_priority(pthread_self(), kRunnerPriority),
                ports::posix_rt::set_processor(pthread_self(), processor));
    static GuardedHost host{threads, clock, {kWindowPriority, processor}};
    Director director;
    CoreRunner runner{executive, host, clock};
    runner.set_observer(&director);
    stage.defect = request.defect;
    LossRun result;
    if (executive.initialize() != Status::kOk || executive.start() != Status::kOk ||
        host.open() != Status::kOk) {
        return result;
    }
    Rig rig{clock, host, runner, director, processor, combine(right, host.get_priority_right())};
    std::mt19937_64 random{request.seed};
    const verification::AwakeProcessor awake{processor};
    StallWatch stalls{clock, Duration{kTick.ns / 20}, {kStallPriority, processor}};
    for (std::uint64_t i = 0U; i < request.trial_count; ++i) {
        const std::uint64_t loss_frame = kFramesBefore + random() % kFramesSpread;
        result.frames += run_trial(rig, static_cast<Loss>(i % kLossCount), loss_frame);
        result.trials.push_back(stage.trial);
    }
    stalls.stop();
    while (host.close() != Status::kOk) {
        clock.wait_until(clock.get_now() + kTick);
    }
    result.stalls = stalls.get_stalls();
    result.host = stalls.get_figures();
    result.has_priority = rig.right.is_granted;
    return result;
}

bool write_course(const LossRequest& request, const LossRun& run, const char* path) {
    verification::CourseFile file{"service"};
    file.add("seed", request.seed);
    file.add("defect", verification::get_name(request.defect));
    file.add("frames", run.frames);
    file.add("has_priority", run.has_priority);
    file.add("frame_ns", kTick.ns);
    file.add("timeout_ns", kServiceTimeout.ns);
    file.add("losses", {"none", "hang", "wait", "unhealthy", "inconsistent", "runaway", "no_window"});
    file.add("host", run.host);
    file.add("stalls", run.stalls);
    file.add<LossTrial>("trials", run.trials,
                        {{"loss", [](const LossTrial& row) { return static_cast<std::int64_t>(row.loss); }},
                         {"is_injected", [](const LossTrial& row) { return std::int64_t{row.is_injected}; }},
                         {"injected_ns", [](const LossTrial& row) { return row.injected_at.ns; }},
                         {"service_begin_ns", [](const LossTrial& row) { return row.asked_at.ns; }},
                         {"service_end_ns", [](const LossTrial& row) { return row.taken_at.ns; }},
                         {"is_closed", [](const LossTrial& row) { return std::int64_t{row.is_closed}; }},
                         {"closed_ns", [](const LossTrial& row) { return row.closed_at.ns; }},
                         {"cause", [](const LossTrial& row) { return static_cast<std::int64_t>(row.cause); }},
                         {"end_ns", [](const LossTrial& row) { return row.ended_at.ns; }}});
    return file.write(path);
}

}  // namespace mamori::lost_service
