// SPDX-License-Identifier: Apache-2.0
/// @file
/// Forwards the output of an untrusted process line by line, each with the name of the process, so that a
/// common log distinguishes the lines of several partitions and of the safety process.
///
/// @satisfies SWR-PRT-062      Design: docs/design/posix_rt.md#partition-output
#ifndef MAMORI_PORTS_POSIX_RT_PARTITION_OUTPUT_HPP
#define MAMORI_PORTS_POSIX_RT_PARTITION_OUTPUT_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/status.hpp"

namespace mamori::ports::posix_rt {

/// One pipe for each of the two streams of a partition. The pipes stay open when the partition is restarted.
///
/// Calling context: an ordinary thread, never a window. Thread safety: none.
/// Time:            no function waits for the partition. forward() can block in write() to its targets. It
/// reads at most kForwardMax bytes of each stream, so a flood does not prolong it further. While no thread
/// calls forward(), the partition blocks as soon as its pipe is full.
/// Memory:          one line per stream; no heap.
class PartitionOutput final {
  public:
    static constexpr std::size_t kNameMax = 32U;         ///< characters of the name; further ones are omitted
    static constexpr std::size_t kLineMax = 512U;        ///< characters per line; the rest is the next line
    static constexpr std::size_t kForwardMax = 65'536U;  ///< bytes of each stream per call

    /// @param[in] name prefix of each line: `[name] text`.
    explicit PartitionOutput(const char* name) noexcept;
    PartitionOutput(const PartitionOutput&) = delete;
    PartitionOutput& operator=(const PartitionOutput&) = delete;
    /// A partition that writes afterwards receives SIGPIPE.
    ~PartitionOutput();

    /// @return kOk; kPreconditionNotMet (open); kOutOfResources (no free descriptors).
    Status open() noexcept;

    /// For PartitionOrder::output and PartitionOrder::errors; -1 until open().
    int get_output() const noexcept { return streams_[0U].writing; }
    int get_errors() const noexcept { return streams_[1U].writing; }

    /// Writes all complete lines, each with one call of write(). Replaces control characters by '?', since
    /// they could change lines of other processes on a terminal; keeps tabs and omits carriage returns. A
    /// target whose reader has ended raises SIGPIPE in this process: ignore this signal.
    /// @param[in] output, errors descriptors, for example STDOUT_FILENO and STDERR_FILENO; both may be equal.
    /// @return bytes read; 0: no output available.
    std::size_t forward(int output, int errors) noexcept;
    /// Like forward(), and also writes incomplete lines. Call it after PartitionProcess::check() has reported
    /// the end.
    std::size_t forward_rest(int output, int errors) noexcept;

    /// Lines that a target did not accept.
    std::uint64_t get_lost_count() const noexcept { return lost_count_; }

  private:
    struct Stream {
        int reading{-1};
        int writing{-1};
        std::size_t size{0U};  ///< size of the line so far, including the prefix
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
