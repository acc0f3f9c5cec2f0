// SPDX-License-Identifier: Apache-2.0
// A system in which seeded events delay windows: verification/real_time/timing_verdict.py compares the
// verdicts of the timing report with the labels of the events.
//
//     mamori_timing_events timing --cycles N --out DIR [--seed S]
//
// One event begins every 24 cycles. Writes DIR/labels.json in addition to the files of the run.
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <new>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "mamori/kernel/system/system.hpp"
#include "mamori/timing/timing_run.hpp"

namespace {

using namespace mamori;
using namespace mamori::literals;
using ports::posix_rt::set_priority;
using ports::posix_rt::set_processor;

constexpr std::int64_t kMs = 1'000'000;
constexpr Duration kFrame{10 * kMs};
constexpr std::int64_t kDistance = 24;  ///< cycles from event to event
constexpr std::int64_t kFirst = 60;
constexpr std::int64_t kWork = kMs * 8 / 10;

enum class Kind : std::uint8_t {
    kSpin,        ///< the component works too long
    kWait,        ///< the component waits too long
    kHang,        ///< the component works for several cycles
    kOwnAbove,    ///< a thread of the program delays the runner
    kOwnBetween,  ///< a thread of the program delays the window only
    kOwnBrief,    ///< as kOwnAbove, by a thread that starts and ends with the event
    kHogBefore,   ///< a process with the highest priority starts before the window
    kHogWithin,   ///< such a process starts within the step of the component
    kStopBefore,  ///< the program is stopped before the window
    kStopWithin,  ///< the program is stopped within the step of the component
};
constexpr std::size_t kKinds = 10U;
constexpr std::array<const char*, kKinds> kNames{"spin",        "wait",       "hang",       "own above",
                                                 "own between", "own brief",  "hog before", "hog within",
                                                 "stop before", "stop within"};
constexpr std::array<const char*, kKinds> kLabels{"component",   "component",   "component", "own process",
                                                  "own process", "own process", "outside",   "outside",
                                                  "outside",     "outside"};

struct Event {
    Kind kind{Kind::kSpin};
    std::int64_t cycle{0};
    std::int64_t offset_ns{0};  ///< from the planned window start
    std::int64_t length_ns{0};
};

std::int64_t read_clock(clockid_t clock) {
    timespec now{};
    static_cast<void>(clock_gettime(clock, &now));
    return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

void spin(clockid_t clock, std::int64_t length_ns) {
    const std::int64_t end = read_clock(clock) + length_ns;
    while (read_clock(clock) < end) {
    }
}

void sleep_until(std::int64_t instant_ns) {
    const timespec until{instant_ns / 1'000'000'000, instant_ns % 1'000'000'000};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) != 0) {
    }
}

std::int64_t draw(std::mt19937& random, std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(random()) % (high - low + 1);
}

std::vector<Event> make_plan(std::uint32_t seed, std::uint64_t cycles) {
    std::mt19937 random{seed};
    std::vector<Event> plan;
    for (std::int64_t cycle = kFirst; cycle + kDistance <= static_cast<std::int64_t>(cycles);
         cycle += kDistance) {
        const auto kind = static_cast<Kind>(random() % kKinds);
        switch (kind) {
            case Kind::kSpin:
            case Kind::kWait:
                plan.push_back({kind, cycle, 0, draw(random, 26 * kMs / 10, 7 * kMs)});
                break;
            case Kind::kHang:
                plan.push_back({kind, cycle, 0, draw(random, 12 * kMs, 18 * kMs)});
                break;
            case Kind::kOwnAbove:
            case Kind::kOwnBrief:
            case Kind::kHogBefore:
            case Kind::kStopBefore:
                plan.push_back({kind, cycle, -draw(random, kMs / 10, kMs), draw(random, 6 * kMs, 20 * kMs)});
                break;
            case Kind::kOwnBetween:
            case Kind::kHogWithin:
            case Kind::kStopWithin:
                plan.push_back(
                    {kind, cycle, draw(random, kMs / 5, kMs * 6 / 10), draw(random, 3 * kMs, 5 * kMs)});
                break;
        }
    }
    return plan;
}

/// Memory of this process and of the process that disturbs it.
struct Shared {
    std::atomic<std::int64_t> epoch_ns{0};
    std::atomic<bool> is_over{false};
};

/// Publishes the epoch for the threads and processes that act at planned instants.
class Announcer final : public ports::posix_rt::OpeningObserver {
  public:
    explicit Announcer(Shared& shared) noexcept : shared_(shared) {}
    void before_opening(const FrameSchedule::Opening&, Instant woke) noexcept override {
        if (shared_.epoch_ns.load(std::memory_order_relaxed) == 0) {
            shared_.epoch_ns.store(read_clock(CLOCK_MONOTONIC) - woke.ns, std::memory_order_release);
        }
    }
    void after_opening(const FrameSchedule::Opening&, WindowOutcome) noexcept override {}

  private:
    Shared& shared_;
};

std::int64_t wait_for_epoch(const Shared& shared) {
    while (shared.epoch_ns.load(std::memory_order_acquire) == 0 && !shared.is_over.load()) {
        sleep_until(read_clock(CLOCK_MONOTONIC) + kMs);
    }
    return shared.epoch_ns.load(std::memory_order_acquire);
}

/// Calls `act` for each event of the two kinds, at its instant.
template <typename Act>
void follow(const Shared& shared, const std::vector<Event>& plan, Kind first, Kind second, const Act& act) {
    const std::int64_t epoch = wait_for_epoch(shared);
    for (const Event& event : plan) {
        if (event.kind == first || event.kind == second) {
            sleep_until(epoch + event.cycle * kFrame.ns + event.offset_ns);
            if (shared.is_over.load()) {
                return;
            }
            act(event);
        }
    }
}

class Worker final : public Component {
  public:
    Worker(const char* name, std::int64_t work_ns) noexcept : Component(name), work_ns_(work_ns) {}
    Status on_execute(ContextHandle) noexcept override {
        const std::int64_t epoch = shared == nullptr ? 0 : shared->epoch_ns.load(std::memory_order_acquire);
        const std::int64_t cycle = (read_clock(CLOCK_MONOTONIC) - epoch) / kFrame.ns;
        for (; plan != nullptr && next < plan->size() && (*plan)[next].cycle <= cycle; ++next) {
            const Event& event = (*plan)[next];
            if (event.cycle == cycle && (event.kind == Kind::kSpin || event.kind == Kind::kHang)) {
                spin(CLOCK_THREAD_CPUTIME_ID, event.length_ns);
            } else if (event.cycle == cycle && event.kind == Kind::kWait) {
                sleep_until(read_clock(CLOCK_MONOTONIC) + event.length_ns);
            }
        }
        spin(CLOCK_THREAD_CPUTIME_ID, work_ns_);
        return Status::kOk;
    }
    const Shared* shared{nullptr};
    const std::vector<Event>* plan{nullptr};
    std::size_t next{0U};

  private:
    std::int64_t work_ns_;
};

Worker steady{"steady", kMs / 20};
Worker suspect{"suspect", kWork};
Worker tail{"tail", kMs / 20};
constexpr auto kBudget = 2_ms;
auto table = system(frame(kFrame), window("work", 0_ms, 4_ms, budget(kBudget), run(steady, suspect)),
                    window("rest", 6_ms, 2_ms, budget(1_ms), run(tail)));
ExecutiveFor<decltype(table)> executive{table};
std::array<ports::posix_rt::WindowThread, 2U> threads;

int find_processor(bool is_first) {
    cpu_set_t set;
    CPU_ZERO(&set);
    static_cast<void>(sched_getaffinity(0, sizeof set, &set));
    int found = 0;
    for (int processor = CPU_SETSIZE - 1; processor >= 0; --processor) {
        if (CPU_ISSET(static_cast<std::size_t>(processor), &set)) {
            found = processor;
            if (!is_first) {
                break;
            }
        }
    }
    return found;
}

/// Runs in another process: loads the processor of the windows, and stops the program.
[[noreturn]] void disturb(const Shared& shared, const std::vector<Event>& plan, pid_t program) {
    static_cast<void>(prctl(PR_SET_PDEATHSIG, SIGKILL));
    std::thread stopper{[&] {
        static_cast<void>(set_processor(pthread_self(), find_processor(false)));
        static_cast<void>(set_priority(pthread_self(), 99));
        follow(shared, plan, Kind::kStopBefore, Kind::kStopWithin, [program](const Event& event) {
            static_cast<void>(kill(program, SIGSTOP));
            sleep_until(read_clock(CLOCK_MONOTONIC) + event.length_ns);
            static_cast<void>(kill(program, SIGCONT));
        });
    }};
    static_cast<void>(set_processor(pthread_self(), find_processor(true)));
    static_cast<void>(set_priority(pthread_self(), 99));
    follow(shared, plan, Kind::kHogBefore, Kind::kHogWithin,
           [](const Event& event) { spin(CLOCK_MONOTONIC, event.length_ns); });
    stopper.join();
    while (!shared.is_over.load()) {
        sleep_until(read_clock(CLOCK_MONOTONIC) + 10 * kMs);
    }
    _exit(0);
}

/// A thread of the program at `priority` on the processor of the windows.
std::thread start_rival(const Shared& shared, const std::vector<Event>& plan, Kind kind, int priority) {
    return std::thread{[&shared, &plan, kind, priority] {
        static_cast<void>(set_processor(pthread_self(), find_processor(true)));
        static_cast<void>(set_priority(pthread_self(), priority));
        follow(shared, plan, kind, kind, [](const Event& event) { spin(CLOCK_MONOTONIC, event.length_ns); });
    }};
}

/// Starts a thread for each event. It waits on another processor than that of the windows, if there is one,
/// and ends with the event.
std::thread start_brief_rivals(const Shared& shared, const std::vector<Event>& plan) {
    return std::thread{[&shared, &plan] {
        const int windows = find_processor(true);
        static_cast<void>(set_processor(pthread_self(), find_processor(false)));
        static_cast<void>(set_priority(pthread_self(), 85));
        for (const Event& event : plan) {
            if (event.kind == Kind::kOwnBrief) {
                std::thread{[&shared, &event, windows] {
                    follow(shared, {event}, Kind::kOwnBrief, Kind::kOwnBrief, [windows](const Event& one) {
                        static_cast<void>(set_processor(pthread_self(), windows));
                        spin(CLOCK_MONOTONIC, one.length_ns);
                    });
                }}.join();
            }
        }
    }};
}

/// A busy thread that no window waits for, because its priority is lower.
std::thread start_harmless(const Shared& shared) {
    return std::thread{[&shared] {
        static_cast<void>(set_processor(pthread_self(), find_processor(true)));
        static_cast<void>(set_priority(pthread_self(), 60));
        while (!shared.is_over.load()) {
            spin(CLOCK_MONOTONIC, 2 * kMs);
            sleep_until(read_clock(CLOCK_MONOTONIC) + 5 * kMs);
        }
    }};
}

bool write_labels(const std::string& folder, const std::vector<Event>& plan) {
    std::ofstream out{folder + "/labels.json"};
    const char* separator = "";
    out << "[";
    for (const Event& event : plan) {
        const auto kind = static_cast<std::size_t>(event.kind);
        const std::int64_t end = event.cycle * kFrame.ns + event.offset_ns + event.length_ns;
        out << separator << "{\"kind\": \"" << kNames[kind] << "\", \"label\": \"" << kLabels[kind]
            << "\", \"cycle\": " << event.cycle << ", \"last_cycle\": " << end / kFrame.ns + 1 << "}";
        separator = ",\n ";
    }
    out << "]\n";
    return static_cast<bool>(out);
}

int run_events(const timing::TimingOptions& options, std::uint32_t seed) {
    void* const memory =
        mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) {
        return 1;
    }
    auto& shared = *new (memory) Shared;
    static const std::vector<Event> plan = make_plan(seed, options.cycles);
    suspect.shared = &shared;
    suspect.plan = &plan;
    const pid_t program = getpid();
    const pid_t child = fork();
    if (child == 0) {
        disturb(shared, plan, program);
    }
    Announcer announcer{shared};
    std::thread above = start_rival(shared, plan, Kind::kOwnAbove, 85);
    std::thread between = start_rival(shared, plan, Kind::kOwnBetween, 75);
    std::thread brief = start_brief_rivals(shared, plan);
    std::thread harmless = start_harmless(shared);
    // Linux delivers a stop to the main thread first, which must not wait for the load.
    static_cast<void>(set_priority(pthread_self(), 50));
    const timing::TimingResult result = timing::run_timing({{executive, threads, &announcer}}, options);
    shared.is_over.store(true);
    for (std::thread* one : {&above, &between, &brief, &harmless}) {
        one->join();
    }
    static_cast<void>(waitpid(child, nullptr, 0));
    if (!result.message.empty()) {
        std::fprintf(stderr, "mamori_timing_events: %s\n", result.message.c_str());
    }
    return write_labels(options.out, plan) ? timing::get_exit_status(result.outcome) : 1;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 6 && argc != 8) {
        std::fprintf(stderr, "usage: mamori_timing_events timing --cycles N --out DIR [--seed S]\n");
        return 2;
    }
    timing::TimingOptions options;
    options.cycles = std::strtoull(argv[3], nullptr, 10);
    options.out = argv[5];
    const auto seed = static_cast<std::uint32_t>(argc == 8 ? std::strtoul(argv[7], nullptr, 10) : 1UL);
    if (executive.initialize() != Status::kOk || executive.start() != Status::kOk) {
        return 1;
    }
    return run_events(options, seed);
}
