// SPDX-License-Identifier: Apache-2.0
// Broken: the second window opens one nanosecond before the first one closes.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr mamori::Duration kOffset = 100_us - 1_ns;
#else
constexpr mamori::Duration kOffset = 100_us;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::window("b", kOffset, 100_us, mamori::budget(50_us), mamori::run(g_second_producer)));
MAMORI_CHECK(kSystem);
