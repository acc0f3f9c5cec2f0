// SPDX-License-Identifier: Apache-2.0
/// @file
/// Function window(...): position in the major frame, components and options of one window.
///
/// @satisfies SWR-KRN-017      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_WINDOW_PART_HPP
#define MAMORI_KERNEL_WINDOW_PART_HPP

#include <cstddef>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/base/type_list.hpp"
#include "mamori/kernel/system/component_part.hpp"
#include "mamori/kernel/system/detail/option_words.hpp"
#include "mamori/kernel/system/detail/part_types.hpp"
#include "mamori/kernel/system/run_list.hpp"
#include "mamori/kernel/system/window_option.hpp"
#include "mamori/kernel/system/window_rate.hpp"
#include "mamori/kernel/table/window_row.hpp"

namespace mamori {

/// One window of the description.
template <typename... Cs>
struct WindowPart {
    struct Types : detail::NoTypes {
        using Components = detail::TypeList<typename detail::ComponentTypes<Cs>::Type...>;
        using Ports = typename detail::Concat<typename detail::ComponentTypes<Cs>::PortList...>::Type;
        using Parameters = typename RunList<Cs...>::Parameters;
        static constexpr std::size_t kWindows = 1U;
    };
    WindowRow row{};
    RunList<Cs...> list{};
    bool opens_once_per_frame{true};  ///< no every(...) is specified
};

namespace detail {

template <typename... Cs>
constexpr WindowPart<Cs...> finish_window(const WindowRow& row, const RunList<Cs...>& list) noexcept {
    WindowPart<Cs...> part{row, list, true};
    part.row.has_second_pass = (ComponentTypes<Cs>::kHasSecondPass || ...);
    return part;
}
template <typename Option, typename... Options>
constexpr auto finish_window(WindowRow row, const Option& option, const Options&... options) noexcept {
    static_assert(sizeof...(Options) > 0U, "a window ends with run(...)");
    apply(row, option);
    return finish_window(row, options...);
}

}  // namespace detail

/// One window: starts `offset` after the start of its period and ends `length` later.
/// @param[in] name    static storage, unique; shown in compiler messages and reports.
/// @param[in] offset  >= 0. @param[in] length > 0; offset + length <= period.
/// @param[in] options budget(...) and, last, run(...); also every(...), rate(...), core(...), background(),
///                    partition(...), stack(...), and one of triggered_by(...), event_driven(...). Each at
///                    most once.
template <typename... Options>
constexpr auto window(const char* name, Duration offset, Duration length,
                      const Options&... options) noexcept {
    static_assert(detail::kTimesSaid<Budget, Options...> > 0U, "a window needs its budget(...)");
    static_assert(detail::kIsEachSaidOnce<Options...>, "each option of a window is said once");
    static_assert(
        detail::kTimesSaid<TriggeredBy, Options...> + detail::kTimesSaid<EventDriven, Options...> <= 1U,
        "a window is triggered_by(...) or event_driven(...), not both");
    WindowRow row{};
    row.name = name;
    row.offset = offset;
    row.length = length;
    auto part = detail::finish_window(row, options...);
    part.opens_once_per_frame = detail::kTimesSaid<Every, Options...> == 0U;
    return part;
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_WINDOW_PART_HPP
