// SPDX-License-Identifier: Apache-2.0
// What the compiler rejects: windows and their options.
// Each namespace compiles, and does not with its MAMORI_BREAK_<NAME>.
#include "mamori/kernel/component/external_trigger.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "parts.hpp"

// A window closes one nanosecond after its frame.
namespace window_outside_frame {
#ifdef MAMORI_BREAK_WINDOW_OUTSIDE_FRAME
constexpr mamori::Duration kLength = 1_ms + 1_ns;
#else
constexpr mamori::Duration kLength = 1_ms;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, kLength, mamori::budget(50_us), mamori::run(g_producer)));
MAMORI_CHECK(kSystem);
}  // namespace window_outside_frame

// The second window opens one nanosecond before the first one closes.
namespace windows_overlap {
#ifdef MAMORI_BREAK_WINDOWS_OVERLAP
constexpr mamori::Duration kOffset = 100_us - 1_ns;
#else
constexpr mamori::Duration kOffset = 100_us;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::window("b", kOffset, 100_us, mamori::budget(50_us), mamori::run(g_second_producer)));
MAMORI_CHECK(kSystem);
}  // namespace windows_overlap

// A background window ends one nanosecond before it has its processor time: 5 ms at 40 % load.
namespace background_too_slow {
#ifdef MAMORI_BREAK_BACKGROUND_TOO_SLOW
constexpr mamori::Duration kLength = 8600_us - 1_ns;
#else
constexpr mamori::Duration kLength = 8600_us;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(10_ms),
    mamori::window("a", 0_us, 500_us, mamori::every(1_ms), mamori::budget(400_us), mamori::run(g_producer)),
    mamori::window("plan", 0_us, kLength, mamori::background(), mamori::budget(5_ms),
                   mamori::run(g_second_producer)));
MAMORI_CHECK(kSystem);
}  // namespace background_too_slow

// Two windows of one name, which no report could tell apart.
namespace window_named_twice {
#ifdef MAMORI_BREAK_WINDOW_NAMED_TWICE
constexpr const char* kSecondName = "sense";
#else
constexpr const char* kSecondName = "act";
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("sense", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::window(kSecondName, 100_us, 100_us, mamori::budget(50_us), mamori::run(g_second_producer)));
MAMORI_CHECK(kSystem);
}  // namespace window_named_twice

// A budget is one nanosecond longer than its window.
namespace budget_over_window {
#ifdef MAMORI_BREAK_BUDGET_OVER_WINDOW
constexpr mamori::Duration kBudget = 100_us + 1_ns;
#else
constexpr mamori::Duration kBudget = 100_us;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(kBudget), mamori::run(g_producer)));
MAMORI_CHECK(kSystem);
}  // namespace budget_over_window

// A component runs in two windows.
namespace component_in_two_windows {
#ifdef MAMORI_BREAK_COMPONENT_IN_TWO_WINDOWS
constexpr Producer& kSecond = g_producer;
#else
constexpr Producer& kSecond = g_second_producer;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::window("b", 100_us, 100_us, mamori::budget(50_us), mamori::run(kSecond)));
MAMORI_CHECK(kSystem);
}  // namespace component_in_two_windows

// A window opens every 300 us of a frame of 1 ms.
namespace period_not_in_frame {
#ifdef MAMORI_BREAK_PERIOD_NOT_IN_FRAME
constexpr mamori::Duration kPeriod = 300_us;
#else
constexpr mamori::Duration kPeriod = 250_us;
#endif
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::window("sense", 0_us, 100_us, mamori::every(kPeriod),
                                                       mamori::budget(50_us), mamori::run(g_producer)));
MAMORI_CHECK(kSystem);
}  // namespace period_not_in_frame

// A window that opens every 0 ms.
namespace period_of_zero {
#ifdef MAMORI_BREAK_PERIOD_OF_ZERO
constexpr mamori::Duration kPeriod{0};
#else
constexpr mamori::Duration kPeriod{1000000};
#endif
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::every(kPeriod),
                                                       mamori::budget(50_us), mamori::run(g_producer)));
MAMORI_CHECK(kSystem);
}  // namespace period_of_zero

// The declared rate is not that of four openings in 1 ms.
namespace rate_not_occurrences {
#ifdef MAMORI_BREAK_RATE_NOT_OCCURRENCES
constexpr mamori::Rate kRate = 1000_hz;
#else
constexpr mamori::Rate kRate = 4000_hz;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("sense", 0_us, 100_us, mamori::every(250_us), mamori::rate(kRate),
                                        mamori::budget(50_us), mamori::run(g_producer)));
MAMORI_CHECK(kSystem);
}  // namespace rate_not_occurrences

// 400 Hz is not reached by leaving out openings of 1000 Hz.
namespace rate_not_reachable {
#ifdef MAMORI_BREAK_RATE_NOT_REACHABLE
constexpr mamori::Rate kSlower = 400_hz;
#else
constexpr mamori::Rate kSlower = 500_hz;
#endif
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::window("sense", 0_us, 100_us, mamori::rate(1000_hz, kSlower),
                                                       mamori::budget(50_us), mamori::run(g_producer)));
MAMORI_CHECK(kSystem);
}  // namespace rate_not_reachable

// A window that opens is not run zero times per second.
namespace rate_of_zero {
#ifdef MAMORI_BREAK_RATE_OF_ZERO
constexpr mamori::Rate kRate = 0_hz;
#else
constexpr mamori::Rate kRate = 1000_hz;
#endif
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::window("sense", 0_us, 100_us, mamori::rate(kRate),
                                                       mamori::budget(50_us), mamori::run(g_producer)));
MAMORI_CHECK(kSystem);
}  // namespace rate_of_zero

// A worst case below zero would make room for another one.
namespace worst_case_negative {
#ifdef MAMORI_BREAK_WORST_CASE_NEGATIVE
constexpr mamori::Duration kFirst{-1};
#else
constexpr mamori::Duration kFirst{0};
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("sense", 0_us, 100_us, mamori::budget(50_us),
                                        mamori::run(mamori::worst_case(g_producer, kFirst),
                                                    mamori::worst_case(g_second_producer, 50_us))));
MAMORI_CHECK(kSystem);
}  // namespace worst_case_negative

// Two worst cases are 1 ns longer together than their budget.
namespace worst_cases_over_budget {
#ifdef MAMORI_BREAK_WORST_CASES_OVER_BUDGET
constexpr mamori::Duration kSecond = 20_us + 1_ns;
#else
constexpr mamori::Duration kSecond = 20_us;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("sense", 0_us, 100_us, mamori::budget(50_us),
                                        mamori::run(mamori::worst_case(g_producer, 30_us),
                                                    mamori::worst_case(g_second_producer, kSecond))));
MAMORI_CHECK(kSystem);
}  // namespace worst_cases_over_budget

// The second budget would silently replace the first.
namespace window_option_twice {
#ifdef MAMORI_BREAK_WINDOW_OPTION_TWICE
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::budget(60_us), mamori::run(g_producer)));
#else
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)));
#endif
MAMORI_CHECK(kSystem);
}  // namespace window_option_twice

// One rate(...) names all rates of a window; a second one would replace them.
namespace window_rates_twice {
#ifdef MAMORI_BREAK_WINDOW_RATES_TWICE
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms),
                   mamori::window("a", 0_us, 100_us, mamori::rate(1000_hz, 500_hz), mamori::rate(1000_hz),
                                  mamori::budget(50_us), mamori::run(g_producer)));
#else
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::rate(1000_hz, 500_hz),
                                                       mamori::budget(50_us), mamori::run(g_producer)));
#endif
MAMORI_CHECK(kSystem);
}  // namespace window_rates_twice

// What releases the cycles of a window is one thing.
namespace window_of_two_kinds {
inline mamori::ExternalTrigger g_trigger;
#ifdef MAMORI_BREAK_WINDOW_OF_TWO_KINDS
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::event_driven(1U),
                                                       mamori::triggered_by(g_trigger), mamori::budget(50_us),
                                                       mamori::run(g_producer)));
#else
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::triggered_by(g_trigger),
                                                       mamori::budget(50_us), mamori::run(g_producer)));
#endif
MAMORI_CHECK(kSystem);
}  // namespace window_of_two_kinds

// A window that serves events, but none in any cycle.
namespace window_without_events {
#ifdef MAMORI_BREAK_WINDOW_WITHOUT_EVENTS
constexpr std::size_t kEvents = 0U;
#else
constexpr std::size_t kEvents = 1U;
#endif
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::window("serve", 0_us, 100_us, mamori::event_driven(kEvents),
                                                       mamori::budget(50_us), mamori::run(g_producer)));
MAMORI_CHECK(kSystem);
}  // namespace window_without_events

// A system has one abort policy.
namespace abort_policy_twice {
#ifdef MAMORI_BREAK_ABORT_POLICY_TWICE
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::abort_policy(mamori::AbortPolicy::kOpenRtmCompat),
                   mamori::abort_policy(mamori::AbortPolicy::kSpecOnly),
                   mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)));
#else
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::abort_policy(mamori::AbortPolicy::kOpenRtmCompat),
                   mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)));
#endif
MAMORI_CHECK(kSystem);
}  // namespace abort_policy_twice

// A system requests its trace hash once.
namespace trace_hash_twice {
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::trace_hash(),
#ifdef MAMORI_BREAK_TRACE_HASH_TWICE
                   mamori::trace_hash(),
#endif
                   mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)));
MAMORI_CHECK(kSystem);
}  // namespace trace_hash_twice

// One tick would release both windows, or the first one to look at it.
namespace trigger_used_twice {
inline mamori::ExternalTrigger g_trigger;
inline mamori::ExternalTrigger g_other_trigger;
#ifdef MAMORI_BREAK_TRIGGER_USED_TWICE
constexpr auto kSecond = mamori::triggered_by(g_trigger);
#else
constexpr auto kSecond = mamori::triggered_by(g_other_trigger);
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("a", 0_us, 100_us, mamori::triggered_by(g_trigger), mamori::budget(50_us),
                   mamori::run(g_producer)),
    mamori::window("b", 100_us, 100_us, kSecond, mamori::budget(50_us), mamori::run(g_second_producer)));
MAMORI_CHECK(kSystem);
}  // namespace trigger_used_twice

// A window has an empty name (1) or none (2).
namespace window_without_name {
#ifdef MAMORI_BREAK_WINDOW_WITHOUT_NAME
constexpr const char* kName = MAMORI_BREAK_WINDOW_WITHOUT_NAME == 1 ? "" : nullptr;
#else
constexpr const char* kName = "b";
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::window(kName, 100_us, 100_us, mamori::budget(50_us), mamori::run(g_second_producer)));
MAMORI_CHECK(kSystem);
}  // namespace window_without_name

// A window starts before its period (1), has no length (2), or has no budget (3).
namespace window_times {
#ifdef MAMORI_BREAK_WINDOW_TIMES
constexpr int kBreak = MAMORI_BREAK_WINDOW_TIMES;
#else
constexpr int kBreak = 0;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("sense", kBreak == 1 ? mamori::Duration{-1} : 0_us, kBreak == 2 ? 0_us : 100_us,
                   mamori::budget(kBreak == 3 ? 0_us : 50_us), mamori::run(g_producer)));
MAMORI_CHECK(kSystem);
}  // namespace window_times

// A frame has no length.
namespace frame_of_zero {
#ifdef MAMORI_BREAK_FRAME_OF_ZERO
constexpr mamori::Duration kFrame{0};
#else
constexpr mamori::Duration kFrame = 1_ms;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(kFrame),
    mamori::window("a", 0_us, 100_us, mamori::every(1_ms), mamori::budget(50_us), mamori::run(g_producer)));
MAMORI_CHECK(kSystem);
}  // namespace frame_of_zero

// A window runs one component twice.
namespace component_twice_in_window {
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us),
#ifdef MAMORI_BREAK_COMPONENT_TWICE_IN_WINDOW
                                                       mamori::run(g_producer, g_producer)));
#else
                                                       mamori::run(g_producer, g_second_producer)));
#endif
MAMORI_CHECK(kSystem);
}  // namespace component_twice_in_window

// A table that violates a rule is called checked, and an executive has the storage of another table.
namespace checked_table {
constexpr auto kSystem = mamori::system(mamori::frame(1_ms), mamori::window("a", 0_us, 100_us,
#if defined(MAMORI_BREAK_CHECKED_TABLE) && MAMORI_BREAK_CHECKED_TABLE == 1
                                                                            mamori::budget(200_us),
#else
                                                                            mamori::budget(50_us),
#endif
                                                                            mamori::run(g_producer)));
[[maybe_unused]] constexpr auto kOther = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::window("b", 200_us, 100_us, mamori::budget(50_us), mamori::run(g_second_producer)));
#if defined(MAMORI_BREAK_CHECKED_TABLE) && MAMORI_BREAK_CHECKED_TABLE == 2
mamori::ExecutiveFor<decltype(kSystem)> executive{mamori::kChecked<kOther>};
#else
mamori::ExecutiveFor executive{mamori::kChecked<kSystem>};
#endif
}  // namespace checked_table

inline mamori::Status send_notice(mamori::ContextHandle) noexcept {
    return mamori::Status::kOk;
}
inline mamori::SystemFunction<&send_notice> g_function{"function"};

// A system window without a budget.
namespace system_window_without_budget {
#ifdef MAMORI_BREAK_SYSTEM_WINDOW_WITHOUT_BUDGET
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::system_window("notice", 0_us, 100_us, g_function));
#else
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::system_window("notice", 0_us, 100_us, mamori::budget(1_ns), g_function));
#endif
MAMORI_CHECK(kSystem);
}  // namespace system_window_without_budget

// The budget of a system window is 0.
namespace system_window_budget_of_zero {
#ifdef MAMORI_BREAK_SYSTEM_WINDOW_BUDGET_OF_ZERO
constexpr mamori::Duration kBudget{0};
#else
constexpr mamori::Duration kBudget{1};
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::system_window("notice", 0_us, 100_us, mamori::budget(kBudget), g_function));
MAMORI_CHECK(kSystem);
}  // namespace system_window_budget_of_zero

// A system window that runs a component.
namespace system_window_of_component {
#ifdef MAMORI_BREAK_SYSTEM_WINDOW_OF_COMPONENT
constexpr auto& kRun = g_producer;
#else
constexpr auto& kRun = g_function;
#endif
[[maybe_unused]] constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::system_window("notice", 0_us, 100_us, mamori::budget(1_us), kRun));
}  // namespace system_window_of_component

// A system window that waits for events or for a trigger.
namespace system_window_that_waits {
#if defined(MAMORI_BREAK_SYSTEM_WINDOW_OF_EVENTS)
constexpr auto kOption = mamori::event_driven(1U);
#elif defined(MAMORI_BREAK_SYSTEM_WINDOW_OF_TRIGGER)
inline mamori::ExternalTrigger trigger;
constexpr auto kOption = mamori::triggered_by(trigger);
#else
constexpr auto kOption = mamori::core(0U);
#endif
[[maybe_unused]] constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms),
                   mamori::system_window("notice", 0_us, 100_us, mamori::budget(1_us), kOption, g_function));
}  // namespace system_window_that_waits

// A system function that is not one.
namespace system_function_of_integer {
#ifdef MAMORI_BREAK_SYSTEM_FUNCTION_OF_INTEGER
inline int send_integer(int) noexcept {
    return 0;
}
inline mamori::SystemFunction<&send_integer> g_other{};
#endif
}  // namespace system_function_of_integer
