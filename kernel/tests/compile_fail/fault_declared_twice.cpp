// SPDX-License-Identifier: Apache-2.0
// Broken: a fault that stands in the list of faults twice.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr auto kFaults = mamori::faults<Fault::kOverspeed, Fault::kOverspeed>();
#else
constexpr auto kFaults = mamori::faults<Fault::kOverspeed>();
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    kFaults, mamori::react(Fault::kOverspeed, Reaction::kSto, mamori::within(1_ms)));
MAMORI_CHECK(kSystem);
