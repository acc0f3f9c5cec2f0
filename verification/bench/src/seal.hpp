// SPDX-License-Identifier: Apache-2.0
/// @file
/// Forbids this process every system call except its exit, so that the operating system proves the absence of
/// system calls.
#ifndef MAMORI_VERIFICATION_BENCH_SEAL_HPP
#define MAMORI_VERIFICATION_BENCH_SEAL_HPP

#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cstddef>

namespace mamori::verification::bench {

/// After this call, any system call except exit_group ends the process with SIGSYS.
/// @return false if the system does not support it; no call is then forbidden.
inline bool seal_process() noexcept {
    std::array<sock_filter, 4> program{{
        {BPF_LD | BPF_W | BPF_ABS, 0U, 0U, offsetof(seccomp_data, nr)},
        {BPF_JMP | BPF_JEQ | BPF_K, 0U, 1U, SYS_exit_group},
        {BPF_RET | BPF_K, 0U, 0U, SECCOMP_RET_ALLOW},
        {BPF_RET | BPF_K, 0U, 0U, SECCOMP_RET_KILL_PROCESS},
    }};
    const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
           prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0;
}

/// Ends the process with the only permitted call. @param[in] status exit status.
[[noreturn]] inline void leave_sealed(int status) noexcept {
    for (;;) {
        syscall(SYS_exit_group, status);
    }
}

}  // namespace mamori::verification::bench

#endif  // MAMORI_VERIFICATION_BENCH_SEAL_HPP
