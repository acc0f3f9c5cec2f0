// SPDX-License-Identifier: Apache-2.0
// Broken: executives without the SystemModes that their tables need, 1: for modes, 2: for configuration sets.
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "parts.hpp"

#ifndef MAMORI_BREAK
#define MAMORI_BREAK 0
#endif

class Axis final : public mamori::Component {
  public:
    constexpr Axis() noexcept : Component("axis") {}
    mamori::Parameter<double> speed{*this, "speed", 1.0};
    using Parameters = mamori::Parameters<&Axis::speed>;
};
inline Axis g_axis;

constexpr auto kWithModes = mamori::system(
    mamori::frame(1_ms), mamori::window("all", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::safe_mode("halt", mamori::runs(g_producer)));
constexpr auto kWithSets = mamori::system(
    mamori::frame(1_ms), mamori::window("all", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_axis)),
    mamori::configuration_set("slow", mamori::assign(g_axis.speed, 0.5)));
constexpr auto kPlain = mamori::system(
    mamori::frame(1_ms), mamori::window("all", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)));

inline mamori::SystemModes g_modes{mamori::make_view(kWithModes)};
inline mamori::SystemModes g_sets{mamori::make_view(kWithSets)};
inline mamori::ExecutiveFor g_plain{kPlain};
#if MAMORI_BREAK == 1
inline mamori::ExecutiveFor g_executive{kWithModes};
#else
inline mamori::ExecutiveFor g_executive{kWithModes, g_modes};
#endif
#if MAMORI_BREAK == 2
inline mamori::ExecutiveFor g_set_executive{kWithSets};
#else
inline mamori::ExecutiveFor g_set_executive{kWithSets, g_sets};
#endif
