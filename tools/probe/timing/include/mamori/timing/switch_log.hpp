// SPDX-License-Identifier: Apache-2.0
/// @file
/// Records which thread ran on the processor of a core, from the scheduler switches that Linux reports
/// through perf_event_open(2). The switches around a late window or an overrun are kept, all others only
/// counted.
///
/// @satisfies SWR-TIM-042      Design: docs/design/timing.md#switch-log
#ifndef MAMORI_TIMING_SWITCH_LOG_HPP
#define MAMORI_TIMING_SWITCH_LOG_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/ports/posix_rt/real_time_rights.hpp"

namespace mamori::timing {

/// Thread of a slice whose switches were lost.
inline constexpr std::uint32_t kUnknownThread = 0xFFFFFFFFU;

/// One uninterrupted stay of a thread on the processor. Thread 0 of process 0 is the idle thread.
struct Slice {
    Instant begin{};
    Instant end{};
    std::uint32_t thread{0U};
    std::uint32_t process{0U};
    bool is_preempted{false};  ///< the thread could have continued; false: it waits for something
};

/// Time of other threads on the processor of a core during one window instance.
struct ProcessorUse {
    Duration own{0};           ///< threads of this process other than runner and window thread
    Duration outside{0};       ///< threads of other processes and of the kernel, except the idle thread
    std::uint32_t thread{0U};  ///< the one with the longest slice; 0: none
};

/// Priority of a thread that had ended before its priority could be read.
inline constexpr int kUnknownPriority = -1;

/// A thread of this process that was seen on the processor.
struct OwnThread {
    std::uint32_t thread{0U};
    int priority{kUnknownPriority};  ///< highest fixed priority that was read, 1 .. 99; 0: none
};

/// Switches of one processor.
///
/// Calling context: open() and reading before and after the run; the rest from the thread that runs the
/// windows. Time: O(switches since the last call). Memory: heap, all allocated in the constructor; open()
/// maps a buffer of 1 MiB, or as much as Linux permits.
class SwitchLog final {
  public:
    /// Slices between two windows; a busy host has a hundred per major frame.
    static constexpr std::size_t kBatch = 16384U;
    static constexpr std::size_t kPageMin = 8U;
    static constexpr std::size_t kPageMax = 256U;

    /// @param[in] capacity of the kept slices; further ones are counted and lost.
    /// @param[in] batch slices of one read(), > 0; further ones are counted and lost.
    explicit SwitchLog(std::size_t capacity, std::size_t batch = kBatch);
    SwitchLog(const SwitchLog&) = delete;
    SwitchLog& operator=(const SwitchLog&) = delete;
    ~SwitchLog();

    /// Begins to record. @param[in] processor number, 0, 1, ... @param[in] clock time line of the slices.
    /// @param[in] page_max size of the buffer [pages]: a power of two, kPageMin or more.
    /// @return refused without the privilege (CAP_PERFMON, perf_event_paranoid) or without support of the
    /// host; the log then stays empty.
    ports::posix_rt::Right open(int processor, const ports::posix_rt::FrameClock& clock,
                                std::size_t page_max = kPageMax) noexcept;
    bool is_open() const noexcept { return ring_ != nullptr; }

    /// The calling thread runs the windows.
    void take_runner() noexcept;
    std::uint32_t get_runner() const noexcept { return runner_; }

    /// Reads the next switches. @param[in] record_max records of Linux to read, about 30 ns and half a switch
    /// each; the next call reads the rest.
    void read(std::size_t record_max = std::numeric_limits<std::size_t>::max()) noexcept;
    /// The slices of the last read(), in the order of their instants.
    Span<const Slice> get_batch() const noexcept { return {batch_.slices.data(), batch_.count}; }
    /// Evaluates the slices of the last read(); time with lost switches, or whose switches have not been read
    /// yet, is not counted.
    /// @param[in] window_thread thread of the window; 0: unknown.
    ProcessorUse calc_use(Instant from, Instant to, std::uint32_t window_thread) const noexcept;

    /// Call once after each read(). @param[in] is_kept keeps the slices of the last two calls of read().
    void settle(bool is_kept) noexcept;

    Span<const Slice> get_kept() const noexcept { return {kept_.data(), kept_count_}; }
    Span<const OwnThread> get_own_threads() const noexcept { return {own_.data(), own_count_}; }
    /// Number of records and slices for which there was no space.
    std::uint64_t get_lost_count() const noexcept { return lost_count_; }

  private:
    struct Batch {
        std::vector<Slice> slices;
        std::size_t count{0U};
        bool is_stored{false};
    };
    void read_record(std::uint64_t position, std::uint32_t size) noexcept;
    void add_slice(const Slice& slice) noexcept;
    void store(Batch& batch) noexcept;
    void note_own(std::uint32_t thread, bool is_kept) noexcept;
    std::uint64_t load_word(std::uint64_t position) const noexcept;

    void* ring_{nullptr};
    std::size_t ring_size_{0U};
    const char* data_{nullptr};  ///< of the ring, with a power of two of bytes
    std::uint64_t data_mask_{0U};
    int file_{-1};
    std::int64_t epoch_ns_{0};
    std::uint32_t process_{0U};
    std::uint32_t runner_{0U};
    bool has_gap_{false};  ///< switches were lost since the last slice
    Instant last_{};       ///< end of the last slice
    Slice coming_{};       ///< thread that came to the processor last
    Batch batch_{};
    Batch previous_{};
    std::vector<Slice> kept_;
    std::size_t kept_count_{0U};
    std::array<OwnThread, 256U> own_{};
    std::size_t own_count_{0U};
    std::uint64_t lost_count_{0U};
};

}  // namespace mamori::timing

#endif  // MAMORI_TIMING_SWITCH_LOG_HPP
