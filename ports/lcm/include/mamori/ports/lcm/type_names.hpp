// SPDX-License-Identifier: Apache-2.0
/// @file
/// Names of a payload type and of its fields, as LCM needs them: the fingerprint of a type and its `.lcm`
/// text consist of names. The kernel's field list keeps the fields without their names.
///
/// @satisfies SWR-LCM-001      Design: docs/design/lcm.md#types
#ifndef MAMORI_PORTS_LCM_TYPE_NAMES_HPP
#define MAMORI_PORTS_LCM_TYPE_NAMES_HPP

#include <cstddef>
#include <string_view>
#include <type_traits>

#include "mamori/kernel/payload/fields.hpp"

namespace mamori::ports::lcm {

/// Names of T. Specialised by MAMORI_LCM_FIELDS and MAMORI_LCM_NAMES.
template <typename T>
struct LcmNames {
    static constexpr bool kDeclared = false;
};

namespace detail {

constexpr std::string_view trim(std::string_view text) noexcept {
    while (!text.empty() && text.front() == ' ') {
        text.remove_prefix(1U);
    }
    while (!text.empty() && text.back() == ' ') {
        text.remove_suffix(1U);
    }
    return text;
}

/// Name `index` of a list that commas separate; empty when the list is shorter.
constexpr std::string_view get_listed(std::string_view list, std::size_t index) noexcept {
    for (std::size_t i = 0U; i < index && !list.empty(); ++i) {
        const std::size_t comma = list.find(',');
        list = comma == std::string_view::npos ? std::string_view{} : list.substr(comma + 1U);
    }
    return trim(list.substr(0U, list.find(',')));
}

/// The name of a type as it was written, without the `::` of the global namespace.
constexpr std::string_view get_spelled(std::string_view type) noexcept {
    return type.substr(0U, 2U) == "::" ? type.substr(2U) : type;
}

/// Names in a list that commas separate: its commas and one more.
constexpr std::size_t count_listed(std::string_view list) noexcept {
    std::size_t count = 1U;
    for (const char character : list) {
        count += character == ',' ? 1U : 0U;
    }
    return count;
}

/// True when a sequence `b` has a field `n_b` for its length that has the name of another field.
constexpr bool is_length_name_of(std::string_view name, std::string_view sequence) noexcept {
    return name.substr(0U, 2U) == "n_" && name.substr(2U) == sequence;
}

template <typename T>
constexpr bool is_named() noexcept {
    static_assert(LcmNames<T>::kDeclared,
                  "name this type for LCM: MAMORI_LCM_FIELDS(ns::Type, field, ...), or MAMORI_LCM_NAMES when "
                  "it already has a field list");
    static_assert(get_spelled(LcmNames<T>::kType).find("::") != std::string_view::npos,
                  "LCM needs a package: put the type into a namespace and spell it with that namespace");
    static_assert(get_spelled(LcmNames<T>::kType).find('<') == std::string_view::npos,
                  "LCM has no templates: name an alias of this type");
    return true;
}

/// Package of T in the spelling of C++ (`a::b`).
template <typename T>
constexpr std::string_view get_namespace() noexcept {
    static_assert(is_named<T>());
    constexpr std::string_view kName = get_spelled(LcmNames<T>::kType);
    return kName.substr(0U, kName.rfind("::"));
}
/// Name of T without its package.
template <typename T>
constexpr std::string_view get_type_name() noexcept {
    static_assert(is_named<T>());
    constexpr std::string_view kName = get_spelled(LcmNames<T>::kType);
    return kName.substr(kName.rfind("::") + 2U);
}

}  // namespace detail

}  // namespace mamori::ports::lcm

/// Names the fields of a type that has a field list (MAMORI_FIELDS), at global scope:
///     MAMORI_LCM_NAMES(ns::JointState, position_rad, velocity_rad_s)
/// The namespace becomes the LCM package. The compiler rejects a list that omits a field, names an unknown
/// field or swaps fields of different types.
#define MAMORI_LCM_NAMES(Type, ...)                                                                         \
    template <>                                                                                             \
    struct mamori::ports::lcm::LcmNames<Type> {                                                             \
        static constexpr bool kDeclared = true;                                                             \
        static constexpr const char* kType = #Type;                                                         \
        static constexpr const char* kFields = #__VA_ARGS__;                                                \
        struct Named : Type {                                                                               \
            using Types = decltype(mamori::detail::ListTypes{}(__VA_ARGS__));                               \
        };                                                                                                  \
    };                                                                                                      \
    static_assert(                                                                                          \
        std::is_same_v<mamori::ports::lcm::LcmNames<Type>::Named::Types, mamori::detail::FieldTypes<Type>>, \
        "MAMORI_LCM_NAMES names the fields of a type in the order of their declaration");

/// One list for both: MAMORI_FIELDS and MAMORI_LCM_NAMES of a type.
#define MAMORI_LCM_FIELDS(Type, ...) \
    MAMORI_FIELDS(Type, __VA_ARGS__) \
    MAMORI_LCM_NAMES(Type, __VA_ARGS__)

#endif  // MAMORI_PORTS_LCM_TYPE_NAMES_HPP
