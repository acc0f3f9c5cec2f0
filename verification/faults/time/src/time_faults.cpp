// SPDX-License-Identifier: Apache-2.0
#include "time_faults.hpp"

#include <array>
#include <random>

#include "director.hpp"
#include "introspection_load.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"
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
using verification::find_processor;
using verification::StallWatch;

constexpr Duration kLead{500'000'000};
constexpr std::size_t kLooksPerFrame = 20U;
/// Above what other programs use, as far as possible.
constexpr int kStallPriority = 98;
constexpr int kWatchPriority = 97;
constexpr int kRunnerPriority = 96;
constexpr int kWindowPriority = 95;
constexpr int kMiddlePriority = 60;

std::array<WindowThread, kWindowCount> threads;

Plan make_plan() {
    Plan plan{kBudget, {kWindowOf.begin(), kWindowOf.end()}, {}, {}};
    for (const WindowRow& row : get_executive().get_view().windows) {
        plan.window_lengths.push_back(row.length);
    }
    const Duration span = kWatchLimits.rate.span;
    plan.watch = {kTick, span + span + kTick};
    return plan;
}

bool is_about_component(Kind kind) noexcept {
    return kind == Kind::kLoop || kind == Kind::kSleep || kind == Kind::kLockedOut ||
           kind == Kind::kStuckGuard;
}

/// What happens to the outputs is not looked at here, only whether and when it does.
void keep_outputs(void*) noexcept {}

/// Runs the frames under the eyes of the watch and of the thread that tells stalls.
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
                      Duration{kTick.ns / std::int64_t{kLooksPerFrame}},
                      {kStallPriority, processor},
                      request.frame_count * kLooksPerFrame};  // none may be missing: they are excuses
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
    course.late_looks = stalls.get_late_looks();
    course.host = stalls.get_figures();
    return course;
}

void add_deeds(Course& course) {
    const Surroundings& around = get_surroundings();
    for (std::size_t i = 0U; i < around.deed_count.load(std::memory_order_relaxed); ++i) {
        const Doing& doing = (*around.deeds)[i];
        const Instant end{doing.end_ns.load(std::memory_order_acquire)};
        course.deeds.push_back({doing.component, doing.begin, end, doing.cause});
    }
}

void add_component_delays(Course& course, const Ends& ends) {
    for (Report& report : course.reports) {
        if (report.is_overrun && ends.covers(report.release)) {
            report.component_kept_off = ends.get_kept_off(report.component, report.release);
        }
    }
}

void add_page_faults(Verdict& verdict) {
    // Those of one window run on one thread: the first of them tells for all.
    for (const std::size_t component : {std::size_t{0U}, std::size_t{1U}, std::size_t{3U}}) {
        verdict.major_faults += get_victim(component).get_meter().get_major();
        verdict.minor_faults += get_victim(component).get_meter().get_minor();
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

Verdict run(const Request& request, const char* out) {
    Verdict verdict;
    const auto seconds = static_cast<unsigned>(request.frame_count / 1000U + 10U);
    PageStorm storm{request.with_storm ? seconds : 0U};
    static IntrospectionLoad load{get_introspection()};
    // Work that hangs longer than the run may still look at these.
    static FaultyTime time{2U * request.injection_count};
    static const FrameClock clock = FrameClock::starting_in(kLead, time);
    static std::vector<Doing> deeds(request.injection_count + 1U);
    static Ends ends{kComponentCount, request.frame_count};
    const Right memory = ports::posix_rt::lock_memory(std::size_t{256U} * 1024U);
    // All on one processor, or whoever tells of stalls would watch another one.
    const int processor = find_processor();
    static Inversion inversion{clock, kMiddlePriority, processor};
    load.bind(processor);
    get_surroundings().clock = &clock;
    get_surroundings().deeds = &deeds;
    get_surroundings().mutex = &inversion.get_mutex();
    get_surroundings().ends = &ends;
    get_surroundings().defect = request.defect;
    const Right right = combine(ports::posix_rt::set_priority(pthread_self(), kRunnerPriority),
                                ports::posix_rt::set_processor(pthread_self(), processor));
    static GuardedHost host{threads, clock, {kWindowPriority, processor}};
    static Director director{{clock, time, inversion, host, load.is_requesting()}, make_injections(request)};
    CoreRunner runner{get_executive(), host, clock};
    get_executive().set_introspection(&get_introspection());
    if (host.open() != Status::kOk || get_executive().initialize() != Status::kOk ||
        get_executive().start() != Status::kOk) {
        return verdict;
    }
    get_executive().set_observer(&director);
    load.set_pace(Pace::kWithoutPause);
    Course course = run_frames(request, director, runner, clock);
    load.set_pace(Pace::kNone);
    static_cast<void>(ports::posix_rt::set_priority(pthread_self(), 0));
    const bool has_blown = storm.stop();
    while (host.close() != Status::kOk) {
        clock.wait_until(clock.get_now() + kTick);
    }
    add_deeds(course);
    course.ends = ends;
    add_component_delays(course, ends);
    verdict = judge(make_plan(), course);
    verdict.frames = request.frame_count;
    verdict.requested = request.injection_count;
    verdict.has_priority =
        combine(right, combine(host.get_priority_right(), host.get_processor_right())).is_granted;
    verdict.reads_under_way = director.get_reads_under_way();
    verdict.requests = load.get_request_count();
    verdict.has_storm = has_blown;
    verdict.has_locked_memory = memory.is_granted && has_locked_pages();
    add_page_faults(verdict);
    if (out != nullptr) {
        static_cast<void>(write_course(request, make_plan(), course, verdict, out));
    }
    return verdict;
}

}  // namespace mamori::time_faults
