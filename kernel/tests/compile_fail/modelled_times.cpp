// SPDX-License-Identifier: Apache-2.0
// What the compiler rejects: modelled times and action budgets without meaning; MAMORI_BREAK says which.
#include "parts.hpp"

#ifndef MAMORI_BREAK
#define MAMORI_BREAK 0
#endif

constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("all", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer, g_second_producer)),
#if MAMORI_BREAK == 1
    mamori::modelled_time(g_consumer, 0_us),
#elif MAMORI_BREAK == 2
    mamori::modelled_time(g_second_producer, 20_us),
#elif MAMORI_BREAK == 5
    mamori::action_budget(1_ms),
#endif
    mamori::modelled_time(g_producer, MAMORI_BREAK == 3 ? mamori::Duration{-1} : 0_us),
    mamori::modelled_time(g_second_producer, 1_ms), mamori::action_budget(MAMORI_BREAK == 4 ? 0_ms : 1_ms));
MAMORI_CHECK(kSystem);
