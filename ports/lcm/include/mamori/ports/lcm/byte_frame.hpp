// SPDX-License-Identifier: Apache-2.0
/// @file
/// Messages in a stream of octets, for serial lines and UDP: COBS(message and CRC-32) between two zero
/// octets. COBS leaves no zero inside, so a receiver finds the next frame after any damage.
///
/// @satisfies SWR-LCM-009      Design: docs/design/lcm.md#frames
/// Source:   S. Cheshire, M. Baker, "Consistent Overhead Byte Stuffing", IEEE/ACM Trans. Networking 7(2),
/// 1999
#ifndef MAMORI_PORTS_LCM_BYTE_FRAME_HPP
#define MAMORI_PORTS_LCM_BYTE_FRAME_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"

namespace mamori::ports::lcm {

inline constexpr std::size_t kFrameChecksumSize = 4U;

/// Longest frame of a message [byte]: two delimiters, the checksum, and one octet per 254 octets begun.
constexpr std::size_t calc_frame_size_max(std::size_t message_size) noexcept {
    const std::size_t content = message_size + kFrameChecksumSize;
    return 2U + content + content / 254U + 1U;
}

/// Writes the frame of `message`. O(size), no memory. @param[out] frame must not overlap `message`.
/// @return octets written; kOutOfResources (fewer than calc_frame_size_max() octets; `frame` is unchanged).
Result<std::size_t> encode_frame(Span<const std::byte> message, Span<std::byte> frame) noexcept;

/// What one octet of a stream completed.
enum class FrameEvent : std::uint8_t {
    kNone,       ///< no frame is complete
    kMessage,    ///< a message with the right checksum
    kMalformed,  ///< a frame that ended too early, or without a checksum
    kChecksum,   ///< a frame with a wrong checksum
    kOversized,  ///< a frame that does not fit into the buffer
};

/// Finds the frames in a stream of any octets. After any damage, the next undamaged frame is found.
///
/// Thread safety: none. Time: O(1) per octet; the octet that ends a frame O(size of the frame).
/// Memory: the buffer.
class FrameDecoder final {
  public:
    /// @param[in] buffer for the longest message and kFrameChecksumSize octets; must outlive this object.
    explicit FrameDecoder(Span<std::byte> buffer) noexcept : buffer_(buffer) {}

    /// Takes the next octet of the stream.
    FrameEvent push(std::byte octet) noexcept;
    /// Drops the begun frame and the last message, for a new stream.
    void reset() noexcept;
    /// The message of the last kMessage; valid until the next push().
    Span<const std::byte> get_message() const noexcept { return {buffer_.data(), message_size_}; }

  private:
    FrameEvent finish() const noexcept;
    void append(std::byte octet) noexcept;

    Span<std::byte> buffer_;
    std::size_t size_{0U};          ///< decoded octets of the frame
    std::size_t message_size_{0U};  ///< of the last message
    std::size_t left_{0U};          ///< octets until the next code octet
    bool has_begun_{false};         ///< a code octet came since the last delimiter
    bool is_full_block_{false};     ///< the block has 254 octets, so no zero follows it
    bool is_oversized_{false};
};

}  // namespace mamori::ports::lcm

#endif  // MAMORI_PORTS_LCM_BYTE_FRAME_HPP
