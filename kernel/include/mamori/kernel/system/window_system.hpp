// SPDX-License-Identifier: Apache-2.0
/// @file
/// Function system_window(...): a window that runs one plain function instead of components of the
/// application, for transport, supervision, self tests, notices and reception.
///
///     Status send_all(Link& link, ContextHandle context) noexcept;
///     static Link link;
///     static mamori::SystemFunction<&send_all> sender{"sender", link};
///     ... mamori::system_window("send", 900_us, 50_us, mamori::budget(40_us), sender)
///
/// @satisfies SWR-KRN-096, SWR-KRN-097, SWR-KRN-098, SWR-KRN-099
/// Design: docs/design/kernel.md#system-windows
#ifndef MAMORI_KERNEL_WINDOW_SYSTEM_HPP
#define MAMORI_KERNEL_WINDOW_SYSTEM_HPP

#include <cstddef>
#include <type_traits>

#include "mamori/kernel/base/compiler_message.hpp"
#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/system/detail/option_words.hpp"
#include "mamori/kernel/system/run_list.hpp"
#include "mamori/kernel/system/window_option.hpp"
#include "mamori/kernel/system/window_part.hpp"

namespace mamori {

/// A function that a window runs, with its name in reports and its context. The executive treats it as a
/// component without ports that has only on_execute: a result other than kOk stops its calls until
/// reset_component() and activate_component().
///
/// @tparam kFunction pointer to `Status f(ContextHandle) noexcept` or `Status f(Context&, ContextHandle)
/// noexcept`.
///
/// Thread safety: as Component. Time: that of the function. Memory: no heap; static storage.
template <auto kFunction>
class SystemFunction {
    static_assert(rules::kKept<SystemFunction>,
                  "a system function is Status f(ContextHandle) noexcept or "
                  "Status f(Context&, ContextHandle) noexcept");
};
template <Status (*kFunction)(ContextHandle) noexcept>
class SystemFunction<kFunction> final : public Component {
  public:
    /// @param[in] name static storage; unique among the components of the table.
    constexpr explicit SystemFunction(const char* name) noexcept : Component(name) {}
    Status on_execute(ContextHandle context) noexcept override { return kFunction(context); }
};
template <typename Context, Status (*kFunction)(Context&, ContextHandle) noexcept>
class SystemFunction<kFunction> final : public Component {
  public:
    /// @param[in] name    static storage; unique among the components of the table.
    /// @param[in] context passed to each call; must outlive this object.
    constexpr SystemFunction(const char* name, Context& context) noexcept
        : Component(name), context_(context) {}
    Status on_execute(ContextHandle context) noexcept override { return kFunction(context_, context); }

  private:
    Context& context_;
};

namespace rules {

/// Shown for a system window that is not complete. @tparam Function of the window.
template <typename Function>
struct SystemWindowHasItsBudget {
    static_assert(kKept<SystemWindowHasItsBudget>, "a system window states its budget(...)");
};

}  // namespace rules

namespace detail {

template <typename T>
struct IsSystemFunction : std::false_type {};
template <auto kFunction>
struct IsSystemFunction<SystemFunction<kFunction>> : std::true_type {};

/// The last of some types.
template <typename... Ts>
struct LastOf;
template <typename T>
struct LastOf<T> {
    using Type = T;
};
template <typename T, typename... Ts>
struct LastOf<T, Ts...> : LastOf<Ts...> {};

template <typename Option>
constexpr Option to_window_option(const Option& option) noexcept {
    return option;
}
template <auto kFunction>
constexpr auto to_window_option(SystemFunction<kFunction>& function) noexcept {
    return run(function);
}

}  // namespace detail

/// One window that runs `function` in each of its instances, in all modes of the system. Like any window, it
/// has a budget that the platform host enforces, and tables, time lines, costs and reports show it.
/// @param[in] name, offset, length as for window(...).
/// @param[in] options budget(...) and, last, a SystemFunction of static storage; also every(...),
///                    rate(...), core(...), background(), partition(...) and stack(...).
template <typename... Options>
constexpr auto system_window(const char* name, Duration offset, Duration length,
                             Options&&... options) noexcept {
    using Function = typename detail::LastOf<void, std::remove_reference_t<Options>...>::Type;
    static_assert(detail::IsSystemFunction<Function>::value,
                  "a system window ends with its SystemFunction, which is not a constant");
    static_assert(detail::kTimesSaid<EventDriven, std::decay_t<Options>...> +
                          detail::kTimesSaid<TriggeredBy, std::decay_t<Options>...> ==
                      0U,
                  "a system window is periodic; remove event_driven(...) or triggered_by(...)");
    if constexpr (detail::kTimesSaid<Budget, std::decay_t<Options>...> == 0U) {
        return sizeof(rules::SystemWindowHasItsBudget<Function>);
    } else {
        auto part = window(name, offset, length, detail::to_window_option(options)...);
        part.row.is_system = true;
        return part;
    }
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_WINDOW_SYSTEM_HPP
