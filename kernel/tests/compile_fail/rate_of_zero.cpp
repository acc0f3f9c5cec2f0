// SPDX-License-Identifier: Apache-2.0
// Broken: a window that opens is not run zero times per second.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr mamori::Rate kRate = 0_hz;
#else
constexpr mamori::Rate kRate = 1000_hz;
#endif
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::window("sense", 0_us, 100_us, mamori::rate(kRate),
                                                       mamori::budget(50_us), mamori::run(g_producer)));
MAMORI_CHECK(kSystem);
