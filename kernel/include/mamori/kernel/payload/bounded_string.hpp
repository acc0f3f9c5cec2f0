// SPDX-License-Identifier: Apache-2.0
/// @file
/// A string of up to N characters inside its owner: the bounded form of an IDL `string`.
///
/// @satisfies SWR-CDR-003      Design: docs/design/data_flow.md#bounded-types
#ifndef MAMORI_KERNEL_BOUNDED_STRING_HPP
#define MAMORI_KERNEL_BOUNDED_STRING_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"

namespace mamori {

/// Up to N characters and a terminating NUL. Characters are bytes without a defined character set; NUL is not
/// a character, as in IDL. Hashes, encodings and comparisons ignore the bytes after the terminating NUL.
///
/// Thread safety: none. Time: O(1); assign() and comparisons O(length), copies O(N). Memory: N + 1 characters
/// and a count, no heap. @tparam N 1 .. 2^32 - 2.
template <std::size_t N>
class BoundedString final {
    static_assert(N >= 1U, "a text of nothing needs no string");
    static_assert(N < std::numeric_limits<std::uint32_t>::max(), "the length on the wire has 32 bits");

  public:
    constexpr BoundedString() noexcept = default;
    /// The characters of a literal up to its first NUL, as in `message.data = "ready"`. An array that does
    /// not end with NUL is a contract violation.
    template <std::size_t M>
    constexpr BoundedString(const char (&literal)[M]) noexcept {  // NOLINT: implicit on purpose
        static_assert(M <= N + 1U, "the literal is longer than the string holds");
        MAMORI_REQUIRE(2, literal[M - 1U] == '\0');
        while (literal[size_] != '\0') {
            text_[size_] = literal[size_];
            ++size_;
        }
    }

    static constexpr std::size_t capacity() noexcept { return N; }
    /// Number of characters without the terminating NUL.
    constexpr std::size_t size() const noexcept { return size_; }
    constexpr bool empty() const noexcept { return size_ == 0U; }
    /// Terminated by NUL; valid until the string is changed. @return never nullptr.
    constexpr const char* c_str() const noexcept { return text_.data(); }
    constexpr const char* begin() const noexcept { return text_.data(); }
    constexpr const char* end() const noexcept { return text_.data() + size_; }
    /// @param[in] index 0 .. size() - 1; otherwise a contract violation, which calls the assertion handler.
    constexpr char operator[](std::size_t index) const noexcept {
        MAMORI_REQUIRE(1, index < size_);
        return text_[index];
    }

    /// Makes the string empty.
    constexpr void clear() noexcept {
        size_ = 0U;
        text_[0] = '\0';
    }
    /// Replaces the string. @param[in] characters without terminating NUL; may be a part of this string.
    /// @return kOk; kOutOfResources (more than N); kBadParameter (a NUL among them).
    constexpr Status assign(Span<const char> characters) noexcept {
        if (characters.size() > N) {
            return Status::kOutOfResources;
        }
        for (const char character : characters) {
            if (character == '\0') {
                return Status::kBadParameter;
            }
        }
        for (std::size_t i = 0U; i < characters.size(); ++i) {
            text_[i] = characters[i];
        }
        size_ = static_cast<std::uint32_t>(characters.size());
        text_[size_] = '\0';
        return Status::kOk;
    }
    /// Appends one character. @return kOk; kOutOfResources (full); kBadParameter (NUL).
    constexpr Status push_back(char character) noexcept {
        if (character == '\0') {
            return Status::kBadParameter;
        }
        if (size_ == N) {
            return Status::kOutOfResources;
        }
        text_[size_] = character;
        ++size_;
        text_[size_] = '\0';
        return Status::kOk;
    }

    friend constexpr bool operator==(const BoundedString& a, const BoundedString& b) noexcept {
        bool is_equal = a.size_ == b.size_;
        for (std::size_t i = 0U; is_equal && i < a.size_; ++i) {
            is_equal = a.text_[i] == b.text_[i];
        }
        return is_equal;
    }
    friend constexpr bool operator!=(const BoundedString& a, const BoundedString& b) noexcept {
        return !(a == b);
    }

  private:
    std::array<char, N + 1U> text_{};
    std::uint32_t size_{0U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_BOUNDED_STRING_HPP
