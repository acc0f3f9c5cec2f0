// SPDX-License-Identifier: Apache-2.0
/// @file
/// Lets a system call fail as on an older or exhausted system (seccomp), in a child process of the test.
#ifndef MAMORI_PORTS_POSIX_RT_TESTS_REFUSED_CALL_HPP
#define MAMORI_PORTS_POSIX_RT_TESTS_REFUSED_CALL_HPP

#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace mamori::ports::posix_rt {

/// From now on, `call` fails with `error` in this process and its children; with `with_flags_only`, only if
/// its fourth argument is not 0. @return false: not supported on this system.
inline bool refuse_call(std::uint32_t call, std::uint32_t error, bool with_flags_only) {
    constexpr auto kNumber = static_cast<std::uint32_t>(offsetof(seccomp_data, nr));
    constexpr auto kFlags =
        static_cast<std::uint32_t>(offsetof(seccomp_data, args) + 3U * sizeof(std::uint64_t));
    const std::uint8_t skipped_if_flags = with_flags_only ? 0U : 1U;
    std::array<sock_filter, 6U> steps{{
        {BPF_LD | BPF_W | BPF_ABS, 0U, 0U, kNumber},
        {BPF_JMP | BPF_JEQ | BPF_K, 0U, 3U, call},
        {BPF_LD | BPF_W | BPF_ABS, 0U, 0U, kFlags},
        {BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint8_t>(1U - skipped_if_flags), 0U, 0U},
        {BPF_RET | BPF_K, 0U, 0U, SECCOMP_RET_ERRNO | error},
        {BPF_RET | BPF_K, 0U, 0U, SECCOMP_RET_ALLOW},
    }};
    const sock_fprog program{static_cast<unsigned short>(steps.size()), steps.data()};
    return ::prctl(PR_SET_NO_NEW_PRIVS, 1UL, 0UL, 0UL, 0UL) == 0 &&
           ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

/// The same where the lower half of argument `index` is `value`.
inline bool refuse_call_with(std::uint32_t call, std::uint32_t error, std::size_t index,
                             std::uint32_t value) {
    constexpr auto kNumber = static_cast<std::uint32_t>(offsetof(seccomp_data, nr));
    const auto argument =
        static_cast<std::uint32_t>(offsetof(seccomp_data, args) + index * sizeof(std::uint64_t));
    std::array<sock_filter, 6U> steps{{
        {BPF_LD | BPF_W | BPF_ABS, 0U, 0U, kNumber},
        {BPF_JMP | BPF_JEQ | BPF_K, 0U, 3U, call},
        {BPF_LD | BPF_W | BPF_ABS, 0U, 0U, argument},
        {BPF_JMP | BPF_JEQ | BPF_K, 0U, 1U, value},
        {BPF_RET | BPF_K, 0U, 0U, SECCOMP_RET_ERRNO | error},
        {BPF_RET | BPF_K, 0U, 0U, SECCOMP_RET_ALLOW},
    }};
    const sock_fprog program{static_cast<unsigned short>(steps.size()), steps.data()};
    return ::prctl(PR_SET_NO_NEW_PRIVS, 1UL, 0UL, 0UL, 0UL) == 0 &&
           ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

/// @return exit status of a process that runs `act`: 0 without a failed expectation; -1 if a signal ended it.
inline int run_in_process(const std::function<void()>& act) {
    const pid_t child = ::fork();
    if (child == 0) {
        act();
        ::_exit(::testing::Test::HasFailure() ? 1 : 0);
    }
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_TESTS_REFUSED_CALL_HPP
