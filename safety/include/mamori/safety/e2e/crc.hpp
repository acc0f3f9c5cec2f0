// SPDX-License-Identifier: Apache-2.0
/// @file
/// Cyclic redundancy checks of any width, several bytes at a time: one engine over the parameters of a
/// catalogue. A checksum depends on the bytes only, never on the pieces in which they come.
///
/// @satisfies SWR-E2E-001, SWR-E2E-002      Design: docs/design/e2e.md#checksums
/// Source:   AUTOSAR SWS CRC Library (start values and continued calls); slicing: Kounavis and Berry, 2005
#ifndef MAMORI_SAFETY_E2E_CRC_HPP
#define MAMORI_SAFETY_E2E_CRC_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "mamori/kernel/base/span.hpp"

namespace mamori::safety {

/// What makes a checksum. Word: unsigned, exactly as wide as the checksum.
template <typename Word>
struct CrcParameters {
    Word polynomial{0U};       ///< highest power left out, most significant bit first, whatever is reflected
    Word initial{0U};          ///< register before the first byte
    bool is_reflected{false};  ///< bytes go in, and the result comes out, lowest bit first
    Word final_xor{0U};        ///< turned in the result
};

namespace detail {

template <typename Word>
constexpr Word reflect(Word value) noexcept {
    constexpr int kBits = std::numeric_limits<Word>::digits;
    const std::uint64_t bits = value;
    std::uint64_t result = 0U;
    for (int bit = 0; bit < kBits; ++bit) {
        result = (result << 1U) | ((bits >> bit) & 1U);
    }
    return static_cast<Word>(result);
}

/// Remainder of the lowest `bits` bits of `value` in an empty register.
template <typename Word>
constexpr Word calc_crc_entry(const CrcParameters<Word>& crc, std::uint8_t value, int bits = 8) noexcept {
    constexpr int kTop = std::numeric_limits<Word>::digits - 1;
    Word rest = static_cast<Word>(crc.is_reflected ? Word{value}
                                                   : static_cast<Word>(Word{value} << (kTop + 1 - bits)));
    const Word turned = reflect(crc.polynomial);
    for (int bit = 0; bit < bits; ++bit) {
        if (crc.is_reflected) {
            const Word feedback = (rest & 1U) != 0U ? turned : Word{0U};
            rest = static_cast<Word>((rest >> 1U) ^ feedback);
        } else {
            const Word feedback = ((rest >> kTop) & 1U) != 0U ? crc.polynomial : Word{0U};
            rest = static_cast<Word>((rest << 1U) ^ feedback);
        }
    }
    return rest;
}

template <typename Word, std::size_t kSlices>
using CrcTables = std::array<std::array<Word, 256U>, kSlices>;

/// Table k: the remainder of each byte value with k zero bytes behind it.
template <typename Word, std::size_t kSlices>
constexpr CrcTables<Word, kSlices> make_crc_tables(const CrcParameters<Word>& crc) noexcept {
    constexpr int kTopByte = std::numeric_limits<Word>::digits - 8;
    CrcTables<Word, kSlices> tables{};
    for (std::size_t value = 0U; value < 256U; ++value) {
        tables[0][value] = calc_crc_entry(crc, static_cast<std::uint8_t>(value));
    }
    for (std::size_t k = 1U; k < kSlices; ++k) {
        for (std::size_t value = 0U; value < 256U; ++value) {
            const Word before = tables[k - 1U][value];
            const auto out = static_cast<std::uint8_t>(crc.is_reflected ? before : before >> kTopByte);
            // One-byte words have nothing left to shift; 64-bit arithmetic keeps that defined.
            const std::uint64_t rest =
                crc.is_reflected ? std::uint64_t{before} >> 8U : std::uint64_t{before} << 8U;
            tables[k][value] = static_cast<Word>(static_cast<Word>(rest) ^ tables[0][out]);
        }
    }
    return tables;
}

/// The remainder of each value of four bits.
template <typename Word>
constexpr std::array<Word, 16U> make_half_byte_table(const CrcParameters<Word>& crc) noexcept {
    std::array<Word, 16U> table{};
    for (std::size_t value = 0U; value < 16U; ++value) {
        table[value] = calc_crc_entry(crc, static_cast<std::uint8_t>(value), 4);
    }
    return table;
}

/// What kSlices tables, or the table of half bytes for kSlices = 0, are made of.
template <const auto& kCrc, std::size_t kSlices>
constexpr auto make_constants() noexcept {
    using Word = std::remove_const_t<decltype(kCrc.polynomial)>;
    if constexpr (kSlices == 0U) {
        return make_half_byte_table<Word>(kCrc);
    } else {
        return make_crc_tables<Word, kSlices>(kCrc);
    }
}

template <const auto& kCrc, std::size_t kSlices>
inline constexpr auto kCrcTables = make_constants<kCrc, kSlices>();

}  // namespace detail

/// Checksum of the bytes that were added.
/// @tparam kCrc    CrcParameters of static storage duration.
/// @tparam kSlices bytes that one step takes, 0 .. 16. Each costs a table of 256 words; 8 is the fastest.
/// With 0, a step takes half a byte, and the table has 16 words.
///
/// Thread safety: none. Time: O(1) per byte. Memory: one word, and the tables, which are constants.
template <const auto& kCrc, std::size_t kSlices = 8U>
class Crc final {
    static_assert(kSlices <= 16U, "kSlices is 0 .. 16");

  public:
    using Word = std::remove_const_t<decltype(kCrc.polynomial)>;

    constexpr Crc() noexcept : register_(kCrc.is_reflected ? detail::reflect(kCrc.initial) : kCrc.initial) {}

    /// Goes on where a checksum ended. @param[in] value what get_value() gave for the bytes before.
    explicit constexpr Crc(Word value) noexcept : register_(static_cast<Word>(value ^ kCrc.final_xor)) {}

    constexpr void add(std::byte byte) noexcept {
        if constexpr (kSlices == 0U) {
            add_half_byte(std::to_integer<unsigned>(byte) >> (kCrc.is_reflected ? 0U : 4U));
            add_half_byte(std::to_integer<unsigned>(byte) >> (kCrc.is_reflected ? 4U : 0U));
        } else {
            add_byte(byte);
        }
    }
    /// @param[in] bytes any number.
    [[gnu::always_inline]] constexpr void add(Span<const std::byte> bytes) noexcept {
        const std::byte* const data = bytes.data();
        std::size_t done = 0U;
        if constexpr (kSlices != 0U) {
            const std::size_t blocks = bytes.size() / kSlices;
            for (std::size_t block = 0U; block < blocks; ++block) {
                register_ = step(register_, data + block * kSlices, std::make_index_sequence<kSlices>{});
            }
            done = blocks * kSlices;
            // Half a block is the rest of most messages: their fields have four bytes.
            using Half = std::make_index_sequence<(kSlices + 1U) / 2U>;
            if (bytes.size() - done >= Half::size()) {
                register_ = step(register_, data + done, Half{});
                done += Half::size();
            }
        }
        add_each(data + done, bytes.size() - done);
    }
    /// @param[in] count how many bytes like `byte`.
    constexpr void add_repeated(std::byte byte, std::size_t count) noexcept {
        for (std::size_t i = 0U; i < count; ++i) {
            add(byte);
        }
    }
    constexpr Word get_value() const noexcept { return static_cast<Word>(register_ ^ kCrc.final_xor); }

  private:
    constexpr void add_each(const std::byte* data, std::size_t size) noexcept {
        for (std::size_t i = 0U; i < size; ++i) {
            add(data[i]);
        }
    }
    /// @param[in] bits four, and any bits above them.
    constexpr void add_half_byte(unsigned bits) noexcept {
        constexpr unsigned kTop = std::numeric_limits<Word>::digits - 4U;
        if constexpr (kCrc.is_reflected) {
            register_ = static_cast<Word>((register_ >> 4U) ^ kTables[(register_ ^ bits) & 0xFU]);
        } else {
            const auto lead = static_cast<unsigned>(register_ >> kTop);
            register_ = static_cast<Word>(static_cast<Word>(register_ << 4U) ^ kTables[(lead ^ bits) & 0xFU]);
        }
    }
    constexpr void add_byte(std::byte byte) noexcept {
        const auto lead = static_cast<Word>(register_ ^ load(&byte, std::make_index_sequence<1U>{}));
        register_ = static_cast<Word>(shift<1U>(register_) ^ kTables[0][get_index<0U>(lead, &byte)]);
    }

    static constexpr const auto& kTables = detail::kCrcTables<kCrc, kSlices>;
    static constexpr std::size_t kBytes = sizeof(Word);
    /// Where the byte `kPlace` of the register lies in it, the one that meets the next byte first.
    template <std::size_t kPlace>
    static constexpr std::size_t kShift = 8U * (kCrc.is_reflected ? kPlace : kBytes - 1U - kPlace);

    /// The register without its first `kCount` bytes.
    template <std::size_t kCount>
    static constexpr Word shift(Word value) noexcept {
        if constexpr (kCount >= kBytes) {
            return Word{0U};
        } else if constexpr (kCrc.is_reflected) {
            return static_cast<Word>(value >> (8U * kCount));
        } else {
            return static_cast<Word>(value << (8U * kCount));
        }
    }
    /// First bytes of a block, as they lie in the register. Compilers make one load of it.
    template <std::size_t... kIndex>
    static constexpr Word load(const std::byte* block, std::index_sequence<kIndex...> /*bytes*/) noexcept {
        return static_cast<Word>((... | (std::to_integer<std::uint64_t>(block[kIndex]) << kShift<kIndex>)));
    }
    /// Index of the byte at `kPlace` of a block into its table. @param[in] lead register and first bytes
    /// together.
    template <std::size_t kPlace>
    static constexpr std::size_t get_index(Word lead, const std::byte* block) noexcept {
        if constexpr (kPlace >= kBytes) {
            return std::to_integer<std::size_t>(block[kPlace]);
        } else {
            return static_cast<std::size_t>(lead >> kShift<kPlace>) & 0xFFU;
        }
    }
    /// Spelled out rather than looped over, so that every shift and table is a constant of the code.
    template <std::size_t... kPlace>
    static constexpr Word step(Word value, const std::byte* block,
                               std::index_sequence<kPlace...> /*block*/) noexcept {
        constexpr std::size_t kCount = sizeof...(kPlace);
        constexpr std::size_t kLead = kCount < kBytes ? kCount : kBytes;
        const auto lead = static_cast<Word>(value ^ load(block, std::make_index_sequence<kLead>{}));
        return static_cast<Word>(
            (shift<kCount>(value) ^ ... ^ kTables[kCount - 1U - kPlace][get_index<kPlace>(lead, block)]));
    }

    Word register_;
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_CRC_HPP
