// SPDX-License-Identifier: Apache-2.0
#include "time_faults.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <random>

#include "mamori/kernel/executive.hpp"
#include "mamori/kernel/system.hpp"
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
using namespace literals;  // NOLINT: units of the table below

constexpr std::size_t kComponentCount = 4U;
constexpr std::size_t kWindowCount = 3U;
constexpr Duration kBudget = 200_us;
constexpr int kWatchPriority = 90;
constexpr int kRunnerPriority = 80;
constexpr int kWindowPriority = 70;

/// A deed that is under way. The thread that does it may be given up meanwhile, and comes back all the same.
struct Doing {
    std::size_t component{0U};
    Instant begin{};
    std::atomic<std::int64_t> end_ns{0};
};

/// Set before the run, for work that never has to look for it.
const FrameClock* time_line = nullptr;
std::vector<Doing>* deeds = nullptr;
std::atomic<std::size_t> deed_count{0U};

class Victim final : public Component {
  public:
    constexpr explicit Victim(const char* name, std::size_t place) noexcept
        : Component(name), place_(place) {}

    /// The next cycle takes `size`. @param[in] size 0: as usual.
    void arm(Kind kind, Duration size) noexcept {
        kind_ = kind;
        size_ns_.store(size.ns, std::memory_order_release);
    }

    Status on_execute(ContextHandle) noexcept override {
        const std::int64_t size = size_ns_.exchange(0, std::memory_order_acquire);
        if (size == 0) {
            return Status::kOk;
        }
        const Instant begin = time_line->get_now();
        Doing& deed = (*deeds)[deed_count.fetch_add(1U, std::memory_order_relaxed)];
        deed.component = place_;
        deed.begin = begin;
        const Instant end = begin + Duration{size};
        if (kind_ == Kind::kSleep) {
            time_line->wait_until(end);
        }
        while (time_line->get_now() < end) {
        }
        deed.end_ns.store(time_line->get_now().ns, std::memory_order_release);
        return Status::kOk;
    }

  private:
    std::size_t place_;
    Kind kind_{Kind::kLoop};
    std::atomic<std::int64_t> size_ns_{0};
};

Victim alpha{"alpha", 0U};
Victim beta{"beta", 1U};
Victim gamma{"gamma", 2U};
Victim delta{"delta", 3U};
constexpr auto kSystem =
    system(frame(kTick), window("first", 0_us, 300_us, budget(kBudget), mamori::run(alpha)),
           window("second", 300_us, 300_us, budget(kBudget), mamori::run(beta, gamma)),
           window("third", 600_us, 300_us, budget(kBudget), mamori::run(delta)));
MAMORI_CHECK(kSystem);
ExecutiveFor executive{kSystem};
std::array<Victim*, kComponentCount> victims{&alpha, &beta, &gamma, &delta};
constexpr std::array<std::size_t, kComponentCount> kWindowOf{0U, 1U, 1U, 2U};
std::array<WindowThread, kWindowCount> threads;

/// Puts the faults in and takes the reports down, on the thread that runs the windows.
class Director final : public OpeningObserver, public ExecutionObserver {
  public:
    Director(const FrameClock& clock, std::vector<Injection> injections)
        : clock_(clock), injections_(std::move(injections)) {
        reports.reserve(kRoom);
        delays.reserve(injections_.size());
    }

    void before_opening(const FrameSchedule::Opening& opening, Instant woke) noexcept override {
        release_ = opening.release;
        woke_ = woke;
        const auto frame = static_cast<std::uint64_t>(opening.release.ns / kTick.ns);
        if (next_ == injections_.size() || frame < injections_[next_].frame) {
            return;
        }
        const Injection& injection = injections_[next_];
        if (injection.kind != Kind::kLateRelease) {
            victims[injection.place]->arm(injection.kind, injection.size);
            ++next_;
        } else if (opening.window == injection.place) {
            const Instant end = opening.release + injection.size;
            while (clock_.get_now() < end) {
            }
            delays.push_back({opening.window, opening.release, clock_.get_now()});
            ++next_;
        }
    }
    void after_opening(const FrameSchedule::Opening&, WindowOutcome) noexcept override {}

    void on_budget_overrun(std::size_t window, std::size_t component, Instant now) noexcept override {
        add({true, window, component, release_, woke_, now, Duration{0}});
    }
    void on_late_release(std::size_t window, Duration lateness, Instant now) noexcept override {
        if (lateness > kTick) {
            add({false, window, kNoIndex, release_, woke_, now, lateness});
        }
    }

    std::vector<Report> reports;
    std::vector<Delay> delays;

  private:
    static constexpr std::size_t kRoom = 1'000'000U;
    void add(const Report& report) noexcept {
        if (reports.size() < kRoom) {
            reports.push_back(report);
        }
    }

    const FrameClock& clock_;
    std::vector<Injection> injections_;
    std::size_t next_{0U};
    Instant release_{};
    Instant woke_{};
};

Plan make_plan() {
    Plan plan{kBudget, {kWindowOf.begin(), kWindowOf.end()}, {}};
    for (const WindowRow& row : kSystem.windows) {
        plan.window_lengths.push_back(row.length);
    }
    return plan;
}

std::string to_text(const Report& report) {
    return std::string{"{\"is_overrun\": "} + (report.is_overrun ? "true" : "false") +
           ", \"window\": " + std::to_string(report.window) +
           ", \"component\": " + (report.is_overrun ? std::to_string(report.component) : "null") +
           ", \"release_ns\": " + std::to_string(report.release.ns) +
           ", \"woke_ns\": " + std::to_string(report.woke.ns) +
           ", \"at_ns\": " + std::to_string(report.at.ns) +
           ", \"lateness_ns\": " + std::to_string(report.lateness.ns) + "}";
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
        injection.kind = static_cast<Kind>(random() % 3U);
        injection.place = random() % (injection.kind == Kind::kLateRelease ? kWindowCount : kComponentCount);
        injection.size = Duration{kTick.ns * 11 / 10 + static_cast<std::int64_t>(random() % 2'900'000U)};
        injections.push_back(injection);
    }
    return injections;
}

Verdict run(const Request& request) {
    // Work that hangs longer than the run may still look at these.
    static const FrameClock clock = FrameClock::starting_in(500_ms);
    static std::vector<Doing> storage(request.injection_count + 1U);
    time_line = &clock;
    deeds = &storage;
    static_cast<void>(ports::posix_rt::lock_memory(256U * 1024U));
    // All on one processor, or whoever tells of stalls would watch another one.
    static const int processor = verification::find_processor();
    const ports::posix_rt::Right right =
        combine(ports::posix_rt::set_priority(pthread_self(), kRunnerPriority),
                ports::posix_rt::set_processor(pthread_self(), processor));
    static GuardedHost host{threads, clock, {kWindowPriority, processor}};
    Director director{clock, make_injections(request)};
    CoreRunner runner{executive, host, clock};
    runner.set_observer(&director);
    Verdict verdict;
    if (host.open() != Status::kOk || executive.initialize() != Status::kOk ||
        executive.start() != Status::kOk) {
        return verdict;
    }
    executive.set_observer(&director);
    verification::StallWatch stalls{clock, Duration{kTick.ns / 20}, {kWatchPriority, processor}};
    runner.run(request.frame_count);
    stalls.stop();
    while (host.close() != Status::kOk) {
        clock.wait_until(clock.get_now() + kTick);
    }
    Course course{std::move(director.reports), {}, std::move(director.delays), stalls.get_stalls()};
    for (std::size_t i = 0U; i < deed_count.load(std::memory_order_relaxed); ++i) {
        const Instant end{storage[i].end_ns.load(std::memory_order_acquire)};
        course.deeds.push_back({storage[i].component, storage[i].begin, end});
    }
    verdict = judge(make_plan(), course);
    verdict.frames = request.frame_count;
    verdict.requested = request.injection_count;
    verdict.has_priority =
        combine(right, combine(host.get_priority_right(), host.get_processor_right())).is_granted;
    return verdict;
}

std::string to_json(const Request& request, const Verdict& verdict) {
    std::vector<std::int64_t> sorted = verdict.detection_ns;
    std::sort(sorted.begin(), sorted.end());
    const auto quantile = [&sorted](std::size_t percent) {
        return sorted.empty() ? std::int64_t{0} : sorted[(sorted.size() - 1U) * percent / 100U];
    };
    const auto number = [](const char* key, std::int64_t value) {
        return ",\n \"" + std::string{key} + "\": " + std::to_string(value);
    };
    const auto count = [&number](const char* key, std::uint64_t value) {
        return number(key, static_cast<std::int64_t>(value));
    };
    std::string list;
    for (const Report& report : verdict.unexplained) {
        list += (list.empty() ? "\n  " : ",\n  ") + to_text(report);
    }
    return "{\"schema\": \"mamori.time_faults/1\"" + count("seed", request.seed) +
           count("frames", verdict.frames) + count("requested", verdict.requested) +
           count("injected", verdict.injected) + count("seen", verdict.seen) +
           count("misnamed", verdict.misnamed) + count("unseen", verdict.unseen) +
           count("tardy", verdict.tardy) + count("tardy_by_host", verdict.tardy_by_host) +
           count("invented", verdict.invented) + count("by_host", verdict.by_host) +
           count("stalls", verdict.stalls) + number("longest_stall_ns", verdict.longest_stall.ns) +
           number("detection_p50_ns", quantile(50U)) + number("detection_p99_ns", quantile(99U)) +
           number("detection_max_ns", quantile(100U)) + ",\n \"unexplained\": [" + list + "]" +
           ",\n \"has_priority\": " + (verdict.has_priority ? "true" : "false") +
           ",\n \"is_well\": " + (verdict.is_well() ? "true" : "false") + "\n}\n";
}

}  // namespace mamori::time_faults
