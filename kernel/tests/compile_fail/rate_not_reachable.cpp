// SPDX-License-Identifier: Apache-2.0
// Broken: 400 Hz is not reached by leaving out openings of 1000 Hz.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr mamori::Rate kSlower = 400_hz;
#else
constexpr mamori::Rate kSlower = 500_hz;
#endif
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::window("sense", 0_us, 100_us, mamori::rate(1000_hz, kSlower),
                                                       mamori::budget(50_us), mamori::run(g_producer)));
MAMORI_CHECK(kSystem);
