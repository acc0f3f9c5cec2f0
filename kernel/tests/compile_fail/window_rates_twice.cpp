// SPDX-License-Identifier: Apache-2.0
// Broken: one rate(...) names all rates of a window; a second one would replace them.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms),
                   mamori::window("a", 0_us, 100_us, mamori::rate(1000_hz, 500_hz), mamori::rate(1000_hz),
                                  mamori::budget(50_us), mamori::run(g_producer)));
#else
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::rate(1000_hz, 500_hz),
                                                       mamori::budget(50_us), mamori::run(g_producer)));
#endif
MAMORI_CHECK(kSystem);
