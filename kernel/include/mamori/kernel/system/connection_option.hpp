// SPDX-License-Identifier: Apache-2.0
/// @file
/// Options of a connection: maximum age of its value, storage across cores or partitions, and modes in which
/// it is active. Each option is defined next to the function that writes it to the row.
///
/// @satisfies SWR-KRN-017, SWR-KRN-047, SWR-KRN-048, SWR-MOD-001      Design:
/// docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_CONNECTION_OPTION_HPP
#define MAMORI_KERNEL_CONNECTION_OPTION_HPP

#include <array>
#include <cstddef>
#include <type_traits>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/dataflow/connection.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"

namespace mamori {

/// Made by fresh_within().
struct FreshWithin {
    Duration age_max;
    Duration lead_max;
};
/// Maximum age of a fresh value of an input; the status of an older value is kBufferTimeout.
/// @param[in] age_max  > 0.
/// @param[in] lead_max maximum time by which its publication instant may be later than now, >= 0; 0 if both
///                     ends use the same time base.
constexpr FreshWithin fresh_within(Duration age_max, Duration lead_max = {}) noexcept {
    return {age_max, lead_max};
}

/// Made by any_age().
struct AnyAge {};
/// The value of an input remains fresh at any age.
constexpr AnyAge any_age() noexcept {
    return {};
}

/// Made by delayed_by_a_frame().
struct DelayedByAFrame {};
/// Declares that the reader runs before the writer in the same window, or is the writer itself: it reads a
/// value at the next window start after the write. MAMORI_CHECK rejects such a connection without this
/// option, and any other connection with it.
constexpr DelayedByAFrame delayed_by_a_frame() noexcept {
    return {};
}

/// Made by through().
template <typename T>
struct Through {
    Crossing<T>& crossing;
};
/// Storage of a connection that leaves its core or partition; static storage, used by one connection.
template <typename T>
constexpr Through<T> through(Crossing<T>& crossing) noexcept {
    return {crossing};
}

/// Made by only_in().
template <std::size_t kCount>
struct OnlyIn {
    std::array<const char*, kCount> modes{};
};
/// The connection is active in these modes only. Without this option, it is active in each mode that runs
/// both of its components. @param[in] modes names of modes, static storage, at least one.
template <typename... Names>
constexpr OnlyIn<sizeof...(Names)> only_in(Names... modes) noexcept {
    static_assert(sizeof...(Names) > 0U, "a connection holds in at least one mode");
    return {{modes...}};
}

namespace detail {

template <typename Option>
inline constexpr std::size_t kModesNamedBy = 0U;
template <std::size_t kCount>
inline constexpr std::size_t kModesNamedBy<OnlyIn<kCount>> = kCount;

template <typename T, typename Sink, typename Part>
constexpr void apply(Part& part, FreshWithin option) noexcept {
    part.row.age_max = option.age_max;
    part.row.lead_max = option.lead_max;
}
template <typename T, typename Sink, typename Part>
constexpr void apply(Part& part, AnyAge) noexcept {
    part.row.age_max = kNoAgeLimit;
    part.row.lead_max = Duration{0};
}
template <typename T, typename Sink, typename Part>
constexpr void apply(Part& part, DelayedByAFrame) noexcept {
    part.row.is_delayed_by_a_frame = true;
}
template <typename T, typename Sink, typename Part, std::size_t kCount>
constexpr void apply(Part& part, const OnlyIn<kCount>& option) noexcept {
    part.modes = option.modes;
}
template <typename T, typename Sink, typename Part, typename U>
constexpr void apply(Part& part, Through<U> option) noexcept {
    static_assert(std::is_same_v<T, U>, "the Crossing of a connection carries its payload type");
    static_assert(!Sink::kIsQueue, "a queue is its own buffer; connect it without through(...)");
    part.row.crossing = &option.crossing;
    part.row.operations = CrossingConnection<T, Sink>::kOperations;
}

}  // namespace detail

}  // namespace mamori

#endif  // MAMORI_KERNEL_CONNECTION_OPTION_HPP
