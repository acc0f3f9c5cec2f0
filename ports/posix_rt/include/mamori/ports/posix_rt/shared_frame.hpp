// SPDX-License-Identifier: Apache-2.0
/// @file
/// One-way transport of bounded frames through memory that two processes share. One writes and takes no
/// notice of the reader; the other reads, only reads, and believes nothing of what it finds there.
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
/// Unit of the shared memory; processes agree on it, so it has one size on every machine.
using FrameWord = std::uint64_t;
static_assert(__atomic_always_lock_free(sizeof(FrameWord), nullptr),
              "processes share words without a lock, so this machine must load and store one at once");

inline constexpr std::size_t kFrameSlots{4U};
/// Number, instant and length of a frame.
inline constexpr std::size_t kFrameHeadWords{3U};

constexpr std::size_t calc_slot_words(std::size_t capacity) noexcept {
    return kFrameHeadWords + (capacity + sizeof(FrameWord) - 1U) / sizeof(FrameWord);
}
}  // namespace detail

/// Largest capacity of a frame [byte].
inline constexpr std::size_t kFrameCapacityMax{1U << 20U};

/// Size of the memory for frames of up to `capacity` bytes [byte]. @param[in] capacity 1 ..
/// kFrameCapacityMax.
constexpr std::size_t calc_frame_region_size(std::size_t capacity) noexcept {
    return sizeof(detail::FrameWord) * (1U + detail::kFrameSlots * detail::calc_slot_words(capacity));
}

/// What a frame says about itself. A reader has it from the other process: it is a claim.
struct FrameFacts {
    std::uint64_t number{0U};  ///< counts the frames of the memory, from 1 on; after the largest comes 1
    Instant published_at{};    ///< of the content, on the time line that the processes share
    std::size_t length{0U};    ///< of the content [byte], never more than the capacity
};

/// Outcome of looking for a frame.
enum class FrameOutcome : std::uint32_t {
    kNothingNew,  ///< none was written since the last one, or ever
    kNew,         ///< a frame
    kTorn,        ///< the writer was at work in each try, or the memory contradicts itself
    kMalformed,   ///< a frame that cannot be one: longer than the capacity, or not what its receiver expects
};

/// Writes frames. A frame that is cut off in the middle, with its process or by a stop, is never seen.
///
/// Thread safety: one context of one process writes to a memory.
/// Time: write() is wait-free, O(length), without a system call. Memory: none of its own.
class FrameWriter final {
  public:
    FrameWriter() noexcept = default;
    FrameWriter(const FrameWriter&) = delete;
    FrameWriter& operator=(const FrameWriter&) = delete;

    /// Goes on behind the last frame that is there, so that a reader takes the next one for new.
    /// @param[in] region   zeros, or what an earlier writer left; must outlive the writer.
    /// @param[in] capacity longest content [byte], 1 .. kFrameCapacityMax; the reader's is the same.
    /// @return kOk; kBadParameter (capacity, or a region that is too small or not at a multiple of 8).
    Status open(Span<std::byte> region, std::size_t capacity) noexcept;

    /// Makes `content` the frame that the reader finds. @param[in] published_at see FrameFacts.
    /// @return kOk; kBadParameter (longer than the capacity); kPreconditionNotMet (not open).
    Status write(Span<const std::byte> content, Instant published_at) noexcept;

    /// Longest content [byte]; 0 while not open.
    std::size_t get_capacity() const noexcept { return capacity_; }

  private:
    detail::FrameWord* words_{nullptr};
    std::size_t capacity_{0U};
    std::uint64_t number_{0U};  ///< of the last frame
};

/// Looks for frames. Whatever the other process does to the memory, no byte outside of it is touched and each
/// call ends in bounded time. A frame that is inconsistent is refused; one that is consistent and wrong can
/// only be told by its content: end-to-end protection belongs there.
///
/// Thread safety: one context; any number of readers may look at one memory.
/// Time: take() is O(capacity), kTries times at most, without a system call. Memory: none of its own.
class FrameReader final {
  public:
    static constexpr int kTries = 3;

    FrameReader() noexcept = default;
    FrameReader(const FrameReader&) = delete;
    FrameReader& operator=(const FrameReader&) = delete;

    /// @param[in] region   is only read; must outlive the reader. @param[in] capacity as the writer's.
    /// @return kOk; kBadParameter (as FrameWriter::open()).
    Status open(Span<const std::byte> region, std::size_t capacity) noexcept;

    /// The newest frame, when it is not the one of the last call that said kNew or kMalformed. Frames in
    /// between are lost: their number tells how many.
    /// @param[out] content room for a frame, get_capacity() bytes or more (fewer is an own bug); its first
    ///             facts.length bytes count on kNew and nothing on anything else.
    /// @param[out] facts   written on kNew only.
    /// @return kNothingNew also while not open.
    FrameOutcome take(Span<std::byte> content, FrameFacts& facts) noexcept;

    /// Longest content [byte]; 0 while not open.
    std::size_t get_capacity() const noexcept { return capacity_; }

  private:
    FrameOutcome copy(std::uint64_t number, Span<std::byte> content, FrameFacts& facts) const noexcept;

    const detail::FrameWord* words_{nullptr};
    std::size_t capacity_{0U};
    std::uint64_t number_{0U};  ///< of the last frame that was taken
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_SHARED_FRAME_HPP
