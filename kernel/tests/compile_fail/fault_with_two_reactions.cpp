// SPDX-License-Identifier: Apache-2.0
// Broken: a declared fault leads to two reactions.
#include "parts.hpp"

constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::faults<Fault::kOverspeed>(),
#ifdef MAMORI_BREAK
                   mamori::react(Fault::kOverspeed, Reaction::kSto, mamori::within(20_ms)),
#endif
                   mamori::react(Fault::kOverspeed, Reaction::kSs1, mamori::within(20_ms)));
MAMORI_CHECK(kSystem);
