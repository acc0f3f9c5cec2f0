// SPDX-License-Identifier: Apache-2.0
/// @file
/// One field list per payload type. Everything that must look inside a payload (trace hash, and the encodings
/// that later layers add) walks this list, so padding bytes never take part and each type is described once.
///
/// @satisfies SWR-KRN-005      Design: docs/design/kernel.md#field-lists
#ifndef MAMORI_KERNEL_FIELDS_HPP
#define MAMORI_KERNEL_FIELDS_HPP

#include <array>
#include <cstddef>
#include <type_traits>

namespace mamori {

/// Field list of T. Specialised by MAMORI_FIELDS; a type without one cannot be a port payload.
template <typename T>
struct Fields {
    static constexpr bool kDeclared = false;
};

namespace detail {

template <typename T>
struct IsStdArray : std::false_type {};
template <typename T, std::size_t N>
struct IsStdArray<std::array<T, N>> : std::true_type {};

}  // namespace detail

/// True when T can travel through a port: a number, bool, enum, a type with a field list, or an array of
/// such.
template <typename T>
constexpr bool is_payload() noexcept {
    if constexpr (detail::IsStdArray<T>::value) {
        return is_payload<typename T::value_type>();
    } else {
        return std::is_trivially_copyable_v<T> &&
               (std::is_arithmetic_v<T> || std::is_enum_v<T> || Fields<T>::kDeclared);
    }
}

/// Calls `visitor(scalar)` for every number, bool or enum of `value`, in declaration order.
/// Depth is bounded by the nesting of the types, which the compiler knows.
template <typename T, typename Visitor>
constexpr void visit_scalars(const T& value, Visitor& visitor) noexcept {
    static_assert(is_payload<T>(), "give this type a field list: MAMORI_FIELDS(Type, field, ...)");
    if constexpr (detail::IsStdArray<T>::value) {
        for (const auto& element : value) {
            visit_scalars(element, visitor);
        }
    } else if constexpr (Fields<T>::kDeclared) {
        Fields<T>::for_each(value, [&visitor](const auto& field) noexcept { visit_scalars(field, visitor); });
    } else {
        visitor(value);
    }
}

}  // namespace mamori

#define MAMORI_DETAIL_EXPAND(x) x
#define MAMORI_DETAIL_F1(a) call(value.a);
#define MAMORI_DETAIL_F2(a, ...) \
    call(value.a);               \
    MAMORI_DETAIL_EXPAND(MAMORI_DETAIL_F1(__VA_ARGS__))
#define MAMORI_DETAIL_F3(a, ...) \
    call(value.a);               \
    MAMORI_DETAIL_EXPAND(MAMORI_DETAIL_F2(__VA_ARGS__))
#define MAMORI_DETAIL_F4(a, ...) \
    call(value.a);               \
    MAMORI_DETAIL_EXPAND(MAMORI_DETAIL_F3(__VA_ARGS__))
#define MAMORI_DETAIL_F5(a, ...) \
    call(value.a);               \
    MAMORI_DETAIL_EXPAND(MAMORI_DETAIL_F4(__VA_ARGS__))
#define MAMORI_DETAIL_F6(a, ...) \
    call(value.a);               \
    MAMORI_DETAIL_EXPAND(MAMORI_DETAIL_F5(__VA_ARGS__))
#define MAMORI_DETAIL_F7(a, ...) \
    call(value.a);               \
    MAMORI_DETAIL_EXPAND(MAMORI_DETAIL_F6(__VA_ARGS__))
#define MAMORI_DETAIL_F8(a, ...) \
    call(value.a);               \
    MAMORI_DETAIL_EXPAND(MAMORI_DETAIL_F7(__VA_ARGS__))
#define MAMORI_DETAIL_F9(a, ...) \
    call(value.a);               \
    MAMORI_DETAIL_EXPAND(MAMORI_DETAIL_F8(__VA_ARGS__))
#define MAMORI_DETAIL_F10(a, ...) \
    call(value.a);                \
    MAMORI_DETAIL_EXPAND(MAMORI_DETAIL_F9(__VA_ARGS__))
#define MAMORI_DETAIL_PICK(a1, a2, a3, a4, a5, a6, a7, a8, a9, a10, name, ...) name

/// Declares the fields of `Type` (1 to 10, every one it has), at global scope:
///     MAMORI_FIELDS(ns::JointState, position_rad, velocity_rad_s)
#define MAMORI_FIELDS(Type, ...)                                                                          \
    template <>                                                                                           \
    struct mamori::Fields<Type> {                                                                         \
        static constexpr bool kDeclared = true;                                                           \
        template <typename Call>                                                                          \
        static constexpr void for_each(const Type& value, Call&& call) noexcept {                         \
            MAMORI_DETAIL_EXPAND(MAMORI_DETAIL_PICK(                                                      \
                __VA_ARGS__, MAMORI_DETAIL_F10, MAMORI_DETAIL_F9, MAMORI_DETAIL_F8, MAMORI_DETAIL_F7,     \
                MAMORI_DETAIL_F6, MAMORI_DETAIL_F5, MAMORI_DETAIL_F4, MAMORI_DETAIL_F3, MAMORI_DETAIL_F2, \
                MAMORI_DETAIL_F1, unused)(__VA_ARGS__))                                                   \
        }                                                                                                 \
    };

#endif  // MAMORI_KERNEL_FIELDS_HPP
