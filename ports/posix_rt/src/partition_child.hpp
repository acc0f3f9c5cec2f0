// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a new process does to itself before it becomes the program of a partition. It may borrow the memory
/// of the safety process, so it calls the system and changes nothing that is not its own.
///
/// @satisfies SWR-PRT-016, SWR-PRT-061, SWR-PRT-063      Design: docs/design/posix_rt.md#partition-process
#ifndef MAMORI_PORTS_POSIX_RT_PARTITION_CHILD_HPP
#define MAMORI_PORTS_POSIX_RT_PARTITION_CHILD_HPP

#include <unistd.h>

#include <array>
#include <cstddef>

#include "mamori/ports/posix_rt/partition_process.hpp"

namespace mamori::ports::posix_rt::detail {

/// Made before the process is, since that may take no memory.
struct ChildPlan {
    explicit ChildPlan(const PartitionOrder& what) noexcept : order(what), parent(::getpid()) {
        arguments[0U] = what.program;
        for (std::size_t i = 0U; i < what.arguments.size(); ++i) {
            arguments[i + 1U] = what.arguments[i];
        }
    }

    const PartitionOrder& order;
    pid_t parent;
    int report{-1};  ///< end of a socket (SOCK_SEQPACKET) for each ChildReport
    /// Both end with nullptr.
    std::array<const char*, PartitionOrder::kArgumentMax + 2U> arguments{};
    std::array<const char*, 512U> environment{};
};

/// The first message has kNone and the descriptor of the process, which is never that of another process. A
/// second one gives the cause of a failed start; the start of the program closes the socket.
struct ChildReport {
    PartitionError error{PartitionError::kNone};
    int system_error{0};
};

/// Becomes the program, or reports why not and ends.
[[noreturn]] void become_partition(const ChildPlan& plan) noexcept;

}  // namespace mamori::ports::posix_rt::detail

#endif  // MAMORI_PORTS_POSIX_RT_PARTITION_CHILD_HPP
