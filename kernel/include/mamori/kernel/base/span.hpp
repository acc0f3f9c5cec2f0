// SPDX-License-Identifier: Apache-2.0
/// @file
/// A view of contiguous elements with checked access. The elements have another owner.
///
/// @satisfies SWR-KRN-002      Design: docs/design/kernel.md#memory
#ifndef MAMORI_KERNEL_SPAN_HPP
#define MAMORI_KERNEL_SPAN_HPP

#include <array>
#include <cstddef>
#include <type_traits>

#include "mamori/kernel/base/assert.hpp"

namespace mamori {

namespace detail {
// One copy for all spans and uses: an access contains only the call. Cold: not expected, so out of the way.
[[noreturn, gnu::noinline, gnu::cold]] inline void fail_index() noexcept {
    MAMORI_FAIL_ASSERTION(1, "index < size_");
}
[[noreturn, gnu::noinline, gnu::cold]] inline void fail_range() noexcept {
    MAMORI_FAIL_ASSERTION(2, "first <= size_ && count <= size_ - first");
}
}  // namespace detail

/// Pointer and size. The owner of the elements must outlive every copy of the span.
/// An array of U converts only when U has the layout of T. An array of a derived class does not convert.
///
/// Thread safety: as that of the elements. Time: O(1). Memory: two words.
template <typename T>
class Span final {
    template <typename U>
    using EnableFor = std::enable_if_t<std::is_convertible_v<U (*)[], T (*)[]>>;

  public:
    constexpr Span() noexcept = default;
    /// @param[in] first may be nullptr only when `size` is 0. @param[in] size number of elements.
    constexpr Span(T* first, std::size_t size) noexcept : data_(first), size_(size) {}
    template <typename U, std::size_t N, typename = EnableFor<U>>
    constexpr Span(std::array<U, N>& elements) noexcept  // NOLINT: implicit on purpose
        : data_(elements.data()), size_(N) {}
    template <typename U, std::size_t N, typename = EnableFor<const U>>
    constexpr Span(const std::array<U, N>& elements) noexcept  // NOLINT: implicit on purpose
        : data_(elements.data()), size_(N) {}

    /// @param[in] index 0 .. size() - 1; otherwise a contract violation, which calls the assertion handler.
    constexpr T& operator[](std::size_t index) const noexcept {
        if (index >= size_) {
            detail::fail_index();
        }
        return data_[index];
    }
    /// `count` elements from `first` on. A range that exceeds this span is a contract violation.
    constexpr Span subspan(std::size_t first, std::size_t count) const noexcept {
        if (first > size_ || count > size_ - first) {
            detail::fail_range();
        }
        return {data_ + first, count};
    }
    constexpr std::size_t size() const noexcept { return size_; }
    constexpr bool empty() const noexcept { return size_ == 0U; }
    /// First element; nullptr for a default-constructed span.
    constexpr T* data() const noexcept { return data_; }
    constexpr T* begin() const noexcept { return data_; }
    constexpr T* end() const noexcept { return data_ + size_; }

  private:
    T* data_{nullptr};
    std::size_t size_{0U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_SPAN_HPP
