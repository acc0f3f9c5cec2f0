// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/partition_process.hpp"

#include <fcntl.h>
#include <poll.h>
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

bool is_valid(const PartitionOrder& order) noexcept {
    const PartitionLimits& limits = order.limits;
    return order.program != nullptr && order.arguments.size() <= PartitionOrder::kArgumentMax &&
           order.descriptors.size() <= PartitionOrder::kDescriptorMax && limits.niceness >= 0 &&
           limits.niceness <= 19 && limits.file_max >= 8U && limits.processor >= ThreadPlace::kAnyProcessor;
}

/// The strings of this process without an epoch that it may have been given itself, and then its own.
/// @return false: there are too many.
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

/// Signals wait while two processes share one memory: a handler must not run in the wrong one.
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

/// A copy of the page tables, as fork() makes it, would cost each thread of this process a fault for each
/// page that it writes next; so the new process borrows this one's memory until it has a program. The
/// system's own posix_spawn() does the same, and cannot set the limits.
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

/// @return bytes of the report; 0 when the other end was closed without one.
ssize_t read_all(int file, ChildReport& report) noexcept {
    ssize_t length = -1;
    do {
        length = ::read(file, &report, sizeof(report));
    } while (length < 0 && errno == EINTR);
    return length;
}

}  // namespace

const char* describe(PartitionError error) noexcept {
    switch (error) {
        case PartitionError::kNone:
            return "runs";
        case PartitionError::kNoProcess:
            return "cannot get a process: too many run, or too many files are open";
        case PartitionError::kTooManyStrings:
            return "cannot be handed the environment: it has too many entries";
        case PartitionError::kCannotPlace:
            return "cannot run there: the machine does not give that processor";
        case PartitionError::kCannotRestrict:
            return "cannot be restricted: the system refuses a limit";
        case PartitionError::kCannotBecome:
            return "cannot run as that user: give the safety process CAP_SETUID and CAP_SETGID";
        case PartitionError::kCannotHandOver:
            return "cannot be handed a descriptor: open it first";
        case PartitionError::kCannotExecute:
            return "cannot be executed: check the path and its permissions";
        case PartitionError::kCannotWatch:
            return "cannot be watched: Linux 5.9 or later is needed";
    }
    return "failed for an unknown reason";  // only a corrupted value comes here
}

PartitionProcess::~PartitionProcess() {
    static_cast<void>(end());
    static_cast<void>(check());
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

/// The program's start closes the pipe; what prevents it comes through the pipe before.
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
    std::array<int, 2U> pipe{};
    if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
        system_error_ = errno;
        return PartitionError::kNoProcess;
    }
    plan.report = pipe[1U];
    const pid_t pid = spawn(plan);
    const int spawn_error = errno;
    static_cast<void>(::close(pipe[1U]));
    ChildReport report{};
    const ssize_t length = pid < 0 ? 0 : read_all(pipe[0U], report);
    static_cast<void>(::close(pipe[0U]));
    if (pid < 0) {
        system_error_ = spawn_error;
        return PartitionError::kNoProcess;
    }
    if (length == static_cast<ssize_t>(sizeof(report))) {
        static_cast<void>(::waitpid(pid, nullptr, 0));  // it ends with its report
        system_error_ = report.system_error;
        return report.error;
    }
    // Until it is waited for, nobody else can get its number.
    watch_ = static_cast<int>(::syscall(SYS_pidfd_open, pid, 0));
    if (watch_ < 0) {
        system_error_ = errno;
        static_cast<void>(::kill(-pid, SIGKILL));
        static_cast<void>(::waitpid(pid, nullptr, 0));
        return PartitionError::kCannotWatch;
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
    // Its number is the one of its group, and stays so until it is waited for.
    static_cast<void>(::kill(-pid_, SIGKILL));
    int status = 0;
    const bool is_known = ::waitpid(pid_, &status, WNOHANG) == pid_;  // not where SIGCHLD is ignored
    exit_status_ = is_known && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    signal_ = is_known && WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    give_up();
    state_ = PartitionState::kEnded;
    return state_;
}

Status PartitionProcess::end() noexcept {
    if (state_ != PartitionState::kRunning) {
        return Status::kPreconditionNotMet;
    }
    static_cast<void>(::kill(-pid_, SIGKILL));
    return Status::kOk;
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
