// SPDX-License-Identifier: Apache-2.0
// Broken: a reaction has no time to come.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr mamori::Duration kLimit = 0_ms;
#else
constexpr mamori::Duration kLimit = 1_ns;
#endif
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::faults<Fault::kOverspeed>(),
                   mamori::react(Fault::kOverspeed, Reaction::kSs1, mamori::within(kLimit)));
MAMORI_CHECK(kSystem);
