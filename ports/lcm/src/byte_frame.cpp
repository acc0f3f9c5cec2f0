// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/lcm/byte_frame.hpp"

#include "mamori/kernel/base/crc32.hpp"

namespace mamori::ports::lcm {

namespace {

constexpr unsigned kFullCode = 0xFFU;

std::uint32_t calc_checksum(Span<const std::byte> message) noexcept {
    Crc32 crc;
    for (const std::byte octet : message) {
        crc.add(std::to_integer<std::uint8_t>(octet));
    }
    return crc.get_value();
}

/// Octet `index` of the checksum, the most significant first.
std::byte get_checksum_octet(std::uint32_t checksum, std::size_t index) noexcept {
    return static_cast<std::byte>(checksum >> (8U * (kFrameChecksumSize - 1U - index)));
}

/// Writes blocks: a code octet, 1 more than the octets up to the next zero, then these octets.
class BlockWriter final {
  public:
    explicit BlockWriter(Span<std::byte> frame) noexcept : frame_(frame) {}

    void add(std::byte octet) noexcept {
        if (octet != std::byte{0U}) {
            frame_[next_] = octet;
            ++next_;
            ++code_;
        }
        if (octet == std::byte{0U} || code_ == kFullCode) {
            end_block();
        }
    }
    void end_block() noexcept {
        frame_[code_at_] = static_cast<std::byte>(code_);
        code_at_ = next_;
        ++next_;
        code_ = 1U;
    }
    /// The delimiter takes the place of the code octet that would follow.
    std::size_t finish() noexcept {
        end_block();
        frame_[code_at_] = std::byte{0U};
        return next_;
    }

  private:
    Span<std::byte> frame_;
    std::size_t code_at_{1U};  ///< after the delimiter that begins the frame
    std::size_t next_{2U};
    unsigned code_{1U};
};

}  // namespace

Result<std::size_t> encode_frame(Span<const std::byte> message, Span<std::byte> frame) noexcept {
    if (frame.size() < calc_frame_size_max(message.size())) {
        return Status::kOutOfResources;
    }
    const std::uint32_t checksum = calc_checksum(message);
    frame[0U] = std::byte{0U};
    BlockWriter blocks(frame);
    for (const std::byte octet : message) {
        blocks.add(octet);
    }
    for (std::size_t i = 0U; i < kFrameChecksumSize; ++i) {
        blocks.add(get_checksum_octet(checksum, i));
    }
    return blocks.finish();
}

FrameEvent FrameDecoder::push(std::byte octet) noexcept {
    if (octet == std::byte{0U}) {
        const FrameEvent event = finish();
        const std::size_t message_size = event == FrameEvent::kMessage ? size_ - kFrameChecksumSize : 0U;
        reset();
        message_size_ = message_size;
        return event;
    }
    if (left_ > 0U) {
        append(octet);
        --left_;
        return FrameEvent::kNone;
    }
    if (has_begun_ && !is_full_block_) {
        append(std::byte{0U});
    }
    const unsigned code = std::to_integer<unsigned>(octet);
    left_ = code - 1U;
    is_full_block_ = code == kFullCode;
    has_begun_ = true;
    return FrameEvent::kNone;
}

void FrameDecoder::reset() noexcept {
    size_ = 0U;
    message_size_ = 0U;
    left_ = 0U;
    has_begun_ = false;
    is_oversized_ = false;
}

FrameEvent FrameDecoder::finish() const noexcept {
    if (!has_begun_) {
        return FrameEvent::kNone;  // the delimiters of two frames follow one another
    }
    if (is_oversized_) {
        return FrameEvent::kOversized;
    }
    if (left_ > 0U || size_ < kFrameChecksumSize) {
        return FrameEvent::kMalformed;
    }
    const std::size_t message_size = size_ - kFrameChecksumSize;
    const std::uint32_t checksum = calc_checksum({buffer_.data(), message_size});
    for (std::size_t i = 0U; i < kFrameChecksumSize; ++i) {
        if (buffer_[message_size + i] != get_checksum_octet(checksum, i)) {
            return FrameEvent::kChecksum;
        }
    }
    return FrameEvent::kMessage;
}

void FrameDecoder::append(std::byte octet) noexcept {
    if (size_ == buffer_.size()) {
        is_oversized_ = true;
        return;
    }
    buffer_[size_] = octet;
    ++size_;
}

}  // namespace mamori::ports::lcm
