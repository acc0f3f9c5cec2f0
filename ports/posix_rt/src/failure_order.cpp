// SPDX-License-Identifier: Apache-2.0
#include "failure_order.hpp"

#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/ports/posix_rt/time_source.hpp"

namespace mamori::ports::posix_rt::detail {
namespace {

/// Thread ids; 0: none. Lock-free, since handlers of two threads can run concurrently.
std::atomic<pid_t> checking_thread{0};  ///< thread with a failed check in its handler
std::atomic<pid_t> dying_thread{0};     ///< thread with a crash in its handler
static_assert(std::atomic<pid_t>::is_always_lock_free);

constexpr Duration kPoll{1'000'000};

pid_t get_self() noexcept {
    return static_cast<pid_t>(::syscall(SYS_gettid));
}

/// Sleeps, so that a waiting thread of high priority does not prevent the other thread from running.
void wait_for(const std::atomic<pid_t>& other, pid_t self) noexcept {
    const TimeSource& clock = get_monotonic_clock();
    const std::int64_t last = clock.read_ns() + kFailurePatience.ns;
    for (std::int64_t now = clock.read_ns(); now < last; now = clock.read_ns()) {
        const pid_t thread = other.load();
        if (thread == 0 || thread == self) {
            return;
        }
        clock.wait_until(now + kPoll.ns);
    }
}

void wait_for_first_failure(const AssertionRecord&) noexcept {
    const pid_t self = get_self();
    wait_for(dying_thread, self);
    pid_t first = 0;
    if (!checking_thread.compare_exchange_strong(first, self)) {
        wait_for(checking_thread, self);
        // The wait has timed out: the crash after this wait need not wait again.
        static_cast<void>(checking_thread.compare_exchange_strong(first, 0));
    }
}

}  // namespace

void install_failure_gate() noexcept {
    set_assertion_gate(&wait_for_first_failure);
}

bool begin_crash() noexcept {
    const pid_t self = get_self();
    // The handler of the failed check of this thread has returned or has crashed.
    pid_t checking = self;
    static_cast<void>(checking_thread.compare_exchange_strong(checking, 0));
    pid_t first = 0;
    if (dying_thread.compare_exchange_strong(first, self)) {
        return true;
    }
    wait_for(dying_thread, self);
    return false;
}

void wait_for_failed_check() noexcept {
    wait_for(checking_thread, get_self());
}

}  // namespace mamori::ports::posix_rt::detail
