// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/partition_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <limits>

#include "partition_child.hpp"

namespace mamori::ports::posix_rt {
namespace {

using detail::ChildPlan;
using detail::ChildReport;

constexpr char kEpochName[] = "MAMORI_EPOCH_NS=";
constexpr std::size_t kEpochNameLength = sizeof(kEpochName) - 1U;
constexpr Duration kEndPatience{10'000'000'000};
/// Constants that older supported headers do not define.
constexpr auto kByDescriptor = static_cast<idtype_t>(3);  ///< P_PIDFD, Linux 5.4
constexpr unsigned int kToGroup{4U};                      ///< PIDFD_SIGNAL_PROCESS_GROUP, Linux 6.9

bool is_valid(const PartitionOrder& order) noexcept {
    const PartitionLimits& limits = order.limits;
    return order.program != nullptr && order.arguments.size() <= PartitionOrder::kArgumentMax &&
           order.descriptors.size() <= PartitionOrder::kDescriptorMax && limits.niceness >= 0 &&
           limits.niceness <= 19 && limits.file_max >= 8U && limits.processor >= ThreadPlace::kAnyProcessor &&
           order.output >= kNoStream && order.errors >= kNoStream;
}

/// Copies the environment of this process, except an epoch that it inherited, and adds the epoch of the
/// order.
/// @return false: too many entries.
bool fill_environment(ChildPlan& plan, char* epoch) noexcept {
    std::size_t count = 0U;
    for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
        if (std::strncmp(*entry, kEpochName, kEpochNameLength) == 0) {
            continue;
        }
        if (count + 2U >= plan.environment.size()) {
            return false;
        }
        plan.environment[count] = *entry;
        ++count;
    }
    plan.environment[count] = epoch;
    return true;
}

/// Blocks signals while two processes share one memory, so that no handler runs in the wrong process.
class SignalsHeldBack final {
  public:
    SignalsHeldBack() noexcept {
        sigset_t all;
        static_cast<void>(sigfillset(&all));
        static_cast<void>(pthread_sigmask(SIG_SETMASK, &all, &before_));
    }
    SignalsHeldBack(const SignalsHeldBack&) = delete;
    SignalsHeldBack& operator=(const SignalsHeldBack&) = delete;
    ~SignalsHeldBack() { static_cast<void>(pthread_sigmask(SIG_SETMASK, &before_, nullptr)); }

  private:
    sigset_t before_{};
};

/// fork() copies the page tables; afterwards, each thread of this process would have a page fault at its
/// first write to each page. Therefore, the new process shares the memory of this process until it starts its
/// program. posix_spawn() does the same but cannot set the limits.
// NOLINTBEGIN(bugprone-unsafe-functions,cert-msc24-c,cert-msc33-c,clang-analyzer-security.insecureAPI.vfork)
// NOLINTBEGIN(clang-analyzer-unix.Vfork)
pid_t spawn(const ChildPlan& plan) noexcept {
    const SignalsHeldBack held;
    const pid_t pid = ::vfork();
    if (pid == 0) {
        detail::become_partition(plan);
    }
    return pid;
}
// NOLINTEND(clang-analyzer-unix.Vfork)
// NOLINTEND(bugprone-unsafe-functions,cert-msc24-c,cert-msc33-c,clang-analyzer-security.insecureAPI.vfork)

/// Waits for the next message of the child.
/// @param[in,out] watch set to the process descriptor if the message contains it.
/// @return false: the socket was closed without a message.
bool receive(int socket, ChildReport& report, int& watch) noexcept {
    iovec content{&report, sizeof(report)};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(watch))> control{};
    msghdr message{};
    message.msg_iov = &content;
    message.msg_iovlen = 1U;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    ssize_t length = -1;
    do {
        length = ::recvmsg(socket, &message, MSG_CMSG_CLOEXEC);
    } while (length < 0 && errno == EINTR);
    const cmsghdr* const head = CMSG_FIRSTHDR(&message);
    if (length > 0 && head != nullptr && head->cmsg_type == SCM_RIGHTS) {
        std::memcpy(&watch, CMSG_DATA(head), sizeof(watch));
    }
    return length == static_cast<ssize_t>(sizeof(report));
}

/// @param[in] options as for waitid(), without WEXITED.
/// @return false: not a child of this process, or still running (with WNOHANG).
bool wait_for(idtype_t kind, id_t child, int options, siginfo_t& end) noexcept {
    int result = -1;
    do {
        end.si_pid = 0;
        result = ::waitid(kind, child, &end, WEXITED | options);
    } while (result != 0 && errno == EINTR);
    return result == 0 && end.si_pid != 0;
}

/// True if a running or zombie child holds this id, so that no other process can have it.
bool is_held(idtype_t kind, id_t child) noexcept {
    siginfo_t end{};
    return ::waitid(kind, child, &end, WEXITED | WNOHANG | WNOWAIT) == 0;
}

/// Kills the process of the descriptor and its group, also after another thread has waited for the process.
/// Older kernels kill a group by its id only.
void kill_group(int watch, pid_t pid) noexcept {
    if (::syscall(SYS_pidfd_send_signal, watch, SIGKILL, nullptr, kToGroup) == 0 || errno != EINVAL) {
        return;
    }
    if (is_held(kByDescriptor, static_cast<id_t>(watch))) {
        static_cast<void>(::kill(-pid, SIGKILL));
    }
}

/// Kills a process that was started without a process descriptor, with or without its own group.
void kill_unwatched(pid_t pid) noexcept {
    siginfo_t end{};
    if (is_held(P_PID, static_cast<id_t>(pid))) {
        static_cast<void>(::kill(pid, SIGKILL));
        static_cast<void>(::kill(-pid, SIGKILL));
        static_cast<void>(wait_for(P_PID, static_cast<id_t>(pid), 0, end));
    }
}

}  // namespace

const char* describe(PartitionError error) noexcept {
    switch (error) {
        case PartitionError::kNone:
            return "runs";
        case PartitionError::kNoProcess:
            return "cannot create a process: too many processes or open files";
        case PartitionError::kTooManyStrings:
            return "cannot inherit the environment: it has too many entries";
        case PartitionError::kCannotPlace:
            return "cannot run on this processor: select a processor that exists and is permitted";
        case PartitionError::kCannotRestrict:
            return "cannot be restricted: the system rejects a limit";
        case PartitionError::kCannotBecome:
            return "cannot run as this user: give the safety process CAP_SETUID and CAP_SETGID";
        case PartitionError::kCannotHandOver:
            return "cannot inherit a descriptor: open it first";
        case PartitionError::kCannotExecute:
            return "cannot be executed: check the path and its permissions";
        case PartitionError::kCannotWatch:
            return "cannot be supervised: use Linux 5.9 or later";
    }
    return "failed for an unknown reason";  // reached with a corrupted value only
}

PartitionProcess::~PartitionProcess() {
    end_and_wait();
    give_up();
}

Status PartitionProcess::start(const PartitionOrder& order) noexcept {
    if (check() == PartitionState::kRunning) {
        return Status::kPreconditionNotMet;
    }
    if (!is_valid(order)) {
        return Status::kBadParameter;
    }
    system_error_ = 0;
    error_ = launch(order);
    switch (error_) {
        case PartitionError::kNone:
            state_ = PartitionState::kRunning;
            return Status::kOk;
        case PartitionError::kNoProcess:
        case PartitionError::kTooManyStrings:
            return Status::kOutOfResources;
        case PartitionError::kCannotPlace:
        case PartitionError::kCannotRestrict:
        case PartitionError::kCannotBecome:
        case PartitionError::kCannotHandOver:
        case PartitionError::kCannotExecute:
        case PartitionError::kCannotWatch:
            break;
    }
    return Status::kError;
}

/// The socket transmits the process descriptor and the cause of a failed start. The start of the program
/// closes it.
PartitionError PartitionProcess::launch(const PartitionOrder& order) noexcept {
    ChildPlan plan{order};
    std::array<char, kEpochNameLength + std::numeric_limits<std::int64_t>::digits10 + 3U> epoch{};
    if (order.clock != nullptr) {
        std::memcpy(epoch.data(), kEpochName, kEpochNameLength);
        char* const last = epoch.data() + epoch.size() - 1U;
        static_cast<void>(std::to_chars(epoch.data() + kEpochNameLength, last, order.clock->get_epoch_ns()));
    }
    if (!fill_environment(plan, order.clock == nullptr ? nullptr : epoch.data())) {
        return PartitionError::kTooManyStrings;
    }
    std::array<int, 2U> ends{};
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
        system_error_ = errno;
        return PartitionError::kNoProcess;
    }
    plan.report = ends[1U];
    const pid_t pid = spawn(plan);
    const int spawn_error = errno;
    static_cast<void>(::close(ends[1U]));
    ChildReport report{};
    if (pid > 0 && receive(ends[0U], report, watch_) && report.error == PartitionError::kNone) {
        static_cast<void>(receive(ends[0U], report, watch_));
    }
    static_cast<void>(::close(ends[0U]));
    if (pid < 0) {
        system_error_ = spawn_error;
        return PartitionError::kNoProcess;
    }
    if (report.error != PartitionError::kNone) {
        siginfo_t end{};
        static_cast<void>(wait_for(P_PID, static_cast<id_t>(pid), 0, end));  // it ends after its report
        give_up();
        system_error_ = report.system_error;
        return report.error;
    }
    if (watch_ < 0) {  // too many open files in this process
        kill_unwatched(pid);
        system_error_ = EMFILE;
        return PartitionError::kNoProcess;
    }
    pid_ = pid;
    return PartitionError::kNone;
}

PartitionState PartitionProcess::check() noexcept {
    if (state_ != PartitionState::kRunning) {
        return state_;
    }
    pollfd watch{watch_, POLLIN, 0};
    if (::poll(&watch, 1U, 0) != 1) {
        return state_;
    }
    kill_group(watch_, pid_);
    siginfo_t end{};
    // Unknown if another thread has waited for the process, or if SIGCHLD is ignored.
    const bool is_known = wait_for(kByDescriptor, static_cast<id_t>(watch_), WNOHANG, end);
    const bool has_exited = end.si_code == CLD_EXITED;
    exit_status_ = is_known && has_exited ? end.si_status : -1;
    signal_ = is_known && !has_exited ? end.si_status : 0;
    give_up();
    state_ = PartitionState::kEnded;
    return state_;
}

Status PartitionProcess::end() noexcept {
    if (state_ != PartitionState::kRunning) {
        return Status::kPreconditionNotMet;
    }
    kill_group(watch_, pid_);
    return Status::kOk;
}

void PartitionProcess::end_and_wait() noexcept {
    const FrameClock clock = FrameClock::at_epoch(0);
    const Instant until = clock.get_now() + kEndPatience;
    static_cast<void>(end());
    while (check() == PartitionState::kRunning && clock.get_now() < until) {
        pollfd watch{watch_, POLLIN, 0};
        static_cast<void>(::poll(&watch, 1U, 100));
    }
}

Status PartitionProcess::send_signal(int signal) noexcept {
    if (state_ != PartitionState::kRunning) {
        return Status::kPreconditionNotMet;
    }
    if (::syscall(SYS_pidfd_send_signal, watch_, signal, nullptr, 0U) == 0) {
        return Status::kOk;
    }
    switch (errno) {
        case ESRCH:
            return Status::kPreconditionNotMet;
        case EINVAL:
            return Status::kBadParameter;
        default:
            return Status::kError;
    }
}

void PartitionProcess::give_up() noexcept {
    if (watch_ >= 0) {
        static_cast<void>(::close(watch_));
    }
    watch_ = -1;
    pid_ = -1;
}

Status find_partition_clock(FrameClock& clock) noexcept {
    for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
        if (std::strncmp(*entry, kEpochName, kEpochNameLength) != 0) {
            continue;
        }
        const char* const first = *entry + kEpochNameLength;
        const char* const last = first + std::strlen(first);
        std::int64_t epoch_ns = 0;
        const std::from_chars_result result = std::from_chars(first, last, epoch_ns);
        if (result.ec == std::errc{} && result.ptr == last) {
            clock = FrameClock::at_epoch(epoch_ns);
            return Status::kOk;
        }
    }
    return Status::kPreconditionNotMet;
}

}  // namespace mamori::ports::posix_rt
