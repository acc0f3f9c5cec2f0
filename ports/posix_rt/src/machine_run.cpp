// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/machine_run.hpp"

#include "mamori/ports/posix_rt/crash_handlers.hpp"
#include "mamori/ports/posix_rt/crash_note.hpp"
#include "mamori/ports/posix_rt/crash_stack.hpp"

namespace mamori::ports::posix_rt {
namespace {

constexpr std::size_t kLockedStack = std::size_t{64U} * 1024U;
/// Time limit for the return of work that was aborted, at the end of a run.
constexpr Duration kPatience{1'000'000'000};
constexpr Duration kPoll{5'000'000};

/// Leaves the stop signals to the threads with a fixed priority, which a busy host does not delay.
class SignalBlock final {
  public:
    SignalBlock() noexcept {
        sigset_t set{};
        MAMORI_ENSURE(2, sigemptyset(&set) == 0);
        for (const int signal : kStopSignals) {
            MAMORI_ENSURE(3, sigaddset(&set, signal) == 0);
        }
        MAMORI_ENSURE(4, pthread_sigmask(SIG_BLOCK, &set, &before_) == 0);
    }
    SignalBlock(const SignalBlock&) = delete;
    SignalBlock& operator=(const SignalBlock&) = delete;
    ~SignalBlock() { static_cast<void>(pthread_sigmask(SIG_SETMASK, &before_, nullptr)); }

  private:
    sigset_t before_{};
};

/// Gives the calling thread the priority of the threads that run the windows: a guard that the windows of its
/// actions could preempt would take their priorities.
class RunnerPriority final {
  public:
    explicit RunnerPriority(int priority) noexcept {
        MAMORI_ENSURE(6, pthread_getschedparam(pthread_self(), &policy_, &before_) == 0);
        is_raised_ = get_own_priority() < priority && set_priority(pthread_self(), priority).is_granted;
    }
    RunnerPriority(const RunnerPriority&) = delete;
    RunnerPriority& operator=(const RunnerPriority&) = delete;
    ~RunnerPriority() {
        if (is_raised_) {
            static_cast<void>(pthread_setschedparam(pthread_self(), policy_, &before_));
        }
    }

  private:
    int policy_{0};
    sched_param before_{};
    bool is_raised_{false};
};

bool is_valid(const MachineOptions& options, const MachineParts& parts) noexcept {
    const SystemView& view = parts.executives.get(0U).get_view();
    const Duration frame = view.frame;
    const std::size_t processors = mamori::detail::count_processors(view);
    const int priority_min = parts.hosts.size() > processors ? MachineOptions::kBackgroundPriorityMin
                                                             : MachineOptions::kPriorityMin;
    const GridLimits& watch = options.watch;
    const bool is_watch_valid = watch.lateness >= Duration{0} && watch.period > Duration{0} &&
                                watch.rate.span > Duration{0} && watch.rate.limit_ppm > 0;
    // By subtraction, because a sum of options can overflow.
    const bool is_positive = options.lead > Duration{0} && options.watchdog_timeout > Duration{0};
    const std::int64_t left = is_positive ? options.watchdog_timeout.ns - options.lead.ns : 0;
    return is_watch_valid && is_positive && options.window_stack >= kThreadStackMin &&
           options.runner_stack >= kThreadStackMin && options.priority >= priority_min &&
           options.priority <= MachineOptions::kPriorityMax && left / 2 - frame.ns > watch.period.ns &&
           (options.processors.empty() || options.processors.size() >= processors) &&
           (options.recorder == nullptr || options.recorder_capacity > 0U);
}

bool has_returned(const MachineParts& parts) noexcept {
    const std::size_t windows = parts.executives.get(0U).get_view().windows.size();
    for (const GuardedHost& host : parts.hosts) {
        for (std::size_t window = 0U; window < windows; ++window) {
            if (!host.has_returned(window)) {
                return false;
            }
        }
    }
    return true;
}

/// Waits for aborted work, at most kPatience.
void wait_for_return(const MachineParts& parts) noexcept {
    const Instant last = parts.clock.get_now() + kPatience;
    for (Instant now = parts.clock.get_now(); now < last && !has_returned(parts); now = now + kPoll) {
        parts.clock.wait_until(now + kPoll);
    }
}

Status close_hosts(Span<GuardedHost> hosts) noexcept {
    Status result = Status::kOk;
    for (GuardedHost& host : hosts) {
        const Status status = host.close();
        result = result == Status::kOk ? status : result;
    }
    return result;
}

/// The threads of windows inherit the block: work that hangs must not receive a stop signal.
Status open_hosts(const MachineParts& parts) noexcept {
    const SignalBlock block;
    for (std::size_t core = 0U; core < parts.hosts.size(); ++core) {
        const Status status = parts.hosts[core].open(parts.threads[core].place.priority);
        if (status != Status::kOk) {
            static_cast<void>(close_hosts(parts.hosts.subspan(0U, core)));
            return status;
        }
    }
    return Status::kOk;
}

}  // namespace

void MachineGuard::on_action_overrun(std::size_t component, ComponentAction action) noexcept {
    run_.end_action(component, executive_.get_view().components[component]->get_name(), action);
}

DeviceCaller::DeviceCaller(const SystemView& view, std::size_t core, Devices& devices,
                           const FrameClock& clock, MachineRun& run) noexcept
    : devices_(devices), clock_(clock), run_(run), frame_(view.frame) {
    FrameSchedule schedule{view, core, Instant{0}};
    first_ = schedule.get_next().release;
    while (schedule.get_next().release.ns < frame_.ns) {
        last_ = schedule.get_next().release;
        schedule.advance();
    }
}

void DeviceCaller::before_opening(const FrameSchedule::Opening& opening, Instant woke) noexcept {
    const std::int64_t place = opening.release.ns % frame_.ns;
    if (place == first_.ns) {
        const Instant start{opening.release.ns - place};
        devices_.sample(static_cast<std::uint64_t>(start.ns / frame_.ns), start);
        const Duration time = clock_.get_now() - woke;
        longest_sample_ = time > longest_sample_ ? time : longest_sample_;
    }
}

void DeviceCaller::after_opening(const FrameSchedule::Opening& opening, WindowOutcome) noexcept {
    const std::int64_t place = opening.release.ns % frame_.ns;
    if (place == last_.ns) {
        const Instant start{opening.release.ns - place};
        const Instant before = clock_.get_now();
        devices_.apply(static_cast<std::uint64_t>(start.ns / frame_.ns), start, frame_);
        const Instant now = clock_.get_now();
        longest_apply_ = now - before > longest_apply_ ? now - before : longest_apply_;
        run_.end_frame(now);
    }
}

Status MachineRun::fail(MachineStep step, Status status) noexcept {
    if (report_.failed_step == MachineStep::kNone && status != Status::kOk) {
        report_.failed_step = step;
    }
    return status;
}

void MachineRun::record(Instant time, MachineEvent event, Severity severity, std::int64_t argument) noexcept {
    if (recorder_.is_open()) {
        recorder_.write(time, severity, kMachineSource, static_cast<std::uint16_t>(event), argument);
    }
}

void MachineRun::note_signal() noexcept {
    report_.signal = signal_.load();
    if (report_.signal != 0) {
        const std::int64_t between = closed_ns_.load() - signal_ns_.load();
        report_.signalled = Instant{signal_ns_.load() - clock_->get_epoch_ns()};
        // A signal can come after the outputs were closed for another reason.
        report_.until_closed = Duration{between > 0 ? between : 0};
    }
}

/// Before the stop, in which a component can crash.
void MachineRun::record_end_of_frames() noexcept {
    note_signal();
    const Instant now = clock_->get_now();
    if (report_.signal != 0 || is_stop_wanted_.load(std::memory_order_relaxed)) {
        record(report_.signal != 0 ? report_.signalled : now, MachineEvent::kStopRequested, Severity::kInfo,
               report_.signal);
    }
    record(Instant{closed_ns_.load() - clock_->get_epoch_ns()}, MachineEvent::kOutputsClosed, Severity::kInfo,
           report_.until_closed.ns);
}

void MachineRun::close_outputs(void* self) noexcept {
    MachineRun& run = *static_cast<MachineRun*>(self);
    if (run.are_outputs_closed_.load()) {
        return;
    }
    // Also while another thread is in this call: that thread may not get the processor again.
    if (run.outputs_.close != nullptr) {
        run.outputs_.close(run.outputs_.argument);
    }
    const std::int64_t now = get_monotonic_clock().read_ns();
    if (!run.are_outputs_closed_.exchange(true)) {
        run.closed_ns_.store(now);
    }
}

void MachineRun::request_stop() noexcept {
    if (is_stop_wanted_.exchange(true) || !has_clock_.load(std::memory_order_acquire)) {
        return;
    }
    const std::int64_t now = clock_->get_now().ns;
    const Instant end{now < 0 ? 0 : (now / frame_.ns + 1) * frame_.ns};
    for (CoreRunner& runner : runners_) {
        runner.request_stop_at(end);
    }
}

void MachineRun::on_stop_signal(int signal) noexcept {
    int none = 0;
    const std::int64_t now = get_monotonic_clock().read_ns();
    if (signal_.compare_exchange_strong(none, signal)) {
        signal_ns_.store(now);
    }
    request_stop();
    close_outputs(this);
}

void MachineRun::end_frame(Instant now) noexcept {
    const std::uint64_t look_count = watch_->get_look_count();
    if (look_count != served_look_count_) {
        served_look_count_ = look_count;
        static_cast<void>(watchdog_->service(now));  // an expired watchdog ends the process
    }
    if (watch_->is_latched()) {
        request_stop();
    }
}

void MachineRun::end_action(std::size_t component, const char* name, ComponentAction action) noexcept {
    close_outputs(this);
    if (report_.late_component == nullptr) {
        report_.late_component = name;
        report_.late_action = get_name(action);
    }
    const std::int64_t number = static_cast<std::int64_t>(action);
    record(clock_->get_now(), MachineEvent::kActionOverrun, Severity::kFault,
           number * (std::int64_t{1} << 32) + static_cast<std::int64_t>(component));
}

Status MachineRun::open_recorder(const MachineOptions& options) noexcept {
    if (options.recorder == nullptr || recorder_.is_open()) {
        return Status::kOk;
    }
    Status status = file_.open(options.recorder, calc_recorder_file_size(options.recorder_capacity));
    report_.file_error = file_.get_error();
    if (status == Status::kOk) {
        status = recorder_.open(get_recorder_region(file_.get_region()));
    }
    if (status == Status::kOk && options.event_log != nullptr) {
        status = options.event_log->attach(recorder_);
    }
    if (status != Status::kOk) {
        recorder_.close();
        file_.close();
    }
    return status;
}

Status MachineRun::run(const MachineParts& parts, const MachineOptions& options,
                       std::uint64_t frames) noexcept {
    report_ = {};
    if (frames == 0U || !is_valid(options, parts)) {
        return fail(MachineStep::kOptions, Status::kBadParameter);
    }
    if (const Status opened = open_recorder(options); opened != Status::kOk) {
        return fail(MachineStep::kRecorder, opened);
    }
    report_.memory = lock_memory(kLockedStack);
    if (!has_clock_.load(std::memory_order_relaxed)) {
        parts.clock = FrameClock::starting_in(options.lead);
        clock_ = &parts.clock;
    }
    outputs_ = options.outputs;
    signal_.store(0);
    signal_ns_.store(0);
    closed_ns_.store(0);
    are_outputs_closed_.store(false);
    StopSignals signals;
    if (const Status installed = signals.install(*this); installed != Status::kOk) {
        return fail(MachineStep::kSignals, installed);
    }
    const Status status = run_protected(parts, options, frames);
    close_outputs(this);  // also after a failed start
    signals.remove();
    note_signal();
    is_stop_wanted_.store(false, std::memory_order_relaxed);
    for (CoreRunner& runner : parts.runners) {
        runner.resume();
    }
    record(clock_->get_now(), MachineEvent::kStopped,
           status == Status::kOk ? Severity::kInfo : Severity::kFault, static_cast<std::int64_t>(status));
    if (report_.signal != 0) {
        signals.forward(report_.signal);
    }
    return status;
}

Status MachineRun::run_protected(const MachineParts& parts, const MachineOptions& options,
                                 std::uint64_t frames) noexcept {
    CrashStack stack;
    // Without it, an exhausted stack of this thread ends the process unrecorded.
    static_cast<void>(stack.take());
    CrashHandlers handlers;
    const auto make_plan = [this] {
        return CrashPlan{&MachineRun::close_outputs, this, file_.get_region(), recorder_.get_session(),
                         *clock_};
    };
    if (const Status installed = handlers.install(make_plan()); installed != Status::kOk) {
        return fail(MachineStep::kCrashHandlers, installed);
    }
    // Threads whose work hung at the end of the last run and has returned since.
    static_cast<void>(close_hosts(parts.hosts));
    if (const Status opened = open_hosts(parts); opened != Status::kOk) {
        return fail(MachineStep::kWindowThreads, opened);
    }
    Status status = fail(MachineStep::kStart, start(parts, options.priority));
    if (status == Status::kOk && !has_clock_.load(std::memory_order_relaxed)) {
        // Major frame 0 begins after the start, however long it takes. Crash notes are on the same time line.
        parts.clock = FrameClock::starting_in(options.lead);
        runners_ = parts.runners;
        frame_ = parts.executives.get(0U).get_view().frame;
        has_clock_.store(true, std::memory_order_release);
        MAMORI_ENSURE(5, handlers.replace(make_plan()) == Status::kOk);
    }
    if (status == Status::kOk) {
        record(clock_->get_now(), MachineEvent::kStarted, Severity::kInfo,
               static_cast<std::int64_t>(parts.executives.size()));
        status = run_watched(parts, options, frames);
        close_outputs(this);
        record_end_of_frames();
        const Status stopped = fail(MachineStep::kStop, stop(parts, options.priority));
        status = status == Status::kOk ? stopped : status;
    } else {
        static_cast<void>(close_hosts(parts.hosts));
    }
    return status;
}

Status MachineRun::run_watched(const MachineParts& parts, const MachineOptions& options,
                               std::uint64_t frames) noexcept {
    const OutputGate gate{&MachineRun::close_outputs, this};
    GridWatch watch{{parts.beats.data(), parts.beats.size()},
                    *clock_,
                    get_raw_clock(),
                    options.watch,
                    gate,
                    {options.priority + MachineOptions::kPriorityStep, ThreadPlace::kAnyProcessor}};
    SoftwareWatchdog watchdog{
        *clock_, {Duration{0}, options.watchdog_timeout}, {gate.close, gate.argument, true}};
    const std::int64_t next = (clock_->get_now() + options.lead).ns / frame_.ns + 1;
    const Instant from{has_run_ ? next * frame_.ns : 0};
    has_run_ = true;
    for (std::size_t core = 0U; core < parts.threads.size(); ++core) {
        parts.beats[core].expect(from);
        parts.threads[core].runner = &parts.runners[core];
        parts.threads[core].beat = &parts.beats[core];
        parts.threads[core].from = from;
        parts.threads[core].frames = frames;
        parts.threads[core].watched = core == parts.first_core ? this : nullptr;
    }
    if (const Status opened = watch.open(); opened != Status::kOk) {
        return fail(MachineStep::kWatch, opened);
    }
    Status status =
        fail(MachineStep::kWatchdog,
             watchdog.open({options.priority + 2 * MachineOptions::kPriorityStep, ThreadPlace::kAnyProcessor},
                           options.device));
    if (status == Status::kOk) {
        watch_ = &watch;
        watchdog_ = &watchdog;
        served_look_count_ = 0U;
        status = run_threads(parts);
        close_outputs(this);
        static_cast<void>(watchdog.close());  // without effect after the runner of the first core
    }
    watch.close();
    report_.finding = watch.get_finding();
    report_.priority = combine(watch.get_right(), combine(watchdog.get_priority_right(), report_.priority));
    if (watch.is_latched()) {
        record(report_.finding.seen, MachineEvent::kWatchFinding, Severity::kFault,
               static_cast<std::int64_t>(report_.finding.fault));
        status = status == Status::kOk ? fail(MachineStep::kFrames, Status::kError) : status;
    }
    return status;
}

void* MachineRun::serve(void* argument) noexcept {
    const RunnerThread& thread = *static_cast<const RunnerThread*>(argument);
    CrashStack stack;
    static_cast<void>(stack.take());
    if (thread.watched != nullptr) {
        // From here on, so that the watchdog also detects a hang in the first frame.
        static_cast<void>(thread.watched->watchdog_->service(thread.watched->clock_->get_now()));
    }
    thread.runner->run(thread.frames, thread.from);
    thread.beat->rest();
    if (thread.watched != nullptr) {
        // Here, because the calling thread of run() may not get the processor before the timeout.
        close_outputs(thread.watched);
        static_cast<void>(thread.watched->watchdog_->close());
    }
    return nullptr;
}

Status MachineRun::run_threads(const MachineParts& parts) noexcept {
    std::size_t started = 0U;
    Status status = Status::kOk;
    report_.priority = {true, 0};
    report_.processor = {true, 0};
    while (started < parts.threads.size() && status == Status::kOk &&
           !is_stop_wanted_.load(std::memory_order_relaxed)) {
        RunnerThread& thread = parts.threads[started];
        status = start_thread(thread.thread, &MachineRun::serve, &thread, thread.place, thread.rights);
        if (status == Status::kOk) {
            ++started;
        }
    }
    if (status != Status::kOk) {
        request_stop();
    }
    const SignalBlock block;
    for (std::size_t core = 0U; core < started; ++core) {
        MAMORI_ENSURE(1, pthread_join(parts.threads[core].thread, nullptr) == 0);
        report_.priority = combine(report_.priority, combine(parts.threads[core].rights.priority,
                                                             parts.hosts[core].get_priority_right()));
        report_.processor = combine(report_.processor, combine(parts.threads[core].rights.processor,
                                                               parts.hosts[core].get_processor_right()));
    }
    for (GridBeat& beat : parts.beats) {
        beat.rest();
    }
    collect(parts);
    return fail(MachineStep::kRunnerThreads, status);
}

void MachineRun::collect(const MachineParts& parts) noexcept {
    const SystemView& view = parts.executives.get(0U).get_view();
    for (std::size_t core = 0U; core < parts.runners.size(); ++core) {
        const OpeningCounts& counts = parts.runners[core].get_counts();
        const bool is_ordinary = mamori::detail::find_background_of(view, core) == kNoIndex;
        OpeningCounts& sum = is_ordinary ? report_.openings : report_.background;
        sum.opened += counts.opened;
        sum.overran += counts.overran;
        sum.missed += counts.missed;
        sum.worst_lateness =
            counts.worst_lateness > sum.worst_lateness ? counts.worst_lateness : sum.worst_lateness;
    }
    report_.longest_sample = parts.devices.get_longest_sample();
    report_.longest_apply = parts.devices.get_longest_apply();
}

Status MachineRun::start(const MachineParts& parts, int priority) noexcept {
    const RunnerPriority raised{priority};
    // Ends what work that hung at the end of the last run has held up. Without such work, nothing is called.
    static_cast<void>(parts.executives.stop(parts.guards));
    return parts.executives.start(parts.guards);
}

Status MachineRun::stop(const MachineParts& parts, int priority) noexcept {
    const RunnerPriority raised{priority};
    wait_for_return(parts);
    const Status stopped = parts.executives.stop(parts.guards);
    const Status closed = close_hosts(parts.hosts);
    return stopped == Status::kOk ? closed : stopped;
}

}  // namespace mamori::ports::posix_rt
