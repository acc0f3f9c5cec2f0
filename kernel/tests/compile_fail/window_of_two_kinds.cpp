// SPDX-License-Identifier: Apache-2.0
// Broken: what releases the cycles of a window is one thing.
#include "mamori/kernel/component/external_trigger.hpp"
#include "parts.hpp"

inline mamori::ExternalTrigger g_trigger;
#ifdef MAMORI_BREAK
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
