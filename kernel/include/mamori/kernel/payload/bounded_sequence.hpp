// SPDX-License-Identifier: Apache-2.0
/// @file
/// A sequence of up to N elements inside its owner: the bounded form of an IDL `sequence<T>`.
///
/// @satisfies SWR-CDR-002      Design: docs/design/data_flow.md#bounded-types
#ifndef MAMORI_KERNEL_BOUNDED_SEQUENCE_HPP
#define MAMORI_KERNEL_BOUNDED_SEQUENCE_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"

namespace mamori {

/// Up to N elements of T, trivially copyable, so that ports can copy it as bytes. Only the first size()
/// elements are used: hashes, encodings and comparisons ignore the rest.
///
/// Thread safety: none. Time: O(1); copies, assign(), resize() and comparisons O(N). Memory: N elements and a
/// count, no heap. Pointers to elements are valid as long as the sequence. @tparam N 1 .. 2^32 - 1.
template <typename T, std::size_t N>
class BoundedSequence final {
    static_assert(std::is_trivially_copyable_v<T>, "the elements travel as bytes");
    static_assert(N >= 1U, "a sequence of nothing needs no sequence");
    static_assert(N <= std::numeric_limits<std::uint32_t>::max(), "the count on the wire has 32 bits");

  public:
    using value_type = T;

    constexpr BoundedSequence() noexcept = default;
    /// Elements of an array, M <= N (checked at compile time), as in `message.data = std::array{1.0, 2.0}`.
    template <std::size_t M>
    constexpr BoundedSequence(const std::array<T, M>& elements) noexcept  // NOLINT: implicit on purpose
        : size_(static_cast<std::uint32_t>(M)) {
        static_assert(M <= N, "more elements than the sequence holds");
        copy(Span<const T>(elements));
    }

    static constexpr std::size_t capacity() noexcept { return N; }
    constexpr std::size_t size() const noexcept { return size_; }
    constexpr bool empty() const noexcept { return size_ == 0U; }

    /// @param[in] index 0 .. size() - 1; otherwise a contract violation, which calls the assertion handler.
    constexpr T& operator[](std::size_t index) noexcept {
        MAMORI_REQUIRE(1, index < size_);
        return elements_[index];
    }
    constexpr const T& operator[](std::size_t index) const noexcept {
        MAMORI_REQUIRE(2, index < size_);
        return elements_[index];
    }
    /// All N elements, including the unused elements. @return never nullptr.
    constexpr T* data() noexcept { return elements_.data(); }
    constexpr const T* data() const noexcept { return elements_.data(); }
    constexpr T* begin() noexcept { return elements_.data(); }
    constexpr T* end() noexcept { return elements_.data() + size_; }
    constexpr const T* begin() const noexcept { return elements_.data(); }
    constexpr const T* end() const noexcept { return elements_.data() + size_; }

    constexpr void clear() noexcept { size_ = 0U; }
    /// Appends one element. @return kOk; kOutOfResources when the sequence is full.
    constexpr Status push_back(const T& element) noexcept {
        if (size_ == N) {
            return Status::kOutOfResources;
        }
        elements_[size_] = element;
        ++size_;
        return Status::kOk;
    }
    /// Sets the number of elements to `size`; added elements are value-initialised.
    /// @param[in] size 0 .. N. @return kOk; kOutOfResources when it is larger than N.
    constexpr Status resize(std::size_t size) noexcept {
        if (size > N) {
            return Status::kOutOfResources;
        }
        for (std::size_t i = size_; i < size; ++i) {
            elements_[i] = T{};
        }
        size_ = static_cast<std::uint32_t>(size);
        return Status::kOk;
    }
    /// Replaces all elements. @param[in] elements may be a part of this sequence.
    /// @return kOk; kOutOfResources when there are more than N.
    constexpr Status assign(Span<const T> elements) noexcept {
        if (elements.size() > N) {
            return Status::kOutOfResources;
        }
        copy(elements);
        size_ = static_cast<std::uint32_t>(elements.size());
        return Status::kOk;
    }

    friend constexpr bool operator==(const BoundedSequence& a, const BoundedSequence& b) noexcept {
        bool is_equal = a.size_ == b.size_;
        for (std::size_t i = 0U; is_equal && i < a.size_; ++i) {
            is_equal = a.elements_[i] == b.elements_[i];
        }
        return is_equal;
    }
    friend constexpr bool operator!=(const BoundedSequence& a, const BoundedSequence& b) noexcept {
        return !(a == b);
    }

  private:
    /// In ascending order, so that the source may be a part of this sequence: it never starts before the
    /// target.
    constexpr void copy(Span<const T> elements) noexcept {
        for (std::size_t i = 0U; i < elements.size(); ++i) {
            elements_[i] = elements[i];
        }
    }

    std::array<T, N> elements_{};
    std::uint32_t size_{0U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_BOUNDED_SEQUENCE_HPP
