// SPDX-License-Identifier: Apache-2.0
#include "mamori/timing/timing_run.hpp"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "mamori/kernel/run/executives.hpp"
#include "mamori/ports/posix_rt/real_time_rights.hpp"
#include "mamori/table_dump/table_dump.hpp"
#include "mamori/timing/introspection_load.hpp"
#include "mamori/timing/measuring_host.hpp"
#include "reference_work.hpp"
#include "thread_list.hpp"
#include "write_run.hpp"

namespace mamori::timing {
namespace {

using ports::posix_rt::CoreRunner;
using ports::posix_rt::FrameClock;
using ports::posix_rt::GuardedHost;
using ports::posix_rt::OpeningObserver;
using ports::posix_rt::Right;
using ports::posix_rt::ThreadPlace;

/// From the first thread to the first major frame: longer than a busy host needs to start all threads.
constexpr Duration kLead{500'000'000};
/// Before the first major frame, the switches until then are read, which takes up to 1 ms.
constexpr Duration kQuiet{20'000'000};
/// Time limit for the return of work that was aborted at the end of the run.
constexpr Duration kPatience{1'000'000'000};
constexpr Duration kPoll{5'000'000};
/// Slices that are kept per core, 13 MB: enough for a hundred losses next to a load with 70,000 switches per
/// second.
constexpr std::size_t kSliceCapacity = 400'000U;
/// Windows run below the priority of the thread that guards them.
constexpr int kPriorityGap = 10;
/// Steps of mode switches and late stops do not belong to a cycle.
constexpr std::size_t kSpareSteps = 4096U;
/// Length of a block of major frames with one pace of requests.
constexpr Duration kBlock{500'000'000};
constexpr std::size_t kStackSize = 256U * 1024U;

std::atomic<bool> is_interrupted{false};

extern "C" void note_signal(int) {
    is_interrupted.store(true, std::memory_order_relaxed);
}

/// The first block has no requests, while pages and caches settle. Each round of three blocks has each pace
/// once; the first pace changes from round to round.
Pace calc_pace(std::uint64_t block) noexcept {
    return block == 0U ? Pace::kNone : static_cast<Pace>((block - 1U + (block - 1U) / 3U) % 3U);
}

/// Sets the pace of the requests, and ends the run of a core after a signal.
class RunControl final : public OpeningObserver {
  public:
    /// @param[in] load nullptr: none. @param[in] block length of a block.
    RunControl(OpeningObserver& next, CoreRunner& runner, IntrospectionLoad* load, Duration block) noexcept
        : next_(next), runner_(runner), load_(load), block_(block) {}
    void before_opening(const FrameSchedule::Opening& opening, Instant woke) noexcept override {
        if (load_ != nullptr) {
            load_->set_pace(calc_pace(static_cast<std::uint64_t>(opening.release.ns / block_.ns)));
        }
        next_.before_opening(opening, woke);
    }
    void after_opening(const FrameSchedule::Opening& opening, WindowOutcome outcome) noexcept override {
        next_.after_opening(opening, outcome);
        if (is_interrupted.load(std::memory_order_relaxed)) {
            runner_.request_stop();
        }
    }

  private:
    OpeningObserver& next_;
    CoreRunner& runner_;
    IntrospectionLoad* load_;
    Duration block_;
};

/// All data of one core that the threads of its windows can still use after the run.
struct CoreSession {
    CoreSession(const TimedCore& core, RunLog& rows, const FrameClock& clock, ThreadPlace place,
                IntrospectionLoad* load, Duration block)
        : log{rows},
          guard{core.threads, clock, place},
          switches{kSliceCapacity},
          host{guard, log, core.executive.get_view().windows.size(), core.devices, &switches},
          runner{core.executive, host, clock},
          control{host, runner, load, block} {
        runner.set_observer(&control);
    }

    RunLog& log;
    GuardedHost guard;
    SwitchLog switches;
    MeasuringHost host;
    CoreRunner runner;
    RunControl control;
    Right priority{};
    Right processor{};
    Right switch_right{};
    ThreadPlace runner_place{};
    std::size_t window_count{0U};  ///< windows
};

struct Session {
    std::vector<std::unique_ptr<RunLog>> logs;
    std::unique_ptr<FrameClock> clock;
    std::unique_ptr<IntrospectionLoad> load;  ///< nullptr: no requests
    std::uint64_t block_cycles{0U};           ///< likewise 0
    std::vector<std::unique_ptr<CoreSession>> cores;
};

/// While this object exists, SIGINT and SIGTERM only set a flag.
class SignalGuard final {
  public:
    SignalGuard() noexcept {
        struct sigaction action{};
        action.sa_handler = &note_signal;
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

struct Room {
    std::size_t openings{1U};
    std::size_t steps{kSpareSteps};
};

/// @return no value if the number of cycles is too large to count.
std::optional<Room> calc_room(const Executive& executive, std::uint64_t cycles) {
    const SystemView& view = executive.get_view();
    const auto cycles_max =
        static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max() / view.frame.ns);
    if (cycles > cycles_max) {
        return std::nullopt;
    }
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

/// Memory of the rows of all cores [byte], during collection and writing.
double calc_memory(const std::vector<TimedCore>& cores, std::uint64_t cycles) {
    double bytes = 0.0;
    for (const TimedCore& core : cores) {
        const std::optional<Room> room = calc_room(core.executive, cycles);
        if (!room.has_value()) {
            return std::numeric_limits<double>::infinity();
        }
        bytes += 2.0 * (static_cast<double>(room->openings) * sizeof(OpeningRow) +
                        static_cast<double>(room->steps) * sizeof(StepRow));
    }
    return bytes;
}

/// Half of the free memory of the host, so that other programs can continue.
double get_memory() {
    return 0.5 * static_cast<double>(sysconf(_SC_AVPHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

std::size_t find_background_of(const TimedCore& core) {
    return mamori::detail::find_background_of(core.executive.get_view(), core.executive.get_core());
}

std::size_t count_ordinary(const std::vector<TimedCore>& cores, std::size_t end) {
    return static_cast<std::size_t>(
        std::count_if(cores.begin(), cores.begin() + static_cast<std::ptrdiff_t>(end),
                      [](const TimedCore& core) { return find_background_of(core) == kNoIndex; }));
}

/// Place of the runner of a core. Background windows run on the processor of their core, and their runner
/// below the ordinary windows.
ThreadPlace calc_place(const std::vector<TimedCore>& cores, std::size_t index, const TimingOptions& options,
                       const std::vector<int>& processors) {
    const std::size_t background_of = find_background_of(cores[index]);
    if (background_of == kNoIndex) {
        return {options.priority, processors[count_ordinary(cores, index)]};
    }
    const auto ordinary = std::find_if(cores.begin(), cores.end(), [background_of](const TimedCore& core) {
        return core.executive.get_core() == background_of;
    });
    const auto place = static_cast<std::size_t>(std::distance(cores.begin(), ordinary));
    return {options.priority - kPriorityGap - 1,
            ordinary == cores.end() ? processors.front() : processors[count_ordinary(cores, place)]};
}

std::string check(const std::vector<TimedCore>& cores, const TimingOptions& options,
                  const std::vector<int>& processors) {
    const std::size_t ordinary_count = count_ordinary(cores, cores.size());
    const int priority_min = kPriorityGap + (ordinary_count < cores.size() ? 3 : 1);
    if (cores.empty() || options.cycles == 0U || options.out.empty() || options.priority < priority_min ||
        options.priority > 99) {
        return "a timing run requires a core, at least one cycle, a folder for its results, and a priority "
               "of " +
               std::to_string(priority_min) + " .. 99";
    }
    if (ordinary_count > processors.size()) {
        return "the system has " + std::to_string(ordinary_count) + " cores, and this process may use " +
               std::to_string(processors.size()) +
               " processor(s): permit more (taskset, container limits) or use another host";
    }
    if (calc_memory(cores, options.cycles) > get_memory()) {
        return std::to_string(options.cycles) + " cycles need more memory than this host has free: run fewer";
    }
    if (options.states.empty() == static_cast<bool>(options.get_state)) {
        return "TimingOptions::states and get_state require each other: set both or neither";
    }
    if (options.with_requests && options.introspection == nullptr) {
        return "this program has no introspection for --requests: set TimingOptions::introspection";
    }
    std::error_code error;
    std::filesystem::create_directories(options.out, error);
    if (error) {
        return options.out + ": the folder cannot be created: " + error.message();
    }
    return {};
}

void run_core(CoreSession& core, const FrameClock& clock, std::uint64_t cycles, ThreadPlace place) {
    core.priority = ports::posix_rt::set_priority(pthread_self(), place.priority);
    core.processor = ports::posix_rt::set_processor(pthread_self(), place.processor);
    core.switches.take_runner();
    clock.wait_until(Instant{0} - kQuiet);
    core.switches.read();
    core.runner.run(cycles);
    core.host.finish();
}

/// @return false if no threads are available for the windows; threads that were started have ended.
bool open_guards(Session& session) {
    for (std::size_t i = 0U; i < session.cores.size(); ++i) {
        if (session.cores[i]->guard.open(session.cores[i]->runner_place.priority) != Status::kOk) {
            for (std::size_t opened = 0U; opened < i; ++opened) {
                static_cast<void>(session.cores[opened]->guard.close());
            }
            return false;
        }
    }
    return true;
}

/// Waits for late work. @return false if work of a window still hangs.
bool close_guards(Session& session) {
    const Instant last = session.clock->get_now() + kPatience;
    bool is_closed = false;
    while (!is_closed) {
        is_closed = true;
        for (const std::unique_ptr<CoreSession>& core : session.cores) {
            is_closed = core->guard.close() == Status::kOk && is_closed;
        }
        const Instant now = session.clock->get_now();
        if (!is_closed && now >= last) {
            return false;
        }
        if (!is_closed) {
            session.clock->wait_until(now + kPoll);
        }
    }
    return true;
}

/// @throw std::system_error if no thread is available; threads that were started have ended.
void run_all(Session& session, const TimingOptions& options) {
    std::vector<std::thread> threads;
    const auto join = [&threads] {
        for (std::thread& thread : threads) {
            thread.join();
        }
    };
    try {
        for (std::size_t i = 0U; i < session.cores.size(); ++i) {
            threads.emplace_back(run_core, std::ref(*session.cores[i]), std::cref(*session.clock),
                                 options.cycles, session.cores[i]->runner_place);
        }
    } catch (const std::system_error&) {
        for (const std::unique_ptr<CoreSession>& core : session.cores) {
            core->runner.request_stop();
        }
        join();
        static_cast<void>(close_guards(session));
        throw;
    }
    join();
}

SwitchFacts collect_switches(const Session& session) {
    SwitchFacts facts;
    std::vector<const SwitchLog*> logs;
    for (const std::unique_ptr<CoreSession>& core : session.cores) {
        // The log covers one processor, so the threads must be bound to it.
        const Right bound = combine(core->processor, core->guard.get_processor_right());
        CoreSwitches one{
            &core->switches, combine(core->switch_right, bound), core->runner_place.processor, {}};
        for (std::size_t window = 0U; window < core->window_count; ++window) {
            one.window_threads.push_back(core->host.get_thread(window));
        }
        logs.push_back(&core->switches);
        facts.cores.push_back(std::move(one));
    }
    facts.threads = list_threads(logs);
    for (const std::int64_t instant : end_continuations()) {
        facts.continued.push_back(Instant{instant - session.clock->get_epoch_ns()});
    }
    return facts;
}

RunFacts collect(const Session& session, const TimingOptions& options, Duration frame) {
    RunFacts facts;
    facts.asked_cycles = options.cycles;
    facts.frame = frame;
    facts.is_partial = is_interrupted.load(std::memory_order_relaxed);
    facts.run_cycles = options.cycles;
    facts.priority = {true, 0};
    facts.processor = {true, 0};
    Instant last{};
    for (const std::unique_ptr<CoreSession>& core : session.cores) {
        const Span<const OpeningRow> rows = core->log.get_openings();
        last = rows.empty() ? last : std::max(last, rows[rows.size() - 1U].release);
        if (facts.is_partial) {
            const Duration time =
                rows.empty() ? Duration{0} : rows[rows.size() - 1U].release - rows[0].release;
            facts.run_cycles = std::min(facts.run_cycles, static_cast<std::uint64_t>(time.ns / frame.ns));
        }
        facts.priority = combine(facts.priority, combine(core->priority, core->guard.get_priority_right()));
        facts.processor =
            combine(facts.processor, combine(core->processor, core->guard.get_processor_right()));
    }
    facts.switches = collect_switches(session);
    if (session.load != nullptr) {
        facts.block_cycles = session.block_cycles;
        facts.request_count = session.load->get_request_count();
        const auto last_block = static_cast<std::uint64_t>(last.ns / frame.ns) / session.block_cycles;
        for (std::uint64_t block = 0U; block <= last_block; ++block) {
            facts.paces.push_back(calc_pace(block));
        }
    }
    return facts;
}

/// All data of the threads of the run, created before the first thread.
std::unique_ptr<Session> make_session(const std::vector<TimedCore>& cores, const TimingOptions& options,
                                      const std::vector<int>& processors) {
    auto session = std::make_unique<Session>();
    for (const TimedCore& core : cores) {
        const Room room = calc_room(core.executive, options.cycles).value_or(Room{});
        session->logs.push_back(std::make_unique<RunLog>(room.openings, room.steps));
    }
    session->clock = std::make_unique<FrameClock>(FrameClock::starting_in(kLead));
    const Duration frame = cores.front().executive.get_view().frame;
    const std::int64_t block_cycles = std::max(std::int64_t{1}, kBlock.ns / frame.ns);
    if (options.with_requests) {
        session->load = std::make_unique<IntrospectionLoad>(*options.introspection);
        session->block_cycles = static_cast<std::uint64_t>(block_cycles);
    }
    for (std::size_t i = 0U; i < cores.size(); ++i) {
        const ThreadPlace runner = calc_place(cores, i, options, processors);
        const int gap = runner.priority == options.priority ? kPriorityGap : 1;
        const ThreadPlace place{runner.priority - gap, runner.processor};
        const Span<const WindowRow> windows = cores[i].executive.get_view().windows;
        for (std::size_t w = 0U; w < windows.size(); ++w) {
            static_cast<void>(cores[i].threads[w].set_execution_budget(windows[w].execution_budget));
        }
        session->cores.push_back(std::make_unique<CoreSession>(cores[i], *session->logs[i], *session->clock,
                                                               place, i == 0U ? session->load.get() : nullptr,
                                                               Duration{block_cycles * frame.ns}));
        CoreSession& core = *session->cores.back();
        if (options.get_state) {
            core.host.set_state_source(options.get_state);
        }
        core.window_count = windows.size();
        core.runner_place = runner;
        core.switch_right = core.switches.open(runner.processor, *session->clock);
    }
    return session;
}

std::string write_all(const Session& session, const TimingOptions& options, const RunFacts& facts) {
    std::vector<const RunLog*> logs;
    for (const std::unique_ptr<RunLog>& log : session.logs) {
        logs.push_back(log.get());
    }
    return write_run(options.out, logs, facts);
}

/// Hanging work uses the session until the process ends, so it must never be destroyed, not even at exit.
void keep_for_ever(std::unique_ptr<Session> session) {
    static auto* const kept = new std::vector<std::unique_ptr<Session>>;
    kept->push_back(std::move(session));
}

TimingResult measure(const std::vector<TimedCore>& cores, const TimingOptions& options,
                     const std::vector<int>& processors) {
    const SystemView& view = cores.front().executive.get_view();
    std::string problem = remove_files(options.out);
    if (problem.empty()) {
        const std::string table = options.out + "/table.json";
        problem = options.save_table ? options.save_table(table) : table_dump::save_json(table, view);
    }
    if (!problem.empty()) {
        return {TimingOutcome::kFailed, problem};
    }
    is_interrupted.store(false, std::memory_order_relaxed);
    const SignalGuard signals;  // until everything is written
    const Right memory = ports::posix_rt::lock_memory(kStackSize);
    const Duration reference = measure_reference(FrameClock::starting_in(Duration{0}));
    std::unique_ptr<Session> session = make_session(cores, options, processors);
    if (!open_guards(*session)) {
        return {TimingOutcome::kFailed, "no threads for the windows: raise the limit (ulimit -u)"};
    }
    watch_continuations();
    run_all(*session, options);
    const bool is_closed = close_guards(*session);
    for (const std::unique_ptr<CoreSession>& core : session->cores) {
        core->host.finish();
    }
    RunFacts facts = collect(*session, options, view.frame);
    session->load.reset();  // otherwise, it would remain together with the hanging work
    facts.reference = reference;
    facts.states = options.states;
    facts.memory = memory;
    if (options.tell_notes) {
        facts.notes = options.tell_notes();
    }
    if (options.tell_findings) {
        facts.findings = options.tell_findings();
    }
    problem = write_all(*session, options, facts);
    if (!is_closed) {
        keep_for_ever(std::move(session));
    }
    if (!problem.empty()) {
        return {TimingOutcome::kFailed, problem};
    }
    return {facts.is_partial ? TimingOutcome::kInterrupted : TimingOutcome::kWhole, {}};
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
            break;
    }
    return 1;
}

TimingResult run_timing(const std::vector<TimedCore>& cores, const TimingOptions& options) {
    const std::vector<int> processors = list_processors();
    const std::string problem = check(cores, options, processors);
    if (!problem.empty()) {
        return {TimingOutcome::kRefused, problem};
    }
    try {
        return measure(cores, options, processors);
    } catch (const std::bad_alloc&) {
        return {TimingOutcome::kFailed, "not enough memory for so many cycles: run fewer"};
    } catch (const std::system_error& error) {
        return {TimingOutcome::kFailed, std::string{"no threads can be created: "} + error.what()};
    }
}

}  // namespace mamori::timing
