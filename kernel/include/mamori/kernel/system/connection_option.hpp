// SPDX-License-Identifier: Apache-2.0
/// @file
/// The words that say more of one connection: how old its value may be, what carries it across cores, and in
/// which modes it holds. Each stands beside what it writes into the row.
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
/// Age up to which the value of an input is fresh; beyond it its status is kBufferTimeout.
/// @param[in] age_max  > 0.
/// @param[in] lead_max how far its instant may be after now, >= 0; 0 on one time line.
constexpr FreshWithin fresh_within(Duration age_max, Duration lead_max = {}) noexcept {
    return {age_max, lead_max};
}

/// Made by any_age().
struct AnyAge {};
/// The value of an input stays fresh however old it is.
constexpr AnyAge any_age() noexcept {
    return {};
}

/// Made by delayed_by_a_frame().
struct DelayedByAFrame {};
/// States that the reader runs before the writer in one window, or is the writer itself: it reads a value one
/// start of the window after the write. MAMORI_CHECK rejects such a connection without this option, and any
/// other with it.
constexpr DelayedByAFrame delayed_by_a_frame() noexcept {
    return {};
}

/// Made by through().
template <typename T>
struct Through {
    Crossing<T>& crossing;
};
/// Storage of a connection that leaves its core or partition; static, used by one connection.
template <typename T>
constexpr Through<T> through(Crossing<T>& crossing) noexcept {
    return {crossing};
}

/// Made by only_in().
template <std::size_t kCount>
struct OnlyIn {
    std::array<const char*, kCount> modes{};
};
/// Option of connect(): the connection holds in these modes only. Without it a connection holds wherever both
/// of its components run. @param[in] modes names of modes, static storage.
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
