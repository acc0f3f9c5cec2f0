// SPDX-License-Identifier: Apache-2.0
#include "director.hpp"

#include "victims.hpp"

namespace mamori::time_faults {
namespace {

constexpr std::size_t kReportRoom = 1'000'000U;
/// Time until the runner has caught up and all work has returned.
constexpr Duration kAftermath{10'000'000};

std::uint64_t calc_frame(const FrameSchedule::Opening& opening) noexcept {
    return static_cast<std::uint64_t>(opening.release.ns / kTick.ns);
}

bool is_done_before_opening(Kind kind) noexcept {
    return kind != Kind::kStuckTick && kind != Kind::kStuckRunner;
}

}  // namespace

Director::Director(const Stage& stage, std::vector<Injection> injections)
    : stage_(stage), injections_(std::move(injections)) {
    course_.reports.reserve(kReportRoom);
    course_.delays.reserve(injections_.size());
    course_.holds.reserve(injections_.size());
    course_.clock_faults.reserve(injections_.size());
    course_.found.reserve(kReportRoom);
    course_.runner_delays.reserve(kReportRoom);
    static_cast<void>(meter_.take());  // opens its file before the first window
}

void Director::before_opening(const FrameSchedule::Opening& opening, Instant woke) noexcept {
    release_ = opening.release;
    woke_ = woke;
    runner_delay_ = meter_.take();
    if (is_runner_delayed(runner_delay_, woke - opening.release) &&
        course_.runner_delays.size() < course_.runner_delays.capacity()) {
        course_.runner_delays.push_back({opening.release - runner_delay_, woke});
    }
    course_.reads_under_way += stage_.is_reading.load(std::memory_order_relaxed) ? 1U : 0U;
    if (is_sleep_held_) {
        record_held_sleep(opening);
    }
    if (get_surroundings().defect == Defect::kLateRelease && opening.window == 1U &&
        calc_frame(opening) % kDefectEvery == 0U) {
        hold_back(opening.release + kTick + kTick);
    }
    end_clock_fault();
    look_after_watch();
    const Injection* const due = find_due(opening);
    if (due != nullptr && is_done_before_opening(due->kind)) {
        begin(*due, opening);
    }
}

void Director::after_opening(const FrameSchedule::Opening& opening, WindowOutcome) noexcept {
    const Instant close = opening.release + get_executive().get_view().windows[opening.window].length;
    if (is_guard_held_) {
        is_guard_held_ = false;
        course_.holds.push_back({close, stage_.clock.get_now()});
    }
    const Injection* const due = find_due(opening);
    if (due != nullptr && !is_done_before_opening(due->kind)) {
        begin_after(*due, opening);
    }
}

/// The next injection, once its major frame has started and no latched finding masks it.
const Injection* Director::find_due(const FrameSchedule::Opening& opening) noexcept {
    const std::uint64_t frame = calc_frame(opening);
    if (next_ == injections_.size() || frame < injections_[next_].frame || opening.release < quiet_until_ ||
        is_sleep_held_ || is_clock_wrong_ || (watch_ != nullptr && watch_->is_latched())) {
        return nullptr;
    }
    for (std::size_t window = 0U; window < kWindowCount; ++window) {
        if (!stage_.host.has_returned(window)) {
            return nullptr;
        }
    }
    return &injections_[next_];
}

void Director::begin(const Injection& injection, const FrameSchedule::Opening& opening) noexcept {
    switch (injection.kind) {
        case Kind::kLoop:
        case Kind::kSleep: {
            const Way way = injection.kind == Kind::kSleep ? Way::kSleep : Way::kCompute;
            get_victim(injection.place).arm(way, Cause::kWork, injection.size);
            break;
        }
        case Kind::kLockedOut:
            stage_.inversion.prepare();
            if (!stage_.inversion.is_prepared()) {
                return;  // the thread without priority has not run yet
            }
            get_victim(injection.place).arm(Way::kLock, Cause::kLock, injection.size);
            stage_.inversion.attempt(stage_.clock.get_now() + injection.size);
            break;
        case Kind::kStuckGuard:
            if (opening.window != kWindowOf[injection.place]) {
                return;
            }
            get_victim(injection.place).arm(Way::kCompute, Cause::kStuckGuard, injection.size);
            stage_.time.hold_deadline(injection.size + injection.size);
            is_guard_held_ = true;
            break;
        case Kind::kLateRelease:
            if (opening.window != injection.place) {
                return;
            }
            hold_back(opening.release + injection.size);
            course_.delays.push_back({opening.window, opening.release, stage_.clock.get_now()});
            course_.holds.push_back({opening.release, stage_.clock.get_now()});
            break;
        case Kind::kFastClock:
        case Kind::kSlowClock: {
            const Instant now = stage_.clock.get_now();
            course_.clock_faults.push_back({now, now + injection.size, injection.ppm});
            stage_.time.set_rate(injection.ppm);
            is_clock_wrong_ = true;
            break;
        }
        case Kind::kStuckTick:
        case Kind::kStuckRunner:
            return;
    }
    finish(kAftermath);
}

/// The window of the fault is the next to start.
void Director::begin_after(const Injection& injection, const FrameSchedule::Opening& opening) noexcept {
    const FrameSchedule schedule{get_executive().get_view(), 0U, opening.release + Duration{1}};
    const FrameSchedule::Opening& next = schedule.get_next();
    if (next.window != injection.place) {
        return;
    }
    if (injection.kind == Kind::kStuckTick) {
        stage_.time.hold_sleep(injection.size);
        is_sleep_held_ = true;
        return;
    }
    const Instant close = opening.release + get_executive().get_view().windows[opening.window].length;
    hold_back(next.release + injection.size);
    const Instant now = stage_.clock.get_now();
    course_.delays.push_back({next.window, next.release, now});
    course_.holds.push_back({close, now});
    finish(kAftermath);
}

void Director::record_held_sleep(const FrameSchedule::Opening& opening) noexcept {
    is_sleep_held_ = false;
    if (stage_.time.is_sleep_to_be_held()) {
        stage_.time.hold_sleep(Duration{0});  // the thread was late and did not sleep: try again
        return;
    }
    course_.delays.push_back({opening.window, opening.release, woke_});
    course_.holds.push_back({opening.release, woke_});
    finish(kAftermath);
}

void Director::end_clock_fault() noexcept {
    if (is_clock_wrong_ && woke_ >= course_.clock_faults.back().end) {
        stage_.time.set_rate(0);
        course_.clock_faults.back().end = stage_.clock.get_now();
        is_clock_wrong_ = false;
        quiet_until_ = woke_ + kAftermath;
    }
}

/// Records a finding and clears it as soon as the monitor permits.
void Director::look_after_watch() noexcept {
    if (watch_ == nullptr || !watch_->is_latched()) {
        return;
    }
    std::vector<Found>& found = course_.found;
    const ports::posix_rt::GridFinding finding = watch_->get_finding();
    if (found.empty() || found.back().cleared != ports::posix_rt::GridBeat::kNever) {
        found.push_back({finding, ports::posix_rt::GridBeat::kNever});
    }
    if (watch_->reset() == Status::kOk) {
        found.back().cleared = stage_.clock.get_now();
    }
}

void Director::finish(Duration aftermath) noexcept {
    quiet_until_ = stage_.clock.get_now() + aftermath;
    ++next_;
}

void Director::hold_back(Instant end) const noexcept {
    while (stage_.clock.get_now() < end) {
    }
}

void Director::on_budget_overrun(std::size_t window, std::size_t component, Instant now) noexcept {
    if (get_surroundings().defect == Defect::kWrongName) {
        component = (component + 1U) % kComponentCount;
    }
    add({true, window, component, release_, woke_, now, runner_delay_, {}});
}

void Director::on_late_release(std::size_t window, Duration lateness, Instant now) noexcept {
    if (lateness > kTick) {
        add({false, window, kNoIndex, release_, woke_, now, runner_delay_, {}});
    }
}

void Director::add(const Report& report) noexcept {
    if (course_.reports.size() < kReportRoom) {
        course_.reports.push_back(report);
    }
}

}  // namespace mamori::time_faults
