// SPDX-License-Identifier: Apache-2.0
#include "time_faults.hpp"

#include <array>
#include <random>

#include "director.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"
#include "mamori/timing/introspection_load.hpp"
#include "mamori/verification/stall_watch.hpp"
#include "page_storm.hpp"
#include "victims.hpp"

namespace mamori::time_faults {
namespace {

using ports::posix_rt::CoreRunner;
using ports::posix_rt::FrameClock;
using ports::posix_rt::GridBeat;
using ports::posix_rt::GridWatch;
using ports::posix_rt::GuardedHost;
using ports::posix_rt::Right;
using ports::posix_rt::WindowThread;
using timing::IntrospectionLoad;
using timing::Pace;
using verification::find_processor;
using verification::StallWatch;

constexpr Duration kLead{500'000'000};
constexpr std::size_t kPollsPerFrame = 20U;
/// Above the priorities of other programs, as far as possible.
constexpr int kStallPriority = 98;
constexpr int kWatchPriority = 97;
constexpr int kRunnerPriority = 96;
constexpr int kWindowPriority = 95;
constexpr int kMiddlePriority = 60;

std::array<WindowThread, kWindowCount> threads;

bool is_about_component(Kind kind) noexcept {
    return kind == Kind::kLoop || kind == Kind::kSleep || kind == Kind::kLockedOut ||
           kind == Kind::kStuckGuard;
}

/// Only whether and when the outputs are closed is recorded.
void keep_outputs(void*) noexcept {}

void open_meter(void* victim, std::size_t, std::size_t) noexcept {
    static_cast<Victim*>(victim)->open_meter();
}

/// A meter that the host leaves closed opens in the first window.
void open_meters(GuardedHost& host, const FrameClock& clock) {
    for (std::size_t place = 0U; place < kComponentCount; ++place) {
        const WindowHost::Work work{&open_meter, &get_victim(place),         kWindowOf[place], place, 0U,
                                    1U,          WindowHost::Pass::kModeStep};
        static_cast<void>(host.run_within(work, clock.get_now() + kLead));
    }
}

/// Runs the frames while the monitor and the thread that records stalls poll.
Course run_frames(const Request& request, Director& director, CoreRunner& runner, const FrameClock& clock) {
    const int processor = find_processor();
    static std::array<GridBeat, 1U> beats{GridBeat{get_executive().get_view(), 0U, &director}};
    GridWatch watch{beats,
                    clock,
                    ports::posix_rt::get_raw_clock(),
                    kWatchLimits,
                    {&keep_outputs, nullptr},
                    {kWatchPriority, processor}};
    runner.set_observer(beats.data());
    director.set_watch(&watch);
    StallWatch stalls{clock,
                      Duration{kTick.ns / std::int64_t{kPollsPerFrame}},
                      {kStallPriority, processor},
                      request.frame_count * kPollsPerFrame};  // all must be recorded: they are host causes
    if (watch.open() == Status::kOk) {
        beats[0].expect(Instant{0});
        runner.run(request.frame_count);
    }
    beats[0].rest();
    watch.close();
    director.set_watch(nullptr);
    stalls.stop();
    Course course = director.get_course();
    course.stalls = stalls.get_stalls();
    course.late_polls = stalls.get_late_polls();
    course.host = stalls.get_figures();
    return course;
}

void add_overruns(Course& course) {
    const Surroundings& around = get_surroundings();
    for (std::size_t i = 0U; i < around.overrun_count.load(std::memory_order_relaxed); ++i) {
        const OpenOverrun& overrun = (*around.overruns)[i];
        const Instant end{overrun.end_ns.load(std::memory_order_acquire)};
        course.overruns.push_back({overrun.component, overrun.begin, end, overrun.cause});
    }
}

void add_component_delays(const ComponentDelays& delays, Course& course) {
    for (Report& report : course.reports) {
        if (report.is_overrun) {
            report.component_delay = delays.get(report.component, report.release);
        }
    }
}

void add_page_faults(Course& course) {
    // Components of one window run on one thread: the first component has the count of all.
    for (const std::size_t component : {std::size_t{0U}, std::size_t{1U}, std::size_t{3U}}) {
        course.major_faults += get_victim(component).get_meter().get_major();
        course.minor_faults += get_victim(component).get_meter().get_minor();
    }
}

}  // namespace

std::vector<Injection> make_injections(const Request& request) {
    std::mt19937_64 random{request.seed};
    std::vector<Injection> injections;
    const std::uint64_t stride =
        request.injection_count == 0U ? 1U : request.frame_count / request.injection_count;
    for (std::size_t i = 0U; i < request.injection_count; ++i) {
        Injection injection;
        injection.frame = i * stride + random() % (stride - kDistance + 1U);
        injection.kind = static_cast<Kind>(random() % kKindCount);
        injection.place = random() % (is_about_component(injection.kind) ? kComponentCount : kWindowCount);
        injection.size = Duration{kTick.ns * 11 / 10 + static_cast<std::int64_t>(random() % 2'900'000U)};
        const auto ppm = static_cast<std::int64_t>(10'000U + random() % 90'001U);
        if (injection.kind == Kind::kFastClock || injection.kind == Kind::kSlowClock) {
            injection.size = Duration{kTick.ns * 25};
            injection.ppm = injection.kind == Kind::kFastClock ? ppm : -ppm;
        }
        injections.push_back(injection);
    }
    return injections;
}

Course run(const Request& request) {
    const auto seconds = static_cast<unsigned>(request.frame_count / 1000U + 10U);
    PageStorm storm{request.with_storm ? seconds : 0U};
    static IntrospectionLoad load{get_introspection()};
    // Work that hangs beyond the end of the run may still use these.
    static FaultyTime time{2U * request.injection_count};
    static const FrameClock clock = FrameClock::starting_in(kLead, time);
    static std::vector<OpenOverrun> overruns(request.injection_count + 1U);
    static ComponentDelays delays{kComponentCount, request.frame_count};
    const Right memory = ports::posix_rt::lock_memory(std::size_t{256U} * 1024U);
    // All on one processor, because stalls of other processors are not relevant for the windows.
    const int processor = find_processor();
    static Inversion inversion{clock, kMiddlePriority, processor};
    load.bind(processor);
    get_surroundings().clock = &clock;
    get_surroundings().overruns = &overruns;
    get_surroundings().mutex = &inversion.get_mutex();
    get_surroundings().delays = &delays;
    get_surroundings().defect = request.defect;
    const Right right = combine(ports::posix_rt::set_priority(pthread_self(), kRunnerPriority),
                                ports::posix_rt::set_processor(pthread_self(), processor));
    static GuardedHost host{threads, clock, {kWindowPriority, processor}};
    static Director director{{clock, time, inversion, host, load.is_requesting()}, make_injections(request)};
    CoreRunner runner{get_executive(), host, clock};
    get_executive().set_introspection(&get_introspection());
    if (host.open() != Status::kOk || get_executive().initialize() != Status::kOk ||
        get_executive().start() != Status::kOk) {
        return {};
    }
    open_meters(host, clock);
    get_executive().set_observer(&director);
    load.set_pace(Pace::kWithoutPause);
    Course course = run_frames(request, director, runner, clock);
    load.set_pace(Pace::kNone);
    static_cast<void>(ports::posix_rt::set_priority(pthread_self(), 0));
    course.has_storm = storm.stop();
    while (host.close() != Status::kOk) {
        clock.wait_until(clock.get_now() + kTick);
    }
    add_overruns(course);
    add_component_delays(delays, course);
    course.has_run = true;
    course.has_priority =
        combine(right, combine(host.get_priority_right(), host.get_processor_right())).is_granted;
    course.requests = load.get_request_count();
    course.has_locked_memory = memory.is_granted && has_locked_pages();
    add_page_faults(course);
    return course;
}

}  // namespace mamori::time_faults
