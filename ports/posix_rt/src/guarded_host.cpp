// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/guarded_host.hpp"

#include <time.h>

#include <cerrno>
#include <limits>

#include "failure_order.hpp"
#include "mamori/kernel/base/assert.hpp"
#include "mamori/ports/posix_rt/crash_place.hpp"

namespace mamori::ports::posix_rt {
namespace {

void wait_for(sem_t& semaphore) noexcept {
    while (sem_wait(&semaphore) != 0) {
        MAMORI_INVARIANT(1, errno == EINTR);
    }
}

/// @return false when `until` has passed first.
bool wait_for(sem_t& semaphore, const timespec& until) noexcept {
    while (sem_clockwait(&semaphore, CLOCK_MONOTONIC, &until) != 0) {
        if (errno == ETIMEDOUT) {
            return false;
        }
        MAMORI_INVARIANT(2, errno == EINTR);
    }
    return true;
}

std::int64_t read_ns(clockid_t clock) noexcept {
    timespec now{};
    MAMORI_ENSURE(6, clock_gettime(clock, &now) == 0);
    return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

/// Processor time of a thread.
std::int64_t read_used_ns(pthread_t thread) noexcept {
    clockid_t clock{};
    MAMORI_ENSURE(7, pthread_getcpuclockid(thread, &clock) == 0);
    return read_ns(clock);
}

/// Shortest wait between two looks at the processor time of a window.
constexpr std::int64_t kLookMin = 20'000;

/// Whether a guard of priority `runner` runs while a window of priority `window` does. Two ordinary threads
/// share their processor.
constexpr bool is_guarded(int window, int runner) noexcept {
    return window == 0 || window < runner;
}

}  // namespace

Status WindowThread::set_stack_size(std::size_t size) noexcept {
    if (is_open_) {
        return Status::kPreconditionNotMet;
    }
    stack_size_ = size;
    return Status::kOk;
}

Status WindowThread::set_execution_budget(Duration budget) noexcept {
    if (budget < Duration{0}) {
        return Status::kBadParameter;
    }
    if (is_open_) {
        return Status::kPreconditionNotMet;
    }
    execution_budget_ = budget;
    return Status::kOk;
}

void* WindowThread::serve(void* argument) noexcept {
    WindowThread& self = *static_cast<WindowThread*>(argument);
    // Without it a component that uses up its stack ends the process without a note; the rest is the same.
    static_cast<void>(self.crash_stack_.take());
    wait_for(self.wanted_);
    while (!self.is_ending_.load(std::memory_order_acquire)) {
        self.work_off();
        wait_for(self.wanted_);
    }
    self.crash_stack_.give_back();
    return nullptr;
}

/// Whoever reads done_ sees all that the work did; what comes after it touches nothing but the semaphore.
void WindowThread::work_off() noexcept {
    const std::uint32_t number = asked_;
    for (std::size_t i = 0U; i < work_.count; ++i) {
        set_crash_place(work_.window, work_.component + i);
        work_.run(work_.argument, work_.first + i, work_.first + i + 1U);
        if (clock_->get_now() > deadline_ ||
            (execution_budget_ > Duration{0} && is_exhausted(read_ns(CLOCK_THREAD_CPUTIME_ID)))) {
            break;
        }
        finished_count_.store(i + 1U, std::memory_order_release);
    }
    clear_crash_place();
    done_.store(number, std::memory_order_release);
    static_cast<void>(sem_post(&returned_));
}

Status GuardedHost::start(WindowThread& thread) noexcept {
    MAMORI_ENSURE(3, sem_init(&thread.wanted_, 0, 0U) == 0 && sem_init(&thread.returned_, 0, 0U) == 0);
    thread.clock_ = &clock_;
    thread.is_ending_.store(false, std::memory_order_relaxed);
    ThreadPlace place = place_;
    if (thread.stack_size_ != 0U) {
        place.stack_size = thread.stack_size_;
    }
    ThreadRights rights;
    if (start_thread(thread.thread_, &WindowThread::serve, &thread, place, rights) != Status::kOk) {
        static_cast<void>(sem_destroy(&thread.wanted_));
        static_cast<void>(sem_destroy(&thread.returned_));
        return Status::kOutOfResources;
    }
    thread.is_open_ = true;
    thread.is_demoted_ = false;
    thread.deadline_ = Instant{std::numeric_limits<std::int64_t>::min()};
    thread.priority_ = rights.priority.is_granted ? place_.priority : 0;
    window_priority_ = thread.priority_ > window_priority_ ? thread.priority_ : window_priority_;
    priority_right_ = combine(priority_right_, rights.priority);
    processor_right_ = combine(processor_right_, rights.processor);
    return Status::kOk;
}

Status GuardedHost::start_all() noexcept {
    for (std::size_t window = 0U; window < threads_.size(); ++window) {
        const Status result = is_own(window) ? start(threads_[window]) : Status::kOk;
        if (result != Status::kOk) {
            return result;
        }
    }
    return Status::kOk;
}

Status GuardedHost::open() noexcept {
    return open(get_own_priority());
}

Status GuardedHost::open(int runner_priority) noexcept {
    for (std::size_t window = 0U; window < threads_.size(); ++window) {
        if (is_own(window) && threads_[window].is_open_) {
            return Status::kPreconditionNotMet;
        }
    }
    // A runner without a priority may have been denied it, and then the windows are, too: see below.
    if (runner_priority != 0 && !is_guarded(place_.priority, runner_priority)) {
        return Status::kBadParameter;
    }
    detail::install_failure_gate();
    priority_right_ = {true, 0};
    processor_right_ = {true, 0};
    window_priority_ = 0;
    may_idle_ = place_.priority == 0 && may_leave_idle();
    Status result = start_all();
    if (result == Status::kOk && !is_guarded(window_priority_, runner_priority)) {
        result = Status::kBadParameter;
    }
    if (result != Status::kOk) {
        static_cast<void>(close());
    }
    return result;
}

Status GuardedHost::close() noexcept {
    Status result = Status::kOk;
    for (std::size_t window = 0U; window < threads_.size(); ++window) {
        WindowThread& thread = threads_[window];
        if (!is_own(window) || !thread.is_open_) {
            continue;
        }
        if (thread.is_out()) {
            result = Status::kPreconditionNotMet;
            continue;
        }
        thread.is_ending_.store(true, std::memory_order_release);
        static_cast<void>(sem_post(&thread.wanted_));
        MAMORI_ENSURE(4, pthread_join(thread.thread_, nullptr) == 0);
        static_cast<void>(sem_destroy(&thread.wanted_));
        static_cast<void>(sem_destroy(&thread.returned_));
        thread.is_open_ = false;
    }
    return result;
}

std::size_t GuardedHost::run_within(const Work& work, Instant deadline) noexcept {
    WindowThread& thread = threads_[work.window];
    MAMORI_REQUIRE(5, thread.is_open_ && !thread.is_out());
    if (window_priority_ != 0) {
        stay_below(get_own_priority());
    }
    promote(thread);
    thread.work_ = work;
    if (thread.execution_budget_ > Duration{0} && deadline != thread.deadline_) {
        // The first work of an instance. The thread waits, so its processor time is constant.
        thread.used_max_ns_ = read_used_ns(thread.thread_) + thread.execution_budget_.ns;
    }
    thread.deadline_ = deadline;
    thread.finished_count_.store(0U, std::memory_order_relaxed);
    ++thread.asked_;
    static_cast<void>(sem_post(&thread.wanted_));
    Instant look = calc_next_look(thread);
    while (thread.is_out()) {
        if (!wait_for(thread.returned_, clock_.to_timespec(look)) && thread.is_out()) {
            if (look < deadline && !thread.is_exhausted(read_used_ns(thread.thread_))) {
                look = calc_next_look(thread);
                continue;
            }
            demote(thread);
            // Every step may have come through while the thread is still on its way back: not in time.
            const std::size_t finished = thread.finished_count_.load(std::memory_order_acquire);
            return finished < work.count ? finished : work.count - 1U;
        }
    }
    return thread.finished_count_.load(std::memory_order_acquire);
}

/// The deadline; for a window with a limited processor time, not later than this can be exhausted.
Instant GuardedHost::calc_next_look(const WindowThread& thread) const noexcept {
    if (thread.execution_budget_ == Duration{0}) {
        return thread.deadline_;
    }
    const std::int64_t left = thread.used_max_ns_ - read_used_ns(thread.thread_);
    const Instant look = clock_.get_now() + Duration{left > kLookMin ? left : kLookMin};
    return look < thread.deadline_ ? look : thread.deadline_;
}

/// The calling thread runs the windows. What it cannot interrupt it cannot guard.
void GuardedHost::stay_below(int runner_priority) noexcept {
    if (is_guarded(window_priority_, runner_priority)) {
        return;
    }
    for (std::size_t window = 0U; window < threads_.size(); ++window) {
        if (is_own(window)) {
            static_cast<void>(set_priority(threads_[window].thread_, 0));
            threads_[window].priority_ = 0;
        }
    }
    window_priority_ = 0;
    priority_right_ = {false, EPERM};
}

void GuardedHost::demote(WindowThread& thread) noexcept {
    if (thread.priority_ != 0) {
        thread.is_demoted_ = set_priority(thread.thread_, 0).is_granted;
    } else if (may_idle_) {
        thread.is_demoted_ = set_idle(thread.thread_).is_granted;
    }
}

void GuardedHost::promote(WindowThread& thread) noexcept {
    if (thread.is_demoted_) {
        const Right right = set_priority(thread.thread_, thread.priority_);
        thread.is_demoted_ = !right.is_granted;
        priority_right_ = combine(priority_right_, right);
    }
}

}  // namespace mamori::ports::posix_rt
