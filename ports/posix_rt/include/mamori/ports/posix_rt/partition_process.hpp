// SPDX-License-Identifier: Apache-2.0
/// @file
/// An untrusted process next to the safety process. It starts with the necessary privileges and descriptors
/// only. Its state can be queried without waiting. It ends with the safety process.
///
/// @satisfies SWR-PRT-015, SWR-PRT-016, SWR-PRT-017, SWR-PRT-018, SWR-PRT-061, SWR-PRT-063
/// Design:   docs/design/posix_rt.md#partition-process
#ifndef MAMORI_PORTS_POSIX_RT_PARTITION_PROCESS_HPP
#define MAMORI_PORTS_POSIX_RT_PARTITION_PROCESS_HPP

#include <sys/types.h>

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/ports/posix_rt/real_time_rights.hpp"

namespace mamori::ports::posix_rt {

/// Number of the first inherited descriptor in the started process. There, 0 is /dev/null, and 1 and 2 are
/// the streams of the order. No other descriptor is open.
inline constexpr int kFirstPartitionDescriptor{3};
/// Output to /dev/null.
inline constexpr int kNoStream{-1};

/// Limits of an untrusted process. These limits always apply: SCHED_OTHER without the privilege to change it,
/// no capabilities, no locked memory, no core file, and the first process that Linux ends when memory is
/// exhausted.
struct PartitionLimits {
    static constexpr uid_t kSameUser = static_cast<uid_t>(-1);

    int niceness{10};              ///< nice value, 0 .. 19; at least that of the safety process
    std::uint64_t memory_max{0U};  ///< address space of each process [byte]; 0: as the safety process
    std::uint32_t process_max{
        0U};  ///< processes and threads of the user, except root; 0: as the safety process
    std::uint32_t file_max{64U};                ///< maximum number of open files, at least 8
    int processor{ThreadPlace::kAnyProcessor};  ///< permitted processor; kAnyProcessor: all
    /// User of the process. A different user cannot send signals to the safety process or change its
    /// priorities. Requires the privileges to change to this user and to end its processes (CAP_SETUID,
    /// CAP_SETGID, CAP_KILL). The group id is set to the same number.
    uid_t user{kSameUser};
};

/// Order to start a process. All data are used during PartitionProcess::start() only.
struct PartitionOrder {
    static constexpr std::size_t kArgumentMax = 16U;
    static constexpr std::size_t kDescriptorMax = 8U;

    const char* program{nullptr};         ///< path; PATH is not searched
    Span<const char* const> arguments{};  ///< arguments after the program name, up to kArgumentMax
    Span<const int> descriptors{};        ///< inherited, numbered from kFirstPartitionDescriptor
    const FrameClock* clock{nullptr};     ///< time line for find_partition_clock(), or nullptr
    PartitionLimits limits{};
    /// Descriptors that become standard output and standard error: a file, or the descriptors of a
    /// PartitionOutput. With 1 or 2, the process writes to the stream of the safety process and can flood it
    /// or change its flags.
    int output{kNoStream};
    int errors{kNoStream};
};

/// Why a process was not started.
enum class PartitionError : std::uint8_t {
    kNone,
    kNoProcess,       ///< the system cannot create another process or descriptor
    kTooManyStrings,  ///< the environment of the safety process has too many entries
    kCannotPlace,     ///< the processor does not exist
    kCannotRestrict,  ///< the system rejects a limit
    kCannotBecome,    ///< privilege to change to the user missing
    kCannotHandOver,  ///< a descriptor or stream is not open
    kCannotExecute,   ///< the file does not exist or is not executable
    kCannotWatch,     ///< no process descriptors: Linux is older than 5.9
};

/// Message for the user; never nullptr.
const char* describe(PartitionError error) noexcept;

/// State of the process at the last check. A process that is stopped or in an endless loop counts as running:
/// only its missing messages indicate this.
enum class PartitionState : std::uint8_t { kNone, kRunning, kEnded };

/// Owner of one process. After the end of the process, start() can be called again.
///
/// Calling context: an ordinary thread, never a window. Linux kills the process when the thread that called
///                  start() ends, so this thread must continue to exist.
/// Children:        this class waits for its own child only. Before Linux 6.9, no other thread may wait for
/// this child (waitpid(-1)), and SIGCHLD must not be ignored. These kernels kill a group by its id, so the
/// class first checks that the child still holds this id.
/// Thread safety:   none.
/// Time:            start() waits until the system has started the program, the destructor until the process
///                  has ended. The other functions are O(1) and do not wait.
/// Memory:          none of its own.
class PartitionProcess final {
  public:
    PartitionProcess() noexcept = default;
    /// Kills the process and its group and waits for its end, so that no zombie remains. The wait ends after
    /// 10 s, since Linux cannot end a process that hangs in a driver.
    ~PartitionProcess();
    PartitionProcess(const PartitionProcess&) = delete;
    PartitionProcess& operator=(const PartitionProcess&) = delete;

    /// Starts the program in a separate session. Meanwhile, the windows of the safety process continue to
    /// run: its memory is not copied.
    /// @return kOk: the program runs. kBadParameter (no program, too many arguments or descriptors, a limit
    /// out of range); kPreconditionNotMet (a process is running); kOutOfResources (kNoProcess,
    /// kTooManyStrings); kError (every other cause). get_error() and get_system_error() return the cause. On
    /// failure, no process remains.
    Status start(const PartitionOrder& order) noexcept;

    /// Queries whether the process still runs. When it has ended, kills the other processes of its group.
    PartitionState check() noexcept;

    /// Kills the process and its group. check() reports when the process has ended.
    /// @return kOk; kPreconditionNotMet (no process is running).
    Status end() noexcept;

    /// Sends a signal to the process, never to another process that reuses its id.
    /// @param[in] signal as for kill().
    /// @return kOk; kPreconditionNotMet (no process is running, or it has just ended); kBadParameter (invalid
    ///         signal); kError (permission to signal its user missing).
    Status send_signal(int signal) noexcept;

    /// Process id, for display only: use send_signal() for signals. -1 before the start and after check() has
    /// reported the end.
    pid_t get_pid() const noexcept { return pid_; }
    /// Exit status of the last process that ended; -1 if a signal ended it, or if none has ended.
    int get_exit_status() const noexcept { return exit_status_; }
    /// Signal that ended the last process; 0 if the process exited, or if none has ended.
    int get_signal() const noexcept { return signal_; }

    /// Cause of the failure of the last start(); kNone if it succeeded or was not called.
    PartitionError get_error() const noexcept { return error_; }
    /// `errno` of this failure; 0 if no system call failed.
    int get_system_error() const noexcept { return system_error_; }

  private:
    void end_and_wait() noexcept;
    PartitionError launch(const PartitionOrder& order) noexcept;
    void give_up() noexcept;

    pid_t pid_{-1};
    int watch_{-1};  ///< process descriptor
    int exit_status_{-1};
    int signal_{0};
    int system_error_{0};
    PartitionState state_{PartitionState::kNone};
    PartitionError error_{PartitionError::kNone};
};

/// Gets the time line of the safety process. Call it in the started process.
/// @param[out] clock written on kOk only. @return kOk; kPreconditionNotMet (the order contained no clock).
Status find_partition_clock(FrameClock& clock) noexcept;

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_PARTITION_PROCESS_HPP
