// SPDX-License-Identifier: Apache-2.0
// Broken: a budget is one nanosecond longer than its window.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr mamori::Duration kBudget = 100_us + 1_ns;
#else
constexpr mamori::Duration kBudget = 100_us;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(kBudget), mamori::run(g_producer)));
MAMORI_CHECK(kSystem);
