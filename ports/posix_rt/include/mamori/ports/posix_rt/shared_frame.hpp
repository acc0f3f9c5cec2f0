// SPDX-License-Identifier: Apache-2.0
/// @file
/// One-way transport of messages of bounded size through memory that two processes share. The writer never
/// waits for the reader. The reader has read access only and validates all data.
///
/// @satisfies SWR-PRT-010, SWR-PRT-011      Design: docs/design/posix_rt.md#frames
/// Source:   H.-J. Boehm, "Can seqlocks get along with programming language memory models?", MSPC 2012
#ifndef MAMORI_PORTS_POSIX_RT_SHARED_FRAME_HPP
#define MAMORI_PORTS_POSIX_RT_SHARED_FRAME_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"

namespace mamori::ports::posix_rt {

namespace detail {
/// Unit of the shared memory. It has the same size in all processes and on all processors.
using FrameWord = std::uint64_t;
static_assert(__atomic_always_lock_free(sizeof(FrameWord), nullptr),
              "processes share words without a lock, so the processor must load and store a word atomically");

inline constexpr std::size_t kFrameSlots{4U};
/// Words for number, instant and length of a message.
inline constexpr std::size_t kFrameHeadWords{3U};

constexpr std::size_t calc_slot_words(std::size_t capacity) noexcept {
    return kFrameHeadWords + (capacity + sizeof(FrameWord) - 1U) / sizeof(FrameWord);
}
}  // namespace detail

/// Maximum capacity of a message [byte].
inline constexpr std::size_t kFrameCapacityMax{1U << 20U};

/// Size of the memory for messages of up to `capacity` bytes [byte].
/// @param[in] capacity 1 .. kFrameCapacityMax.
constexpr std::size_t calc_frame_region_size(std::size_t capacity) noexcept {
    return sizeof(detail::FrameWord) * (1U + detail::kFrameSlots * detail::calc_slot_words(capacity));
}

/// Properties of a message as the writer states them. The reader does not know whether they are true.
struct FrameFacts {
    std::uint64_t number{0U};  ///< counts the messages from 1; after the maximum follows 1
    Instant published_at{};    ///< publication of the content, on the common time line
    std::size_t length{0U};    ///< size of the content [byte], at most the capacity
};

/// Outcome of a read.
enum class FrameOutcome : std::uint32_t {
    kNothingNew,  ///< no message since the last one
    kNew,         ///< a new message
    kTorn,        ///< the writer wrote during each try, or the memory is inconsistent
    kMalformed,   ///< a message longer than the capacity, or one that its receiver rejects
};

/// Writes messages. The reader never gets an incomplete message, also if the writer is stopped or killed
/// during write().
///
/// Thread safety: one context of one process writes to a memory.
/// Time: write() is wait-free, O(length), without a system call. Memory: none of its own.
class FrameWriter final {
  public:
    FrameWriter() noexcept = default;
    FrameWriter(const FrameWriter&) = delete;
    FrameWriter& operator=(const FrameWriter&) = delete;

    /// Continues with the number after that of the last message in the memory, so that a reader detects the
    /// next message as new.
    /// @param[in] region zeros, or data of an earlier writer; must outlive the writer.
    /// @param[in] capacity maximum content [byte], 1 .. kFrameCapacityMax; same value as for the reader.
    /// @return kOk; kBadParameter (capacity, or a region that is too small or not at a multiple of 8).
    Status open(Span<std::byte> region, std::size_t capacity) noexcept;

    /// Writes `content` as the newest message. @param[in] published_at see FrameFacts.
    /// @return kOk; kBadParameter (longer than the capacity); kPreconditionNotMet (not open).
    Status write(Span<const std::byte> content, Instant published_at) noexcept;

    /// Longest content [byte]; 0 while not open.
    std::size_t get_capacity() const noexcept { return capacity_; }

  private:
    detail::FrameWord* words_{nullptr};
    std::size_t capacity_{0U};
    std::uint64_t number_{0U};  ///< number of the last message
};

/// Reads messages. For any content of the memory, each call accesses only the memory and ends in bounded
/// time. An inconsistent message is rejected. A consistent message with wrong content can only be detected by
/// end-to-end protection.
///
/// Thread safety: one context per reader; several readers can use one memory.
/// Time: take() is O(capacity), kTries times at most, without a system call. Memory: none of its own.
class FrameReader final {
  public:
    static constexpr int kTries = 3;

    FrameReader() noexcept = default;
    FrameReader(const FrameReader&) = delete;
    FrameReader& operator=(const FrameReader&) = delete;

    /// @param[in] region   read-only; must outlive the reader. @param[in] capacity as for the writer.
    /// @return kOk; kBadParameter (as FrameWriter::open()).
    Status open(Span<const std::byte> region, std::size_t capacity) noexcept;

    /// Reads the newest message, unless it is the message of the last kNew or kMalformed. Messages in between
    /// are lost; the difference of the numbers gives their count.
    /// @param[out] content buffer of at least get_capacity() bytes (a smaller one is a contract violation).
    ///             Its first facts.length bytes are valid on kNew, none on other outcomes.
    /// @param[out] facts   written on kNew only.
    /// @return outcome; kNothingNew also while not open.
    FrameOutcome take(Span<std::byte> content, FrameFacts& facts) noexcept;

    /// Longest content [byte]; 0 while not open.
    std::size_t get_capacity() const noexcept { return capacity_; }

  private:
    FrameOutcome copy(std::uint64_t number, Span<std::byte> content, FrameFacts& facts) const noexcept;

    const detail::FrameWord* words_{nullptr};
    std::size_t capacity_{0U};
    std::uint64_t number_{0U};  ///< number of the last message read
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_SHARED_FRAME_HPP
