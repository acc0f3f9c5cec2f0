// SPDX-License-Identifier: Apache-2.0
/// @file
/// Actions of a new process before it starts the program of a partition. Since it may share the memory of the
/// safety process, it uses system calls only and changes only its own data.
///
/// @satisfies SWR-PRT-016, SWR-PRT-061, SWR-PRT-063      Design: docs/design/posix_rt.md#partition-process
#ifndef MAMORI_PORTS_POSIX_RT_PARTITION_CHILD_HPP
#define MAMORI_PORTS_POSIX_RT_PARTITION_CHILD_HPP

#include <unistd.h>

#include <array>
#include <cstddef>

#include "mamori/ports/posix_rt/partition_process.hpp"

namespace mamori::ports::posix_rt::detail {

/// Prepared before the process is created, since the new process must not allocate memory.
struct ChildPlan {
    explicit ChildPlan(const PartitionOrder& what) noexcept : order(what), parent(::getpid()) {
        arguments[0U] = what.program;
        for (std::size_t i = 0U; i < what.arguments.size(); ++i) {
            arguments[i + 1U] = what.arguments[i];
        }
    }

    const PartitionOrder& order;
    pid_t parent;
    int report{-1};  ///< socket (SOCK_SEQPACKET) for each ChildReport
    /// Both arrays end with nullptr.
    std::array<const char*, PartitionOrder::kArgumentMax + 2U> arguments{};
    std::array<const char*, 512U> environment{};
};

/// The first message has kNone and the process descriptor, which never refers to another process. A second
/// message gives the cause of a failed start. The start of the program closes the socket.
struct ChildReport {
    PartitionError error{PartitionError::kNone};
    int system_error{0};
};

/// Starts the program in this process. On failure, reports the cause and ends the process.
[[noreturn]] void become_partition(const ChildPlan& plan) noexcept;

}  // namespace mamori::ports::posix_rt::detail

#endif  // MAMORI_PORTS_POSIX_RT_PARTITION_CHILD_HPP
