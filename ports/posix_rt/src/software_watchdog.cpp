// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/software_watchdog.hpp"

#include <signal.h>

#include <cerrno>
#include <cstdlib>

#include "failure_order.hpp"
#include "mamori/ports/posix_rt/crash_handlers.hpp"
#include "mamori/ports/posix_rt/crash_place.hpp"
#include "mamori/safety/base/elapsed.hpp"

namespace mamori::ports::posix_rt {
namespace {

/// Services per timeout of the device: a delay of the thread for most of the timeout causes no reset.
constexpr std::int64_t kDeviceServices = 4;

/// Otherwise, handlers of the application could run on this thread and take its time.
void block_other_signals() noexcept {
    sigset_t signals;
    MAMORI_ENSURE(8, ::sigfillset(&signals) == 0);
    for (const int signal : kCrashSignals) {
        MAMORI_ENSURE(9, ::sigdelset(&signals, signal) == 0);
    }
    MAMORI_ENSURE(10, ::pthread_sigmask(SIG_SETMASK, &signals, nullptr) == 0);
}

}  // namespace

void* SoftwareWatchdog::serve(void* argument) noexcept {
    static_cast<SoftwareWatchdog*>(argument)->watch();
    return nullptr;
}

Status SoftwareWatchdog::open(ThreadPlace place, WatchdogDevice* device) noexcept {
    if (is_open_ || (device != nullptr && !device->is_open())) {
        return Status::kPreconditionNotMet;
    }
    const int own_priority = get_own_priority();
    if (own_priority != 0 && place.priority <= own_priority) {
        return Status::kBadParameter;
    }
    detail::install_failure_gate();
    MAMORI_ENSURE(4, sem_init(&changed_, 0, 0U) == 0);
    device_ = device;
    device_due_ = clock_.get_now();
    is_ending_.store(false, std::memory_order_relaxed);
    std::int64_t closed = kClosed;
    static_cast<void>(state_.compare_exchange_strong(closed, kSilent, std::memory_order_release));
    ThreadRights rights;
    if (start_thread(thread_, &SoftwareWatchdog::serve, this, place, rights) != Status::kOk) {
        static_cast<void>(sem_destroy(&changed_));
        return Status::kOutOfResources;
    }
    is_open_ = true;
    priority_right_ = combine(rights.priority, rights.processor);
    return Status::kOk;
}

Status SoftwareWatchdog::close() noexcept {
    if (!is_open_) {
        return Status::kPreconditionNotMet;
    }
    is_ending_.store(true, std::memory_order_release);
    static_cast<void>(sem_post(&changed_));
    MAMORI_ENSURE(5, pthread_join(thread_, nullptr) == 0);
    static_cast<void>(sem_destroy(&changed_));
    is_open_ = false;
    const std::int64_t state = state_.load(std::memory_order_acquire);
    if (!has_expired_in(state)) {
        state_.store(kClosed, std::memory_order_release);
    }
    return Status::kOk;
}

/// Evaluates the state at instant `now`.
WatchdogCause SoftwareWatchdog::evaluate(std::int64_t state, Instant now) const noexcept {
    if (has_expired_in(state)) {
        return static_cast<WatchdogCause>(state - kExpired);
    }
    const bool is_running = state != kClosed && state != kSilent;
    return is_running && safety::is_over(Instant{state}, now, window_.longest) ? WatchdogCause::kLate
                                                                               : WatchdogCause::kNone;
}

Status SoftwareWatchdog::service(Instant) noexcept {
    const Instant now = clock_.get_now();
    std::int64_t state = state_.load(std::memory_order_acquire);
    WatchdogCause cause = evaluate(state, now);
    if (state == kClosed || has_expired_in(state)) {
        return Status::kError;
    }
    if (cause == WatchdogCause::kNone && state != kSilent &&
        safety::calc_elapsed(Instant{state}, now) < window_.shortest) {
        cause = WatchdogCause::kEarly;
    }
    const bool is_first = state == kSilent;
    const bool is_taken = cause == WatchdogCause::kNone;
    const std::int64_t next = is_taken ? now.ns : kExpired + static_cast<std::int64_t>(cause);
    // Meanwhile, the thread has found that the time has elapsed.
    if (!state_.compare_exchange_strong(state, next, std::memory_order_acq_rel)) {
        return Status::kError;
    }
    // The thread executes the reaction, since this context can be the runaway loop and has no guaranteed
    // priority.
    if (is_first || !is_taken) {
        static_cast<void>(sem_post(&changed_));
    }
    return is_taken ? Status::kOk : Status::kError;
}

bool SoftwareWatchdog::has_expired() const noexcept {
    return get_cause() != WatchdogCause::kNone;
}

WatchdogCause SoftwareWatchdog::get_cause() const noexcept {
    // Reads the state first: otherwise, a service after the reading of the clock would seem to be in the
    // future.
    const std::int64_t state = state_.load(std::memory_order_acquire);
    return evaluate(state, clock_.get_now());
}

bool SoftwareWatchdog::is_watching() const noexcept {
    const std::int64_t state = state_.load(std::memory_order_acquire);
    return state != kClosed && state != kSilent && evaluate(state, clock_.get_now()) == WatchdogCause::kNone;
}

void SoftwareWatchdog::watch() noexcept {
    // If this fails, a stack overflow of this thread ends the process without a record. Other crashes are
    // recorded.
    static_cast<void>(crash_stack_.take());
    set_crash_place_of_watchdog();
    block_other_signals();
    watch_until_expired();
    if (has_expired_in(state_.load(std::memory_order_acquire))) {
        reaction_.close_outputs(reaction_.context);
        if (reaction_.ends_process) {
            std::abort();
        }
    }
    crash_stack_.give_back();
}

/// Also ends on close(), but only after a last check, so that each expiry that has_expired() has reported
/// causes the reaction.
void SoftwareWatchdog::watch_until_expired() noexcept {
    std::int64_t state = state_.load(std::memory_order_acquire);
    while (!has_expired_in(state)) {
        // This order ensures that the last reading of the clock is after the call of close().
        const bool is_ending = is_ending_.load(std::memory_order_acquire);
        const Instant now = clock_.get_now();
        WatchdogCause cause = evaluate(state, now);
        if (cause == WatchdogCause::kNone && is_ending) {
            return;
        }
        if (cause == WatchdogCause::kNone && is_device_lost(now)) {
            cause = WatchdogCause::kDevice;
        }
        if (cause == WatchdogCause::kNone) {
            wait_for_change(state);
        } else {
            // If a service was faster, the next iteration checks again.
            static_cast<void>(state_.compare_exchange_strong(
                state, kExpired + static_cast<std::int64_t>(cause), std::memory_order_acq_rel));
        }
        state = state_.load(std::memory_order_acquire);
    }
}

/// Services the device when due. @return true: the device rejected the service.
bool SoftwareWatchdog::is_device_lost(Instant now) noexcept {
    if (device_ == nullptr || now < device_due_) {
        return false;
    }
    const bool is_taken = device_->service(now) == Status::kOk;
    if (is_taken) {
        device_due_ = now + Duration{device_->get_timeout().ns / kDeviceServices};
    }
    return !is_taken;
}

/// Waits until the semaphore is posted, the time of the last service has elapsed, or the device is due.
void SoftwareWatchdog::wait_for_change(std::int64_t state) noexcept {
    const bool is_running = state != kSilent;
    const Instant over =
        is_running ? add_saturating(add_saturating(Instant{state}, window_.longest), 1_ns) : device_due_;
    const Instant until = device_ != nullptr && device_due_ < over ? device_due_ : over;
    if (!is_running && device_ == nullptr) {
        while (sem_wait(&changed_) != 0) {
            MAMORI_INVARIANT(6, errno == EINTR);
        }
        return;
    }
    const timespec instant = clock_.to_timespec(until);
    while (sem_clockwait(&changed_, CLOCK_MONOTONIC, &instant) != 0) {
        if (errno == ETIMEDOUT) {
            return;
        }
        MAMORI_INVARIANT(7, errno == EINTR);
    }
}

}  // namespace mamori::ports::posix_rt
