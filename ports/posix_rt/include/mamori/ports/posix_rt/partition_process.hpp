// SPDX-License-Identifier: Apache-2.0
/// @file
/// A process of less trust beside the safety process: started with what it needs and no more, told apart from
/// a dead one without waiting, and gone when the safety process is.
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

/// Number of the first descriptor that is handed over, in the process that was started; 0 is /dev/null there,
/// 1 and 2 are the streams of the order. No other descriptor is open.
inline constexpr int kFirstPartitionDescriptor{3};
/// Output to /dev/null.
inline constexpr int kNoStream{-1};

/// What bounds a process of less trust, beside what bounds every one: ordinary scheduling without the right
/// to another, no capabilities, no locked memory, no core file, first in line when memory runs out.
struct PartitionLimits {
    static constexpr uid_t kSameUser = static_cast<uid_t>(-1);

    int niceness{10};  ///< 0 .. 19; that of the safety process when that is more
    std::uint64_t memory_max{
        0U};  ///< address space of each of its processes [byte]; 0: as the safety process
    std::uint32_t process_max{
        0U};  ///< processes and threads of its user, root excepted; 0: as the safety process
    std::uint32_t file_max{64U};                ///< open files, from 8 on
    int processor{ThreadPlace::kAnyProcessor};  ///< its processor; kAnyProcessor: all that the machine gives
    /// Another user cannot send signals to the safety process or change its priorities; needs the right to
    /// become one and to end it (CAP_SETUID, CAP_SETGID, CAP_KILL). The group gets the same number.
    uid_t user{kSameUser};
};

/// What is started. Everything is used during PartitionProcess::start() only.
struct PartitionOrder {
    static constexpr std::size_t kArgumentMax = 16U;
    static constexpr std::size_t kDescriptorMax = 8U;

    const char* program{nullptr};         ///< path; not searched for
    Span<const char* const> arguments{};  ///< behind the program's name, up to kArgumentMax
    Span<const int> descriptors{};        ///< become kFirstPartitionDescriptor and the next ones
    const FrameClock* clock{nullptr};     ///< time line for find_partition_clock(), or nullptr
    PartitionLimits limits{};
    /// Descriptors that become standard output and standard error: a file, or the descriptors of a
    /// PartitionOutput. With 1 or 2, the process writes to the stream of the safety process, which it can
    /// fill or change.
    int output{kNoStream};
    int errors{kNoStream};
};

/// Why a process was not started.
enum class PartitionError : std::uint8_t {
    kNone,
    kNoProcess,       ///< the system has no room for a process, or none for its descriptors
    kTooManyStrings,  ///< the environment of the safety process has more entries than it can hand on
    kCannotPlace,     ///< the processor is not there
    kCannotRestrict,  ///< a limit is refused
    kCannotBecome,    ///< no right to become that user
    kCannotHandOver,  ///< a descriptor or a stream is none
    kCannotExecute,   ///< the program is not there or not a program
    kCannotWatch,     ///< the system has no descriptors of processes: older than Linux 5.9
};

/// A sentence for the user; never nullptr.
const char* describe(PartitionError error) noexcept;

/// Life of the process as it was last seen. One that stands still, stopped or in a loop, is running: only the
/// absence of its frames tells.
enum class PartitionState : std::uint8_t { kNone, kRunning, kEnded };

/// Owner of one process, which may be started again when it has ended.
///
/// Calling context: an ordinary thread, never a window. The process is killed when the thread that started it
///                  ends, so that thread must stay.
/// Children:        this class waits for its own child only. Before Linux 6.9, no other thread may wait for
/// it
///                  or let the system do so (waitpid(-1), SIGCHLD ignored), because a group is killed by its
///                  number there, directly after a check that the child still holds this number.
/// Thread safety:   none.
/// Time:            start() takes as long as the system needs for a new program, and the destructor as long
///                  as it needs to end one. The other functions are O(1) and do not wait.
/// Memory:          none of its own.
class PartitionProcess final {
  public:
    PartitionProcess() noexcept = default;
    /// Kills it with its group and waits for its end, so no zombie remains. After 10 s it waits no longer,
    /// for a process that the system cannot end, in a driver for example.
    ~PartitionProcess();
    PartitionProcess(const PartitionProcess&) = delete;
    PartitionProcess& operator=(const PartitionProcess&) = delete;

    /// Starts the program in a session of its own. The windows of the safety process run on meanwhile: its
    /// memory is not copied.
    /// @return kOk: the program runs. kBadParameter (no program, too many arguments or descriptors, a limit
    /// out
    ///         of its range); kPreconditionNotMet (one is running); kOutOfResources (kNoProcess,
    ///         kTooManyStrings); kError (every other cause): get_error() and get_system_error() tell it, and
    ///         nothing is left running.
    Status start(const PartitionOrder& order) noexcept;

    /// Looks whether it still lives. What it has started and that has not left its group is killed with its
    /// end.
    PartitionState check() noexcept;

    /// Kills it and its group. check() tells when it is over. @return kOk; kPreconditionNotMet (none is
    /// running).
    Status end() noexcept;

    /// Sends a signal to the process, never to another one that got its number. @param[in] signal as for
    /// kill().
    /// @return kOk; kPreconditionNotMet (none is running, or it has just ended); kBadParameter (no signal);
    ///         kError (no right to signal its user).
    Status send_signal(int signal) noexcept;

    /// For display: send_signal() does not confuse processes. While it runs, and until check() has said that
    /// it ended; else -1.
    pid_t get_pid() const noexcept { return pid_; }
    /// Of the last one that ended: its exit status, or -1 when a signal ended it, or none has ended.
    int get_exit_status() const noexcept { return exit_status_; }
    /// Of the last one that ended: the signal; 0 when it ended by itself, or none has ended.
    int get_signal() const noexcept { return signal_; }

    /// Cause of the last start() that failed; kNone before it, and after one that did not.
    PartitionError get_error() const noexcept { return error_; }
    /// `errno` behind it; 0 where the system had no objection.
    int get_system_error() const noexcept { return system_error_; }

  private:
    void end_and_wait() noexcept;
    PartitionError launch(const PartitionOrder& order) noexcept;
    void give_up() noexcept;

    pid_t pid_{-1};
    int watch_{-1};  ///< descriptor of the process
    int exit_status_{-1};
    int signal_{0};
    int system_error_{0};
    PartitionState state_{PartitionState::kNone};
    PartitionError error_{PartitionError::kNone};
};

/// In the process that was started: the time line of the safety process.
/// @param[out] clock written on kOk only. @return kOk; kPreconditionNotMet (none was handed over).
Status find_partition_clock(FrameClock& clock) noexcept;

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_PARTITION_PROCESS_HPP
