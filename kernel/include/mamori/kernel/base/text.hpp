// SPDX-License-Identifier: Apache-2.0
/// @file
/// Character strings with a length: construction and comparison, in constant expressions and at run time.
///
/// @satisfies SWR-PAR-006, SWR-PAR-021      Design: docs/design/parameters.md#configuration-sets
#ifndef MAMORI_KERNEL_TEXT_HPP
#define MAMORI_KERNEL_TEXT_HPP

#include <cstddef>

#include "mamori/kernel/base/span.hpp"

namespace mamori {

/// Characters without terminating NUL. The owner of the characters must outlive the text.
using Text = Span<const char>;

/// Text of a C string. O(length). @param[in] characters NUL-terminated, not nullptr; must outlive the text.
constexpr Text make_text(const char* characters) noexcept {
    std::size_t size = 0U;
    while (characters[size] != '\0') {
        ++size;
    }
    return {characters, size};
}

/// True when the lengths and all characters are equal. O(length).
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

/// Whether a C string is a name: not nullptr and not empty.
constexpr bool is_name(const char* characters) noexcept {
    return characters != nullptr && characters[0] != '\0';
}

namespace detail {
/// Whether two C strings are equal; neither is nullptr. O(length).
constexpr bool is_same_text(const char* a, const char* b) noexcept {
    std::size_t i = 0U;
    while (a[i] != '\0' && a[i] == b[i]) {
        ++i;
    }
    return a[i] == b[i];
}
}  // namespace detail

/// Whether two C strings, which may be nullptr, are the same name. O(length).
constexpr bool is_same_name(const char* a, const char* b) noexcept {
    return is_name(a) && is_name(b) && detail::is_same_text(a, b);
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_TEXT_HPP
