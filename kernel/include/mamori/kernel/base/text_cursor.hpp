// SPDX-License-Identifier: Apache-2.0
/// @file
/// Reads a short text character by character, in constant expressions as well as while running. It knows
/// characters, spaces and words; what they mean is decided by its users.
///
/// @satisfies SWR-PAR-001      Design: docs/design/parameters.md#grammar
#ifndef MAMORI_KERNEL_TEXT_CURSOR_HPP
#define MAMORI_KERNEL_TEXT_CURSOR_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"

namespace mamori {

/// Characters owned by somebody else, without a closing zero.
using Text = Span<const char>;

/// Text of a C string. O(length). @param[in] characters not nullptr; must outlive the text.
constexpr Text make_text(const char* characters) noexcept {
    std::size_t size = 0U;
    while (characters[size] != '\0') {
        ++size;
    }
    return {characters, size};
}

/// Are the characters the same? O(length).
constexpr bool operator==(Text a, Text b) noexcept {
    if (a.size() != b.size()) {
        return false;
    }
    for (std::size_t i = 0U; i < a.size(); ++i) {
        if (a[i] != b[i]) {
            return false;
        }
    }
    return true;
}

/// Place in a text. Never leaves it.
///
/// Thread safety: none. Time: O(1), words and spaces O(their length). Memory: refers to the text.
class TextCursor final {
  public:
    /// @param[in] text its characters must outlive the cursor.
    constexpr explicit TextCursor(Text text) noexcept : text_(text) {}

    /// Characters before the next one.
    constexpr std::size_t get_position() const noexcept { return position_; }
    constexpr bool is_at_end() const noexcept { return position_ == text_.size(); }
    /// True when the next character is `character`; false at the end.
    constexpr bool is_at(char character) const noexcept {
        return !is_at_end() && text_[position_] == character;
    }
    constexpr bool is_at_digit() const noexcept {
        return !is_at_end() && text_[position_] >= '0' && text_[position_] <= '9';
    }
    /// Value 0 .. 9 of the digit here, which is taken. is_at_digit() is the caller's duty; at the end the
    /// call is an own bug.
    constexpr std::uint32_t take_digit() noexcept {
        const char character = text_[position_];
        ++position_;
        return static_cast<std::uint32_t>(character - '0');
    }
    /// Takes the next character when it is `character`. @return whether it was.
    constexpr bool take(char character) noexcept {
        const bool is_here = is_at(character);
        position_ += is_here ? 1U : 0U;
        return is_here;
    }
    /// Takes blanks and tabs.
    constexpr void skip_spaces() noexcept {
        while (is_at(' ') || is_at('\t')) {
            ++position_;
        }
    }
    /// Takes letters (a .. z, A .. Z), digits and underscores; empty when there is none here. Refers to the
    /// text.
    constexpr Text take_word() noexcept {
        const std::size_t first = position_;
        while (!is_at_end() && is_word_character(text_[position_])) {
            ++position_;
        }
        return text_.subspan(first, position_ - first);
    }

  private:
    static constexpr bool is_word_character(char character) noexcept {
        return (character >= '0' && character <= '9') || (character >= 'a' && character <= 'z') ||
               (character >= 'A' && character <= 'Z') || character == '_';
    }

    Text text_;
    std::size_t position_{0U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_TEXT_CURSOR_HPP
