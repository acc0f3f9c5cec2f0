// SPDX-License-Identifier: Apache-2.0
// Broken: the second budget would silently replace the first.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::budget(60_us), mamori::run(g_producer)));
#else
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)));
#endif
MAMORI_CHECK(kSystem);
