// SPDX-License-Identifier: Apache-2.0
#include "mamori/timing/measuring_host.hpp"

#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

namespace mamori::timing {
namespace {

/// Lateness from which the switches of a window are kept: far above that of an idle host.
constexpr Duration kLate{500'000};
/// How long the switches are kept after a late window or an overrun.
constexpr Duration kAfter{50'000'000};
/// The same, at most, while work is outstanding.
constexpr Duration kAfterMax{1'000'000'000};

/// Records that are read after a window: these, and one more per time unit of the distance of the planned
/// window starts. So the reading takes about 3 % of the time, also when switches have accumulated.
constexpr std::int64_t kRecordsMin = 256;
constexpr Duration kTimePerRecord{1'000};

/// CPU time and switches of the calling thread since its start.
struct ThreadUse {
    std::int64_t cpu_ns{0};
    std::uint32_t voluntary{0U};
    std::uint32_t involuntary{0U};
};

std::int64_t get_cpu_ns() noexcept {
    timespec time{};
    static_cast<void>(clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time));
    return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

ThreadUse get_own_use() noexcept {
    ThreadUse use;
    use.cpu_ns = get_cpu_ns();
    rusage counts{};
    if (getrusage(RUSAGE_THREAD, &counts) == 0) {
        use.voluntary = static_cast<std::uint32_t>(counts.ru_nvcsw);
        use.involuntary = static_cast<std::uint32_t>(counts.ru_nivcsw);
    }
    return use;
}

}  // namespace

void MeasuringHost::measure(void* argument, std::size_t begin, std::size_t end) noexcept {
    const Piece& piece = *static_cast<const Piece*>(argument);
    piece.thread->store(static_cast<std::uint32_t>(gettid()), std::memory_order_relaxed);
    ThreadUse before = get_own_use();
    for (std::size_t step = begin; step < end; ++step) {
        StepRow& row = piece.rows[step - piece.work.first];
        row.start_ns.store(piece.clock->get_now().ns, std::memory_order_relaxed);
        piece.work.run(piece.work.argument, step, step + 1U);
        const std::int64_t end_ns = piece.clock->get_now().ns;
        const ThreadUse after = get_own_use();
        row.cpu_ns = after.cpu_ns - before.cpu_ns;
        row.voluntary = after.voluntary - before.voluntary;
        row.involuntary = after.involuntary - before.involuntary;
        before = after;
        // A reader that sees an end also sees the other fields, even in a row that is incomplete when the run
        // is written.
        row.end_ns.store(end_ns, std::memory_order_release);
    }
}

std::size_t MeasuringHost::run_within(const Work& work, Instant deadline) noexcept {
    StepRow* const rows = log_.take_steps(current_.release, work.component, work.count, work.pass);
    if (rows == nullptr) {
        return inner_.run_within(work, deadline);
    }
    Piece& piece = pieces_[work.window];
    piece = {&inner_, work, rows, &threads_[work.window]};
    Work measured = work;
    measured.run = &MeasuringHost::measure;
    measured.argument = &piece;
    return inner_.run_within(measured, deadline);
}

void MeasuringHost::before_opening(const FrameSchedule::Opening& opening, Instant woke) noexcept {
    if (next_ != nullptr) {
        next_->before_opening(opening, woke);
    }
    current_ = {};
    current_.release = opening.release;
    // The executive reads the clock after the devices; the budget begins then.
    current_.woke = next_ == nullptr ? woke : inner_.get_now();
    current_.window = opening.window;
}

void MeasuringHost::after_opening(const FrameSchedule::Opening& opening, WindowOutcome outcome) noexcept {
    current_.closed = inner_.get_now();
    current_.outcome = outcome;
    if (switches_ != nullptr) {
        note_switches(opening);
    }
    if (get_state_ != nullptr && !has_work_out()) {
        current_.state = static_cast<std::uint32_t>((*get_state_)());
    }
    log_.add_opening(current_);
    if (next_ != nullptr) {
        next_->after_opening(opening, outcome);
    }
}

void MeasuringHost::note_switches(const FrameSchedule::Opening& opening) noexcept {
    const std::int64_t begin_ns = get_cpu_ns();
    const Duration distance = last_release_ == kNever ? Duration{0} : current_.release - last_release_;
    switches_->read(static_cast<std::size_t>(kRecordsMin + distance.ns / kTimePerRecord.ns));
    current_.use = switches_->calc_use(current_.release, current_.closed, get_thread(opening.window));
    const bool is_event = current_.outcome == WindowOutcome::kOverrun ||
                          current_.outcome == WindowOutcome::kMissed ||
                          current_.woke - current_.release > kLate;
    event_ = is_event ? current_.closed : event_;
    switches_->settle(is_near_event(current_.closed));
    current_.runner_cpu_ns = cpu_ns_ == kNoInstant.ns ? kNoInstant.ns : begin_ns - cpu_ns_;
    cpu_ns_ = get_cpu_ns();
    current_.reading_cpu_ns = cpu_ns_ - begin_ns;
    current_.reading = inner_.get_now() - current_.closed;
    last_release_ = current_.release;
}

bool MeasuringHost::is_near_event(Instant now) const noexcept {
    const Duration since = now - event_;
    return since < kAfter || (since < kAfterMax && has_work_out());
}

void MeasuringHost::finish() noexcept {
    if (switches_ != nullptr) {
        switches_->read();
        switches_->settle(is_near_event(inner_.get_now()));
    }
}

bool MeasuringHost::has_work_out() const noexcept {
    for (std::size_t window = 0U; window < threads_.size(); ++window) {
        if (get_thread(window) != 0U && !inner_.has_returned(window)) {
            return true;
        }
    }
    return false;
}

}  // namespace mamori::timing
