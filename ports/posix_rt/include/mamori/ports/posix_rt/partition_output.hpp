// SPDX-License-Identifier: Apache-2.0
/// @file
/// Output of a process of less trust, line by line and with its name before each line, so that a reader of
/// one log tells the lines of several partitions and of the safety process apart.
///
/// @satisfies SWR-PRT-062      Design: docs/design/posix_rt.md#partition-output
#ifndef MAMORI_PORTS_POSIX_RT_PARTITION_OUTPUT_HPP
#define MAMORI_PORTS_POSIX_RT_PARTITION_OUTPUT_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/status.hpp"

namespace mamori::ports::posix_rt {

/// A pipe for each of the two streams of one partition, which stays open when the partition is started again.
///
/// Calling context: an ordinary thread, never a window. Thread safety: none.
/// Time:            no function waits for the partition. forward() waits for its targets, as each writer
/// does.
///                  It takes at most kForwardMax bytes of each stream, so its time is bounded in a flood.
///                  While no thread calls forward(), the partition waits as soon as its pipe is full.
/// Memory:          one line per stream; no heap.
class PartitionOutput final {
  public:
    static constexpr std::size_t kNameMax = 32U;         ///< characters of the name; the rest is left out
    static constexpr std::size_t kLineMax = 512U;        ///< characters of a line; the rest is the next line
    static constexpr std::size_t kForwardMax = 65'536U;  ///< bytes of each stream per call

    /// @param[in] name goes before each line: `[name] text`.
    explicit PartitionOutput(const char* name) noexcept;
    PartitionOutput(const PartitionOutput&) = delete;
    PartitionOutput& operator=(const PartitionOutput&) = delete;
    /// A partition that still runs gets SIGPIPE when it writes afterwards.
    ~PartitionOutput();

    /// @return kOk; kPreconditionNotMet (open); kOutOfResources (no descriptors).
    Status open() noexcept;

    /// For PartitionOrder::output and PartitionOrder::errors; -1 until open().
    int get_output() const noexcept { return streams_[0U].writing; }
    int get_errors() const noexcept { return streams_[1U].writing; }

    /// Writes all lines that are complete, each with one call of write(). Control characters become '?',
    /// since a partition could change the lines of others by them; tabs stay, carriage returns are left out.
    /// A target whose reader has ended raises SIGPIPE in this process: ignore this signal.
    /// @param[in] output, errors descriptors, STDOUT_FILENO and STDERR_FILENO for example; both may be one.
    /// @return bytes that were read; 0: there was nothing.
    std::size_t forward(int output, int errors) noexcept;
    /// The same, and then the lines that are not complete: after PartitionProcess::check() told the end.
    std::size_t forward_rest(int output, int errors) noexcept;

    /// Lines that a target did not take.
    std::uint64_t get_lost_count() const noexcept { return lost_count_; }

  private:
    struct Stream {
        int reading{-1};
        int writing{-1};
        std::size_t size{0U};  ///< of the line so far, prefix included
        std::array<char, kNameMax + 3U + kLineMax + 1U> line{};
    };

    std::size_t forward_stream(Stream& stream, int target) noexcept;
    void take(Stream& stream, char character, int target) noexcept;
    void write_line(Stream& stream, int target) noexcept;
    void close_all() noexcept;

    std::array<Stream, 2U> streams_{};
    std::size_t prefix_size_{0U};
    std::uint64_t lost_count_{0U};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_PARTITION_OUTPUT_HPP
