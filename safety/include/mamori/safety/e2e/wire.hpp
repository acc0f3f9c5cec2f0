// SPDX-License-Identifier: Apache-2.0
/// @file
/// Numbers in a frame, most significant byte first unless the name says otherwise. Not for users.
///
/// @satisfies SWR-E2E-003      Design: docs/design/e2e.md#profiles
#ifndef MAMORI_SAFETY_E2E_WIRE_HPP
#define MAMORI_SAFETY_E2E_WIRE_HPP

#include <cstddef>
#include <cstdint>
#include <utility>

namespace mamori::safety::detail {

// Spelled out rather than looped over, so that compilers make one load or store of the bytes.
template <typename Word, std::size_t... kIndex>
constexpr void store_big(std::byte* target, Word value, std::index_sequence<kIndex...> /*bytes*/) noexcept {
    constexpr std::size_t kLast = sizeof(Word) - 1U;
    ((target[kLast - kIndex] = static_cast<std::byte>(std::uint64_t{value} >> (8U * kIndex))), ...);
}

template <typename Word, std::size_t... kIndex>
constexpr Word load_big(const std::byte* source, std::index_sequence<kIndex...> /*bytes*/) noexcept {
    constexpr std::size_t kLast = sizeof(Word) - 1U;
    return static_cast<Word>(
        (... | (std::to_integer<std::uint64_t>(source[kLast - kIndex]) << (8U * kIndex))));
}

/// Writes `value` to the sizeof(Word) bytes at `target`.
template <typename Word>
constexpr void store_big(std::byte* target, Word value) noexcept {
    store_big(target, value, std::make_index_sequence<sizeof(Word)>{});
}

/// @return the number in the sizeof(Word) bytes at `source`.
template <typename Word>
constexpr Word load_big(const std::byte* source) noexcept {
    return load_big<Word>(source, std::make_index_sequence<sizeof(Word)>{});
}

/// Byte `place` of `value`, 0 is the least significant.
template <typename Word>
constexpr std::byte get_byte(Word value, unsigned place) noexcept {
    return static_cast<std::byte>(std::uint64_t{value} >> (8U * place));
}

}  // namespace mamori::safety::detail

#endif  // MAMORI_SAFETY_E2E_WIRE_HPP
