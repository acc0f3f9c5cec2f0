// SPDX-License-Identifier: Apache-2.0
/// @file
/// System calls that end early: by a signal, or because a file may not become longer.
#ifndef MAMORI_PORTS_LCM_INTERRUPTED_CALL_HPP
#define MAMORI_PORTS_LCM_INTERRUPTED_CALL_HPP

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>

#include <atomic>
#include <csignal>
#include <functional>

namespace lcm_sample {

/// Waits until `condition` holds, 10 s at most. @return whether it holds.
inline bool wait_until(const std::function<bool()>& condition) {
    bool holds = condition();
    for (int i = 0; i < 10'000 && !holds; ++i) {
        ::poll(nullptr, 0U, 1);
        holds = condition();
    }
    return holds;
}

/// Counts `signal`, which interrupts a system call, while it exists.
class SignalScope final {
  public:
    static inline std::atomic<int> count{0};

    explicit SignalScope(
        int signal, void (*handler)(int) = [](int /*signal*/) { ++count; })
        : signal_(signal) {
        count = 0;
        struct sigaction action{};
        action.sa_handler = handler;
        EXPECT_EQ(::sigaction(signal_, &action, &before_), 0);
    }
    SignalScope(const SignalScope&) = delete;
    SignalScope& operator=(const SignalScope&) = delete;
    ~SignalScope() { EXPECT_EQ(::sigaction(signal_, &before_, nullptr), 0); }

  private:
    int signal_;
    struct sigaction before_{};
};

/// Files of this process may have one octet. The first refused octet is counted, and ends the limit.
class OneOctetScope final {
  public:
    OneOctetScope() : refused_(SIGXFSZ, &allow_more) {
        EXPECT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
        const rlimit now{1U, before.rlim_max};
        EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &now), 0);
    }
    OneOctetScope(const OneOctetScope&) = delete;
    OneOctetScope& operator=(const OneOctetScope&) = delete;
    ~OneOctetScope() { EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0); }

  private:
    static void allow_more(int /*signal*/) {
        ++SignalScope::count;
        static_cast<void>(::setrlimit(RLIMIT_FSIZE, &before));
    }

    static inline rlimit before{};
    SignalScope refused_;
};

}  // namespace lcm_sample

#endif  // MAMORI_PORTS_LCM_INTERRUPTED_CALL_HPP
