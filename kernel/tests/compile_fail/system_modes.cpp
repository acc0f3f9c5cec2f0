// SPDX-License-Identifier: Apache-2.0
// Broken: the modes of a system, each time by one thing; MAMORI_BREAK says which.
#include "mamori/kernel/system/system.hpp"
#include "parts.hpp"

#ifndef MAMORI_BREAK
#define MAMORI_BREAK 0
#endif

class Axis final : public mamori::Component {
  public:
    constexpr Axis() noexcept : Component("axis") {}
    mamori::InPort<double> in{*this, "in"};
    using Ports = mamori::Ports<&Axis::in>;
    mamori::Parameter<double> speed{*this, "speed", 1.0, mamori::between(0.5, 3.0)};
    using Parameters = mamori::Parameters<&Axis::speed>;
};
class Spare final : public mamori::Component {
  public:
    constexpr Spare() noexcept : Component("spare") {}
};
inline Axis g_axis;
inline Axis g_unknown_axis;
inline Spare g_spare;
inline Spare g_stranger;

enum class Command { kTeach, kStop };
constexpr int kBreak = MAMORI_BREAK;

constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("all", 0_us, 100_us, mamori::budget(50_us),
                   mamori::run(g_producer, g_second_producer, g_axis, g_spare)),
    mamori::connect(g_producer.real, g_axis.in, mamori::only_in(kBreak == 1 ? "tech" : "work"),
                    mamori::any_age()),
#if MAMORI_BREAK == 2
    mamori::connect(g_second_producer.real, g_axis.in, mamori::only_in("teach", "work"), mamori::any_age()),
#elif MAMORI_BREAK != 3
    mamori::connect(g_second_producer.real, g_axis.in, mamori::only_in("teach"), mamori::any_age()),
#endif
    mamori::configuration_set(kBreak == 20 ? "" : "slow",
#if MAMORI_BREAK == 21
                              mamori::assign(g_unknown_axis.speed, 1.0),
#elif MAMORI_BREAK == 22
                              mamori::assign(g_axis.speed, 1.0),
#endif
                              mamori::assign(g_axis.speed, kBreak == 4 ? 0.4 : 0.5)),
    mamori::configuration_set(kBreak == 23 ? "slow" : "fast", mamori::assign(g_axis.speed, 2.0)),
    mamori::system_mode("work",
#if MAMORI_BREAK == 5
                        mamori::runs(g_producer, g_axis, g_spare, g_stranger, g_second_producer)
#else
                        mamori::runs(g_producer, g_axis, g_spare, g_second_producer)
#endif
                            ),
    mamori::system_mode(kBreak == 6    ? "work"
                        : kBreak == 17 ? ""
                        : kBreak == 18 ? nullptr
                                       : "teach",
#if MAMORI_BREAK == 7
                        mamori::runs(g_axis, g_spare),
#elif MAMORI_BREAK == 8
                        mamori::runs(g_second_producer, g_axis),
#else
                        mamori::runs(g_second_producer, g_axis, g_spare),
#endif
                        mamori::parameters(kBreak == 9 ? "slo" : "slow")),
#if MAMORI_BREAK == 10
    mamori::system_mode("halt", mamori::runs(g_spare)),
#else
    mamori::safe_mode("halt", mamori::runs(g_spare)),
#endif
#if MAMORI_BREAK == 11
    mamori::safe_mode("stop", mamori::runs(g_spare)),
#endif
#if MAMORI_BREAK == 12
    mamori::mode_transition("halt", Command::kTeach, "work"),
#elif MAMORI_BREAK == 13
    mamori::mode_transition("work", Command::kTeach, "halt"),
#endif
    mamori::mode_transition("work", kBreak == 14 ? Command::kStop : Command::kTeach,
                            kBreak == 15   ? "tech"
                            : kBreak == 16 ? "work"
                                           : "teach"),
    mamori::mode_transition(kBreak == 19 ? "teech" : "teach", Command::kStop, "work"));
MAMORI_CHECK(kSystem);

constexpr auto kIdlers = mamori::system(
    mamori::frame(1_ms),
    mamori::window("all", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer, g_spare)),
    mamori::safe_mode("halt",
#if MAMORI_BREAK == 14
                      mamori::runs(g_producer)
#else
                      mamori::runs(g_producer, g_spare)
#endif
                          ));
MAMORI_CHECK(kIdlers);
