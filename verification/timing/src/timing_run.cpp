// SPDX-License-Identifier: Apache-2.0
#include "mamori/timing/timing_run.hpp"

#include <sched.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <memory>
#include <numeric>
#include <thread>

#include "mamori/kernel/crc32.hpp"
#include "mamori/ports/posix_rt/real_time_rights.hpp"
#include "mamori/table_dump/table_dump.hpp"
#include "mamori/timing/measuring_host.hpp"
#include "write_run.hpp"

namespace mamori::timing {
namespace {

using ports::posix_rt::CoreRunner;
using ports::posix_rt::FrameClock;
using ports::posix_rt::GuardedHost;
using ports::posix_rt::Right;
using ports::posix_rt::ThreadPlace;

/// From the first thread to the first frame: longer than a busy machine takes for its memory and threads.
constexpr Duration kLead{500'000'000};
/// Windows run below the thread that guards them.
constexpr int kPriorityGap = 10;
/// Steps of mode switches and late stops are no part of a cycle.
constexpr std::size_t kSpareSteps = 4096U;
constexpr std::size_t kStackSize = 256U * 1024U;

/// Everything of one core that the threads of its windows may still touch when the run is over.
struct CoreSession {
    CoreSession(const TimedCore& core, const FrameClock& clock, ThreadPlace place, std::size_t opening_count,
                std::size_t step_count)
        : log{opening_count, step_count},
          guard{core.threads, clock, place},
          host{guard, log, core.executive.get_view().windows.size(), core.devices},
          runner{core.executive, host, clock} {
        runner.set_observer(&host);
    }

    RunLog log;
    GuardedHost guard;
    MeasuringHost host;
    CoreRunner runner;
    Right priority{};
    Right processor{};
};

struct Session {
    explicit Session(FrameClock time_line) noexcept : clock{time_line} {}
    FrameClock clock;
    std::vector<std::unique_ptr<CoreSession>> cores;
};

/// Set while a run is under way, for the handler of signals.
std::atomic<Session*> running{nullptr};
std::atomic<bool> is_interrupted{false};

extern "C" void stop_running(int) {
    is_interrupted.store(true, std::memory_order_relaxed);
    const Session* const session = running.load(std::memory_order_acquire);
    if (session != nullptr) {
        for (const std::unique_ptr<CoreSession>& core : session->cores) {
            core->runner.request_stop();
        }
    }
}

/// SIGINT and SIGTERM go to stop_running() as long as it lives.
class SignalGuard final {
  public:
    SignalGuard() noexcept {
        struct sigaction action{};
        action.sa_handler = &stop_running;
        for (std::size_t i = 0U; i < kSignals.size(); ++i) {
            static_cast<void>(sigaction(kSignals[i], &action, &before_[i]));
        }
    }
    SignalGuard(const SignalGuard&) = delete;
    SignalGuard& operator=(const SignalGuard&) = delete;
    ~SignalGuard() {
        for (std::size_t i = 0U; i < kSignals.size(); ++i) {
            static_cast<void>(sigaction(kSignals[i], &before_[i], nullptr));
        }
    }

  private:
    static constexpr std::array<int, 2U> kSignals{SIGINT, SIGTERM};
    std::array<struct sigaction, kSignals.size()> before_{};
};

std::vector<int> list_processors() {
    cpu_set_t set;
    CPU_ZERO(&set);
    std::vector<int> processors;
    if (sched_getaffinity(0, sizeof(set), &set) == 0) {
        for (int processor = 0; processor < CPU_SETSIZE; ++processor) {
            if (CPU_ISSET(static_cast<std::size_t>(processor), &set)) {
                processors.push_back(processor);
            }
        }
    }
    return processors;
}

/// Median time of a fixed piece of work: what this machine is worth just now.
Duration measure_reference(const FrameClock& clock) {
    std::array<std::uint8_t, 4096U> data{};
    std::iota(data.begin(), data.end(), std::uint8_t{0U});
    std::array<std::int64_t, 201U> times{};
    volatile std::uint32_t sink = 0U;
    for (std::int64_t& time : times) {
        const Instant begin = clock.get_now();
        Crc32 crc;
        for (const std::uint8_t byte : data) {
            crc.add(byte);
        }
        sink = crc.get_value();
        time = (clock.get_now() - begin).ns;
    }
    static_cast<void>(sink);
    std::nth_element(times.begin(), times.begin() + times.size() / 2U, times.end());
    return Duration{times[times.size() / 2U]};
}

/// The first refusal counts.
void add(Right& sum, const Right& right) noexcept {
    if (sum.is_granted) {
        sum = right;
    }
}

struct Room {
    std::size_t openings{1U};
    std::size_t steps{kSpareSteps};
};

Room calc_room(const Executive& executive, std::uint64_t cycles) {
    const SystemView& view = executive.get_view();
    Room room;
    for (std::size_t w = 0U; w < view.windows.size(); ++w) {
        const WindowRow& row = view.windows[w];
        if (row.core == executive.get_core()) {
            const auto openings =
                static_cast<std::size_t>(static_cast<std::int64_t>(cycles) * view.frame.ns / row.period.ns);
            room.openings += openings;
            room.steps += 2U * openings * row.component_count;
        }
    }
    return room;
}

std::string check(const std::vector<TimedCore>& cores, const TimingOptions& options,
                  const std::vector<int>& processors) {
    if (cores.empty() || options.cycles == 0U || options.out.empty()) {
        return "a timing run needs a core, at least one cycle and a folder for its results";
    }
    if (cores.size() > processors.size()) {
        return "the system has " + std::to_string(cores.size()) + " cores, and this process may use " +
               std::to_string(processors.size()) +
               " processor(s): give it more (taskset, container limits) or take another machine";
    }
    std::error_code error;
    std::filesystem::create_directories(options.out, error);
    if (error) {
        return options.out + ": the folder cannot be made: " + error.message();
    }
    return {};
}

void run_core(CoreSession& core, std::uint64_t cycles, ThreadPlace place) {
    core.priority = ports::posix_rt::set_priority(pthread_self(), place.priority);
    core.processor = ports::posix_rt::set_processor(pthread_self(), place.processor);
    core.runner.run(cycles);
}

/// @return false when there are no threads for the windows: those that were started have ended.
bool open_guards(Session& session) {
    for (std::size_t i = 0U; i < session.cores.size(); ++i) {
        if (session.cores[i]->guard.open() != Status::kOk) {
            for (std::size_t opened = 0U; opened < i; ++opened) {
                static_cast<void>(session.cores[opened]->guard.close());
            }
            return false;
        }
    }
    return true;
}

/// @return false when work of a window still hangs.
bool close_guards(Session& session) {
    bool is_closed = true;
    for (const std::unique_ptr<CoreSession>& core : session.cores) {
        is_closed = core->guard.close() == Status::kOk && is_closed;
    }
    return is_closed;
}

void run_all(Session& session, const TimingOptions& options, const std::vector<int>& processors) {
    std::vector<std::thread> threads;
    for (std::size_t i = 0U; i < session.cores.size(); ++i) {
        threads.emplace_back(run_core, std::ref(*session.cores[i]), options.cycles,
                             ThreadPlace{options.priority, processors[i]});
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
}

RunFacts collect(const Session& session, const TimingOptions& options, Duration frame) {
    RunFacts facts;
    facts.asked_cycles = options.cycles;
    facts.frame = frame;
    facts.is_partial = is_interrupted.load(std::memory_order_relaxed);
    facts.run_cycles = options.cycles;
    facts.priority = {true, 0};
    facts.processor = {true, 0};
    for (const std::unique_ptr<CoreSession>& core : session.cores) {
        const Span<const OpeningRow> rows = core->log.get_openings();
        if (facts.is_partial) {
            const std::int64_t last = rows.empty() ? 0 : rows[rows.size() - 1U].release.ns;
            facts.run_cycles = std::min(facts.run_cycles, static_cast<std::uint64_t>(last / frame.ns));
        }
        add(facts.priority, core->priority);
        add(facts.priority, core->guard.get_priority_right());
        add(facts.processor, core->processor);
        add(facts.processor, core->guard.get_processor_right());
    }
    return facts;
}

}  // namespace

int get_exit_status(TimingOutcome outcome) noexcept {
    switch (outcome) {
        case TimingOutcome::kWhole:
            return 0;
        case TimingOutcome::kInterrupted:
            return 130;
        case TimingOutcome::kRefused:
            return 2;
        case TimingOutcome::kFailed:
        default:
            return 1;
    }
}

TimingResult run_timing(const std::vector<TimedCore>& cores, const TimingOptions& options) {
    const std::vector<int> processors = list_processors();
    std::string problem = check(cores, options, processors);
    if (!problem.empty()) {
        return {TimingOutcome::kRefused, problem};
    }
    const SystemView& view = cores.front().executive.get_view();
    const std::string table = options.out + "/table.json";
    problem = options.save_table ? options.save_table(table) : table_dump::save_json(table, view);
    if (!problem.empty()) {
        return {TimingOutcome::kFailed, problem};
    }
    const Right memory = ports::posix_rt::lock_memory(kStackSize);
    const Duration reference = measure_reference(FrameClock::starting_in(Duration{0}));
    auto session = std::make_unique<Session>(FrameClock::starting_in(kLead));
    for (std::size_t i = 0U; i < cores.size(); ++i) {
        const Room room = calc_room(cores[i].executive, options.cycles);
        const ThreadPlace place{options.priority - kPriorityGap, processors[i]};
        session->cores.push_back(
            std::make_unique<CoreSession>(cores[i], session->clock, place, room.openings, room.steps));
    }
    if (!open_guards(*session)) {
        return {TimingOutcome::kFailed, "no threads for the windows: raise the limit (ulimit -u)"};
    }
    is_interrupted.store(false, std::memory_order_relaxed);
    running.store(session.get(), std::memory_order_release);
    {
        const SignalGuard signals;
        run_all(*session, options, processors);
    }
    running.store(nullptr, std::memory_order_release);
    const bool is_closed = close_guards(*session);
    RunFacts facts = collect(*session, options, view.frame);
    facts.reference = reference;
    facts.memory = memory;
    std::vector<const RunLog*> logs;
    for (const std::unique_ptr<CoreSession>& core : session->cores) {
        logs.push_back(&core->log);
    }
    problem = write_run(options.out, logs, facts);
    if (!is_closed) {
        // Work that hangs still uses it, for as long as the process lives.
        static_cast<void>(session.release());
    }
    if (!problem.empty()) {
        return {TimingOutcome::kFailed, problem};
    }
    return {facts.is_partial ? TimingOutcome::kInterrupted : TimingOutcome::kWhole, {}};
}

}  // namespace mamori::timing
