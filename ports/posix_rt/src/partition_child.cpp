// SPDX-License-Identifier: Apache-2.0
#include "partition_child.hpp"

#include <fcntl.h>
#include <linux/capability.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>

#include <cerrno>
#include <csignal>
#include <cstring>

namespace mamori::ports::posix_rt::detail {
namespace {

/// More numbers than any kernel has capabilities. Linux rejects unused numbers, which is harmless.
constexpr unsigned long kCapabilityEnd{64UL};

/// Linux kills the process at the end of the thread that started it. The second check detects a thread that
/// has already ended.
bool tie_to_parent(const ChildPlan& plan) noexcept {
    return ::prctl(PR_SET_PDEATHSIG, SIGKILL) == 0 && ::getppid() == plan.parent;
}

bool take_place(const PartitionLimits& limits) noexcept {
    cpu_set_t set;
    CPU_ZERO(&set);
    for (int processor = 0; processor < CPU_SETSIZE; ++processor) {
        if (limits.processor == ThreadPlace::kAnyProcessor || limits.processor == processor) {
            CPU_SET(static_cast<std::size_t>(processor), &set);
        }
    }
    return ::sched_setaffinity(0, sizeof(set), &set) == 0;
}

bool lower_priority(const PartitionLimits& limits) noexcept {
    const sched_param none{};
    errno = 0;
    const int before = ::getpriority(PRIO_PROCESS, 0);
    const int niceness = errno == 0 && before > limits.niceness ? before : limits.niceness;
    return ::sched_setscheduler(0, SCHED_OTHER, &none) == 0 && ::setpriority(PRIO_PROCESS, 0, niceness) == 0;
}

/// Never raises a limit.
bool limit(__rlimit_resource_t resource, rlim_t value) noexcept {
    rlimit before{};
    if (::getrlimit(resource, &before) != 0) {
        return false;
    }
    const rlim_t lower = value < before.rlim_max ? value : before.rlim_max;
    const rlimit after{lower, lower};
    return ::setrlimit(resource, &after) == 0;
}

bool set_limits(const PartitionLimits& limits) noexcept {
    return limit(RLIMIT_RTPRIO, 0U) && limit(RLIMIT_NICE, 0U) && limit(RLIMIT_MEMLOCK, 0U) &&
           limit(RLIMIT_CORE, 0U) && limit(RLIMIT_NOFILE, limits.file_max) &&
           (limits.memory_max == 0U || limit(RLIMIT_AS, limits.memory_max)) &&
           (limits.process_max == 0U || limit(RLIMIT_NPROC, limits.process_max));
}

/// Also empties the ambient set. The program of a root user would get each inheritable capability, although
/// the bounding set has none.
bool drop_inheritable_capabilities() noexcept {
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> sets{};
    if (::syscall(SYS_capget, &header, sets.data()) != 0) {
        return false;
    }
    for (__user_cap_data_struct& set : sets) {
        set.inheritable = 0U;
    }
    return ::syscall(SYS_capset, &header, sets.data()) == 0;
}

/// Removes all capabilities of the program and the possibility to get new ones. A process without the
/// privilege to remove them from its bounding set has none.
bool drop_capabilities() noexcept {
    for (unsigned long capability = 0UL; capability < kCapabilityEnd; ++capability) {
        static_cast<void>(::prctl(PR_CAPBSET_DROP, capability, 0UL, 0UL, 0UL));
    }
    return drop_inheritable_capabilities() && ::prctl(PR_SET_NO_NEW_PRIVS, 1UL, 0UL, 0UL, 0UL) == 0;
}

/// Linux ends this process first when memory is exhausted. Without the file, Linux selects a process.
void prefer_for_memory_kill() noexcept {
    constexpr char kScore[] = "1000";
    const int file = ::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
    if (file >= 0) {
        static_cast<void>(::write(file, kScore, sizeof(kScore) - 1U) > 0);
        static_cast<void>(::close(file));
    }
}

/// Uses the system calls directly: the library functions would change all threads of the safety process.
bool become(uid_t user) noexcept {
    return user == PartitionLimits::kSameUser ||
           (::syscall(SYS_setgroups, 0, nullptr) == 0 && ::syscall(SYS_setresgid, user, user, user) == 0 &&
            ::syscall(SYS_setresuid, user, user, user) == 0);
}

/// Removes the signal settings of the safety process.
void reset_signals() noexcept {
    for (int signal = 1; signal < NSIG; ++signal) {
        struct sigaction action{};
        action.sa_handler = SIG_DFL;
        static_cast<void>(::sigaction(signal, &action, nullptr));
    }
    sigset_t none;
    static_cast<void>(sigemptyset(&none));
    static_cast<void>(pthread_sigmask(SIG_SETMASK, &none, nullptr));
}

/// Sends the process descriptor of this process to the safety process, before another thread can wait for its
/// end.
bool send_descriptor(const ChildPlan& plan) noexcept {
    const int self = static_cast<int>(::syscall(SYS_pidfd_open, ::getpid(), 0));
    if (self < 0) {
        return false;
    }
    ChildReport report{};
    iovec content{&report, sizeof(report)};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(self))> control{};
    msghdr message{};
    message.msg_iov = &content;
    message.msg_iovlen = 1U;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    cmsghdr* const head = CMSG_FIRSTHDR(&message);
    head->cmsg_level = SOL_SOCKET;
    head->cmsg_type = SCM_RIGHTS;
    head->cmsg_len = CMSG_LEN(sizeof(self));
    std::memcpy(CMSG_DATA(head), &self, sizeof(self));
    return ::sendmsg(plan.report, &message, 0) == static_cast<ssize_t>(sizeof(report));
}

/// Copies `file` to a number of at least `above`. Programs do not inherit the copy.
int copy_above(int file, int above) noexcept {
    return ::fcntl(file, F_DUPFD_CLOEXEC, above);
}

/// Assigns the numbers of /dev/null and of the streams and descriptors of the order, and moves the socket.
/// First moves each descriptor above all target numbers, since two descriptors can exchange their numbers.
/// @return the socket; -1: a descriptor is not open.
int assign_descriptors(const ChildPlan& plan) noexcept {
    const Span<const int> sources = plan.order.descriptors;
    const int count = static_cast<int>(sources.size());
    const int report_place = kFirstPartitionDescriptor + count;
    const int above = report_place + 1;
    std::array<int, PartitionOrder::kDescriptorMax> copies{};
    for (std::size_t i = 0U; i < sources.size(); ++i) {
        copies[i] = copy_above(sources[i], above);
        if (copies[i] < 0) {
            return -1;
        }
    }
    const int report_copy = copy_above(plan.report, above);
    const int nothing = copy_above(::open("/dev/null", O_RDWR | O_CLOEXEC), above);
    const int output = plan.order.output == kNoStream ? nothing : copy_above(plan.order.output, above);
    const int errors = plan.order.errors == kNoStream ? nothing : copy_above(plan.order.errors, above);
    if (report_copy < 0 || nothing < 0 || output < 0 || errors < 0 || ::dup2(nothing, 0) < 0 ||
        ::dup2(output, 1) < 0 || ::dup2(errors, 2) < 0 || ::dup3(report_copy, report_place, O_CLOEXEC) < 0) {
        return -1;
    }
    for (int i = 0; i < count; ++i) {
        if (::dup2(copies[static_cast<std::size_t>(i)], kFirstPartitionDescriptor + i) < 0) {
            return -1;
        }
    }
    return ::syscall(SYS_close_range, above, ~0U, 0U) == 0 ? report_place : -1;
}

/// All steps before the start of the program.
/// @return cause of a failure.
/// @param[in,out] report number of the socket.
PartitionError prepare(const ChildPlan& plan, int& report) noexcept {
    const PartitionLimits& limits = plan.order.limits;
    if (!send_descriptor(plan)) {
        return PartitionError::kCannotWatch;
    }
    if (::setsid() < 0 || !lower_priority(limits)) {
        return PartitionError::kCannotRestrict;
    }
    if (!take_place(limits)) {
        return PartitionError::kCannotPlace;
    }
    prefer_for_memory_kill();
    const int assigned = assign_descriptors(plan);
    if (assigned < 0) {
        return PartitionError::kCannotHandOver;
    }
    report = assigned;
    if (!drop_capabilities() || !set_limits(limits)) {
        return PartitionError::kCannotRestrict;
    }
    if (!become(limits.user)) {
        return PartitionError::kCannotBecome;
    }
    // Last step, because a change of the user clears the parent-death signal.
    return tie_to_parent(plan) ? PartitionError::kNone : PartitionError::kCannotRestrict;
}

}  // namespace

void become_partition(const ChildPlan& plan) noexcept {
    int report = plan.report;
    PartitionError error = prepare(plan, report);
    if (error == PartitionError::kNone) {
        reset_signals();
        // execve() does not change the strings.
        static_cast<void>(::execve(plan.order.program, const_cast<char* const*>(plan.arguments.data()),
                                   const_cast<char* const*>(plan.environment.data())));
        error = PartitionError::kCannotExecute;
    }
    const ChildReport message{error, errno};
    static_cast<void>(::write(report, &message, sizeof(message)) > 0);
    ::_exit(127);
}

}  // namespace mamori::ports::posix_rt::detail
