// SPDX-License-Identifier: Apache-2.0
// Broken: one tick would release both windows, or the first one to look at it.
#include "mamori/kernel/component/external_trigger.hpp"
#include "parts.hpp"

inline mamori::ExternalTrigger g_trigger;
inline mamori::ExternalTrigger g_other_trigger;
#ifdef MAMORI_BREAK
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
