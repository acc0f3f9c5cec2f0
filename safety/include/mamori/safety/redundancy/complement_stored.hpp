// SPDX-License-Identifier: Apache-2.0
/// @file
/// A value that is kept with its bitwise complement, so that memory that changed by itself is found when the
/// value is read. What is found corrupted is not given out.
///
/// @satisfies SWR-RED-001, SWR-RED-002      Design: docs/design/redundancy.md#complement-stored-values
/// Source:   IEC 61508-7:2010 A.5.7 (double RAM with comparison)
#ifndef MAMORI_SAFETY_REDUNDANCY_COMPLEMENT_STORED_HPP
#define MAMORI_SAFETY_REDUNDANCY_COMPLEMENT_STORED_HPP

#include <array>
#include <cstddef>
#include <type_traits>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/payload/fields.hpp"
#include "mamori/safety/base/opaque.hpp"

namespace mamori::safety {

template <typename T>
constexpr bool has_no_padding() noexcept;

namespace detail {

template <typename... T>
constexpr bool fill(std::size_t size, mamori::detail::TypeList<T...> /*fields*/) noexcept {
    return (has_no_padding<T>() && ...) && (sizeof(T) + ... + 0U) == size;
}

}  // namespace detail

/// True when every bit of a T belongs to its value: integers, enumerators, float, double, arrays of such, and
/// structures of such without a gap, which need a field list (MAMORI_FIELDS) when they hold floating point.
template <typename T>
constexpr bool has_no_padding() noexcept {
    using Shape = mamori::detail::Shape<T>;
    if constexpr (Shape::kIsArray) {
        return has_no_padding<typename Shape::Element>();
    } else if constexpr (std::is_floating_point_v<T>) {
        return sizeof(T) <= sizeof(double);  // an extended format fills up with bytes that mean nothing
    } else if constexpr (Fields<T>::kDeclared) {
        return detail::fill(sizeof(T), mamori::detail::FieldTypes<T>{});
    } else {
        return std::has_unique_object_representations_v<T>;
    }
}

/// A T and its complement. Finds every corruption except one that turns the same bits in both.
///
/// Thread safety: none; an interrupt between the two stores would see them disagree.
/// Time:          O(sizeof(T)), nothing blocks. Memory: twice that of T.
template <typename T>
class ComplementStored final {
    static_assert(std::is_trivially_copyable_v<T>, "a value that is more than its bytes has no complement");
    static_assert(has_no_padding<T>(), "bytes between or behind the fields belong to no value; remove them");

  public:
    explicit constexpr ComplementStored(const T& value) noexcept
        : stored_(__builtin_bit_cast(Bytes, value)), complement_(calc_complement(stored_)) {}

    constexpr void set(const T& value) noexcept { *this = ComplementStored(value); }

    /// @return the value; kError (the two forms disagree; they stay so until set() is called).
    Result<T> read() const noexcept {
        forget(this);
        unsigned int difference = 0U;
        for (std::size_t i = 0U; i < sizeof(T); ++i) {
            difference |= (static_cast<unsigned int>(stored_[i]) ^ complement_[i]) ^ 0xFFU;
        }
        if (difference != 0U) {
            return Status::kError;
        }
        return __builtin_bit_cast(T, stored_);
    }

  private:
    // Bytes rather than a T: a corrupted bool or enumerator must not be read as one before it is judged.
    using Bytes = std::array<unsigned char, sizeof(T)>;

    static constexpr Bytes calc_complement(const Bytes& bytes) noexcept {
        Bytes result{};
        for (std::size_t i = 0U; i < sizeof(T); ++i) {
            result[i] = static_cast<unsigned char>(bytes[i] ^ 0xFFU);
        }
        return result;
    }

    alignas(T) Bytes stored_;
    alignas(T) Bytes complement_;
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_REDUNDANCY_COMPLEMENT_STORED_HPP
