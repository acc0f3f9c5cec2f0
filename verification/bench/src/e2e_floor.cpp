// SPDX-License-Identifier: Apache-2.0
/// @file
/// Lower bounds of the end-to-end protection cases, written by hand around the checksum of Mamori: the whole
/// exchange; a message of profile 4 that is protected and checked in place, without ports; and the two
/// checksums alone.
///
/// @satisfies SWR-BEN-010      Design: docs/design/bench.md#method
#include <cstring>

#include "catalogue.hpp"
#include "hand_written_e2e.hpp"
#include "mamori/safety/e2e/crc_catalogue.hpp"

namespace mamori::verification::bench {
namespace {

std::uint32_t calc_checksum(const std::byte* first, std::size_t first_size, const std::byte* second,
                            std::size_t second_size) noexcept {
    safety::Crc<safety::kCrc32P4> crc;
    crc.add({first, first_size});
    crc.add({second, second_size});
    return crc.get_value();
}

/// Header of profile 4 with the constant fields in place.
constexpr std::uint64_t kDataId = 0x0A0B0C0DU;
constexpr std::size_t kHeaderSize = 12U;
constexpr std::size_t kCrcAt = 8U;

template <std::size_t kSize>
class CrcFrame final : public Subject {
  public:
    CrcFrame() noexcept { frames_[1][kHeaderSize] = std::byte{1U}; }

    std::uint64_t run(std::uint64_t count) override {
        std::uint64_t sum = 0U;
        for (std::uint64_t i = 0U; i < count; ++i) {
            Frame& frame = frames_[i & 1U];
            protect(frame);
            touch(frame);
            sum += check(frame) ? std::to_integer<std::uint64_t>(frame[kHeaderSize]) : 0U;
        }
        return sum;
    }

  private:
    using Frame = std::array<std::byte, kHeaderSize + kSize>;

    static std::uint32_t calc(const Frame& frame) noexcept {
        return calc_checksum(frame.data(), kCrcAt, frame.data() + kHeaderSize, kSize);
    }
    void protect(Frame& frame) noexcept {
        const std::uint64_t fields =
            std::uint64_t{sizeof(Frame)} << 48U | std::uint64_t{sent_} << 32U | kDataId;
        const std::uint64_t head = __builtin_bswap64(fields);
        std::memcpy(frame.data(), &head, sizeof(head));
        const std::uint32_t checksum = __builtin_bswap32(calc(frame));
        std::memcpy(frame.data() + kCrcAt, &checksum, sizeof(checksum));
        ++sent_;
    }
    bool check(const Frame& frame) noexcept {
        std::uint64_t head = 0U;
        std::memcpy(&head, frame.data(), sizeof(head));
        std::uint32_t checksum = 0U;
        std::memcpy(&checksum, frame.data() + kCrcAt, sizeof(checksum));
        const std::uint64_t fields = __builtin_bswap64(head);
        const auto counter = static_cast<std::uint16_t>(fields >> 32U);
        const bool is_next = counter == static_cast<std::uint16_t>(last_ + 1U);
        last_ = counter;
        return __builtin_bswap32(checksum) == calc(frame) && fields >> 48U == sizeof(Frame) &&
               (fields & 0xFFFFFFFFU) == kDataId && is_next;
    }

    std::array<Frame, 2> frames_{};
    std::uint16_t sent_{0U};
    std::uint16_t last_{0xFFFFU};
};

/// The same job as the protected port of Mamori.
template <std::size_t kSize>
class HandWrittenExchange final : public Subject {
  public:
    HandWrittenExchange() noexcept {
        const Message<kSize> nothing{};
        for (int i = 0; i < 8; ++i) {
            exchange(nothing);
        }
    }

    std::uint64_t run(std::uint64_t count) override {
        std::uint64_t sum = 0U;
        for (std::uint64_t i = 0U; i < count; ++i) {
            sum += exchange(values_[i])[0];
        }
        return sum;
    }

  private:
    const Message<kSize>& exchange(const Message<kSize>& value) noexcept {
        now_ = now_ + Duration{1};
        sender_.write(value);
        sender_.publish(now_);
        touch(sender_);
        receiver_.take(sender_.get_published(), sender_.get_published_count(), sender_.get_published_at());
        touch(receiver_);
        return receiver_.read(now_);
    }

    WrittenValues<kSize> values_;
    HandWrittenSender<kSize> sender_;
    HandWrittenReceiver<kSize> receiver_;
    Instant now_{};
};

/// Over the bytes that profile 4 covers.
template <std::size_t kSize>
class CrcTwice final : public Subject {
  public:
    std::uint64_t run(std::uint64_t count) override {
        std::uint64_t sum = 0U;
        for (std::uint64_t i = 0U; i < count; ++i) {
            const Message<kSize + 8U>& value = values_[i];
            std::uint32_t sent = calc(value);
            touch(sent);
            sum += calc(value) == sent ? value[0] : 0U;
        }
        return sum;
    }

  private:
    static std::uint32_t calc(const Message<kSize + 8U>& value) noexcept {
        return calc_checksum(reinterpret_cast<const std::byte*>(value.data()), sizeof(value), nullptr, 0U);
    }

    WrittenValues<kSize + 8U> values_;
};

}  // namespace

void add_e2e_floors(std::vector<Case>& e2e) {
    add_to_e2e<HandWrittenExchange>(e2e, "hand-written exchange");
    add_to_e2e<CrcFrame>(e2e, "CRC-32 frame");
    add_to_e2e<CrcTwice>(e2e, "CRC-32 twice");
}

}  // namespace mamori::verification::bench
