// SPDX-License-Identifier: Apache-2.0
// Broken: a window opens every 300 us of a frame of 1 ms.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr mamori::Duration kPeriod = 300_us;
#else
constexpr mamori::Duration kPeriod = 250_us;
#endif
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::window("sense", 0_us, 100_us, mamori::every(kPeriod),
                                                       mamori::budget(50_us), mamori::run(g_producer)));
MAMORI_CHECK(kSystem);
