// SPDX-License-Identifier: Apache-2.0
// Broken: reactions of two enumerations share their numbers.
#include "parts.hpp"

enum class OtherReaction { kBeep };
#ifdef MAMORI_BREAK
constexpr auto kSecond = OtherReaction::kBeep;
#else
constexpr auto kSecond = Reaction::kSs1;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::faults<Fault::kOverspeed, Fault::kTrackingLost>(),
    mamori::react(Fault::kOverspeed, Reaction::kSto, mamori::within(1_ms)),
    mamori::react(Fault::kTrackingLost, kSecond, mamori::within(1_ms)));
MAMORI_CHECK(kSystem);
