// SPDX-License-Identifier: Apache-2.0
/// @file
/// Form of a payload type in LCM: the LCM type of each field and its dimensions. Not for users.
///
/// @satisfies SWR-LCM-001      Design: docs/design/lcm.md#types
/// Source:   LCM Type Specification Language (lcm-proj.github.io, "LCM Type Specifications")
#ifndef MAMORI_PORTS_LCM_TYPE_SHAPE_HPP
#define MAMORI_PORTS_LCM_TYPE_SHAPE_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <utility>

#include "mamori/kernel/base/type_list.hpp"
#include "mamori/kernel/payload/cdr_scalar.hpp"
#include "mamori/kernel/payload/fields.hpp"
#include "mamori/ports/lcm/type_names.hpp"

namespace mamori::ports::lcm::detail {

/// Element type and constant dimensions of a field, without its variable first dimension.
template <typename T>
struct Elements {
    using Element = T;
    static constexpr std::size_t kDimensions = 0U;
    static constexpr std::size_t get_size(std::size_t /*dimension*/) noexcept { return 0U; }
};
template <typename T, std::size_t N>
struct Elements<std::array<T, N>> {
    static_assert(!mamori::detail::Shape<T>::kIsSequence,
                  "LCM has one length per dimension: an array of sequences has no LCM form");
    using Element = typename Elements<T>::Element;
    static constexpr std::size_t kDimensions = 1U + Elements<T>::kDimensions;
    static constexpr std::size_t get_size(std::size_t dimension) noexcept {
        return dimension == 0U ? N : Elements<T>::get_size(dimension - 1U);
    }
};

/// Form of one field: a sequence is a variable first dimension with a length field of its own.
template <typename T>
struct FieldForm {
    static constexpr bool kIsSequence = false;
    static constexpr std::size_t kCapacity = 0U;
    using Inner = Elements<T>;
};
template <typename T, std::size_t N>
struct FieldForm<BoundedSequence<T, N>> {
    static_assert(!mamori::detail::Shape<T>::kIsSequence,
                  "LCM has one length per dimension: a sequence of sequences has no LCM form");
    static_assert(N <= 0x7FFFFFFFU, "the length of an LCM array has 31 bits");
    static constexpr bool kIsSequence = true;
    static constexpr std::size_t kCapacity = N;
    using Inner = Elements<T>;
};

template <typename T>
inline constexpr bool kIsStruct = !mamori::detail::kIsScalar<T> && !mamori::detail::Shape<T>::kIsString;

/// LCM type of a number, bool, enumeration or string. LCM has no unsigned numbers but `byte`: the bits are
/// kept.
template <typename T>
constexpr std::string_view get_primitive() noexcept {
    if constexpr (mamori::detail::Shape<T>::kIsString) {
        return "string";
    } else if constexpr (std::is_same_v<T, bool>) {
        return "boolean";
    } else if constexpr (std::is_floating_point_v<T>) {
        static_assert(sizeof(T) <= sizeof(double), "numbers have at most 64 bits");
        return sizeof(T) == sizeof(float) ? "float" : "double";
    } else if constexpr (mamori::detail::calc_wire_size<T>() == 1U) {
        return std::is_same_v<T, std::uint8_t> ? "byte" : "int8_t";
    } else if constexpr (mamori::detail::calc_wire_size<T>() == 2U) {
        return "int16_t";
    } else {
        return mamori::detail::calc_wire_size<T>() == 4U ? "int32_t" : "int64_t";
    }
}

template <std::size_t kIndex, typename First, typename... Rest>
struct FieldAt : FieldAt<kIndex - 1U, Rest...> {};
template <typename First, typename... Rest>
struct FieldAt<0U, First, Rest...> {
    using Type = First;
};

/// Calls `call(name, FieldForm<F>{})` for each field of T in order.
template <typename T, typename Call, std::size_t... kIndex, typename... F>
constexpr void for_each_listed(Call& call, std::index_sequence<kIndex...> /*fields*/,
                               mamori::detail::TypeList<F...> /*types*/) {
    static_assert(is_named<T>());
    static_assert(count_listed(LcmNames<T>::kFields) == sizeof...(F));
    (call(get_listed(LcmNames<T>::kFields, kIndex), FieldForm<F>{}), ...);
}
template <typename T, typename Call, typename... F>
constexpr void for_each_listed(Call& call, mamori::detail::TypeList<F...> types) {
    for_each_listed<T>(call, std::index_sequence_for<F...>{}, types);
}
template <typename T, typename Call>
constexpr void for_each_field(Call& call) {
    for_each_listed<T>(call, mamori::detail::FieldTypes<T>{});
}

/// Counts the fields whose name is that of the length of `sequence`, or `sequence` itself when it is a name.
struct NameClash {
    std::string_view sequence;
    std::size_t count{0U};
    template <typename Form>
    constexpr void operator()(std::string_view name, Form /*form*/) noexcept {
        count += is_length_name_of(name, sequence) || name == sequence ? 1U : 0U;
    }
};
template <typename T>
struct ClashCounter {
    std::size_t count{0U};
    template <typename Form>
    constexpr void operator()(std::string_view name, Form /*form*/) noexcept {
        if constexpr (Form::kIsSequence) {
            NameClash clash{name};
            for_each_field<T>(clash);
            count += clash.count - 1U;  // one is the sequence itself
        }
    }
};

/// True when a length field, or the protection header, has the name of another field.
template <typename T>
constexpr bool has_name_clash(std::string_view header) noexcept {
    ClashCounter<T> counter;
    for_each_field<T>(counter);
    NameClash clash{header};
    for_each_field<T>(clash);
    return counter.count > 0U || (!header.empty() && clash.count > 0U);
}

}  // namespace mamori::ports::lcm::detail

#endif  // MAMORI_PORTS_LCM_TYPE_SHAPE_HPP
