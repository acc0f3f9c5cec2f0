// SPDX-License-Identifier: Apache-2.0
// Broken: an enumerator of another enumeration has the number of the declared fault.
#include "parts.hpp"

enum class OtherFault { kDoorOpen };
#ifdef MAMORI_BREAK
constexpr auto kAnswered = OtherFault::kDoorOpen;
#else
constexpr auto kAnswered = Fault::kOverspeed;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::faults<Fault::kOverspeed>(), mamori::react(kAnswered, Reaction::kSto, mamori::within(1_ms)));
MAMORI_CHECK(kSystem);
