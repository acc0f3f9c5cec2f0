// SPDX-License-Identifier: Apache-2.0
/// @file
/// One field list per payload type. All code that reads the fields of a payload (trace hash, encodings) uses
/// this list. Therefore, padding bytes are never used, and each type is described once.
///
/// @satisfies SWR-KRN-005, SWR-CDR-001, SWR-CDR-004, SWR-CIF-004
/// Design: docs/design/data_flow.md#field-lists
#ifndef MAMORI_KERNEL_FIELDS_HPP
#define MAMORI_KERNEL_FIELDS_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "mamori/kernel/base/type_list.hpp"
#include "mamori/kernel/payload/bounded_sequence.hpp"
#include "mamori/kernel/payload/bounded_string.hpp"

namespace mamori {

/// Field list of T. Specialised by MAMORI_FIELDS; a type without a field list cannot be a port payload.
/// Specialise a class template manually with the same two members: `kDeclared = true` and
/// `apply(self, call)`, which returns `call(self.first, self.second, ...)` for a const or mutable `self`.
template <typename T>
struct Fields {
    static constexpr bool kDeclared = false;
};

namespace detail {

/// Category of a payload type (array, sequence, string), for all code that walks payloads.
template <typename T>
struct Shape {
    static constexpr bool kIsArray = false;
    static constexpr bool kIsSequence = false;
    static constexpr bool kIsString = false;
};
template <typename T, std::size_t N>
struct Shape<std::array<T, N>> : Shape<void> {
    static constexpr bool kIsArray = true;
    static constexpr std::size_t kCapacity = N;
    using Element = T;
};
template <typename T, std::size_t N>
struct Shape<T[N]> : Shape<std::array<T, N>> {};  // a field of a struct in C
template <typename T, std::size_t N>
struct Shape<BoundedSequence<T, N>> : Shape<void> {
    static constexpr bool kIsSequence = true;
    static constexpr std::size_t kCapacity = N;
    using Element = T;
};
template <std::size_t N>
struct Shape<BoundedString<N>> : Shape<void> {
    static constexpr bool kIsString = true;
    static constexpr std::size_t kCapacity = N;
};

template <typename T>
inline constexpr bool kIsScalar = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Returns the types of the fields passed to it.
struct ListTypes {
    template <typename... T>
    constexpr TypeList<T...> operator()(const T&... /*fields*/) const noexcept {
        return {};
    }
};
template <typename T>
using FieldTypes = decltype(Fields<T>::apply(std::declval<T&>(), ListTypes{}));

}  // namespace detail

/// True when ports can transfer T: a number, bool, enum, a type with a field list, a bounded string, or an
/// array or bounded sequence of such types.
template <typename T>
constexpr bool is_payload() noexcept {
    if constexpr (detail::Shape<T>::kIsArray || detail::Shape<T>::kIsSequence) {
        return is_payload<typename detail::Shape<T>::Element>();
    } else {
        return std::is_trivially_copyable_v<T> &&
               (detail::kIsScalar<T> || detail::Shape<T>::kIsString || Fields<T>::kDeclared);
    }
}

namespace detail {

/// Walks a payload, const or mutable, in declaration order until `visitor` returns false:
///     run(first, count)     numbers, bools or enums that follow one another
///     open(sequence, count) before a sequence; sets how many of its elements are walked, 0 .. capacity
///     text(string)          a bounded string
/// The nesting of the types, which the compiler knows, bounds the recursion depth.
/// @return true when the visitor never returned false.
template <typename T, typename Visitor>
constexpr bool walk(T& value, Visitor& visitor) noexcept {
    using Bare = std::remove_const_t<T>;
    static_assert(is_payload<Bare>(), "give this type a field list: MAMORI_FIELDS(Type, field, ...)");
    if constexpr (Shape<Bare>::kIsString) {
        return visitor.text(value);
    } else if constexpr (Shape<Bare>::kIsArray || Shape<Bare>::kIsSequence) {
        std::size_t count = Shape<Bare>::kCapacity;
        if constexpr (Shape<Bare>::kIsSequence) {
            if (!visitor.open(value, count)) {
                return false;
            }
        }
        if constexpr (kIsScalar<typename Shape<Bare>::Element>) {
            return visitor.run(std::data(value), count);
        } else {
            bool goes_on = true;
            for (std::size_t i = 0U; goes_on && i < count; ++i) {
                goes_on = walk(std::data(value)[i], visitor);
            }
            return goes_on;
        }
    } else if constexpr (kIsScalar<Bare>) {
        return visitor.run(&value, 1U);
    } else {
        return Fields<Bare>::apply(
            value, [&visitor](auto&... field) noexcept { return (walk(field, visitor) && ...); });
    }
}

/// Passes every scalar to a callable. A sequence or string is its 32-bit length, then its elements in use.
template <typename Visitor>
class EachScalar final {
  public:
    constexpr explicit EachScalar(Visitor& visitor) noexcept : visitor_(visitor) {}

    template <typename T>
    constexpr bool run(const T* first, std::size_t count) noexcept {
        for (std::size_t i = 0U; i < count; ++i) {
            visitor_(first[i]);
        }
        return true;
    }
    template <typename Sequence>
    constexpr bool open(const Sequence& sequence, std::size_t& count) noexcept {
        count = sequence.size();
        visitor_(static_cast<std::uint32_t>(count));
        return true;
    }
    template <std::size_t N>
    constexpr bool text(const BoundedString<N>& string) noexcept {
        visitor_(static_cast<std::uint32_t>(string.size()));
        return run(string.c_str(), string.size());
    }

  private:
    Visitor& visitor_;
};

}  // namespace detail

/// Calls `visitor(scalar)` for every number, bool or enum of `value`, in declaration order. For a bounded
/// sequence or string, passes its length as std::uint32_t, then only the elements in use. O(scalars in use),
/// plus the visitor.
template <typename T, typename Visitor>
constexpr void visit_scalars(const T& value, Visitor& visitor) noexcept {
    detail::EachScalar<Visitor> each(visitor);
    static_cast<void>(detail::walk(value, each));
}

}  // namespace mamori

/// Declares all fields of `Type` in the order of their declaration, at global scope:
///     MAMORI_FIELDS(ns::JointState, position_rad, velocity_rad_s)
/// The compiler rejects a list that omits a field, names an unknown field or swaps fields of different types.
/// `Type` is a plain struct: public members, no base class with members of its own, not final.
#define MAMORI_FIELDS(Type, ...)                                                                            \
    template <>                                                                                             \
    struct mamori::Fields<Type> {                                                                           \
        static constexpr bool kDeclared = true;                                                             \
        template <typename MamoriSelf, typename MamoriCall>                                                 \
        static constexpr decltype(auto) apply(MamoriSelf& mamori_self, MamoriCall&& mamori_call) noexcept { \
            auto& [__VA_ARGS__] = mamori_self;                                                              \
            return mamori_call(__VA_ARGS__);                                                                \
        }                                                                                                   \
        struct Named : Type {                                                                               \
            using Types = decltype(mamori::detail::ListTypes{}(__VA_ARGS__));                               \
        };                                                                                                  \
    };                                                                                                      \
    static_assert(std::is_same_v<mamori::Fields<Type>::Named::Types, mamori::detail::FieldTypes<Type>>,     \
                  "MAMORI_FIELDS names the fields of a type in the order of their declaration");

#endif  // MAMORI_KERNEL_FIELDS_HPP
