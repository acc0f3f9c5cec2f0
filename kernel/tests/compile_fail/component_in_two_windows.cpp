// SPDX-License-Identifier: Apache-2.0
// Broken: a component runs in two windows.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr Producer& kSecond = g_producer;
#else
constexpr Producer& kSecond = g_second_producer;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::window("b", 100_us, 100_us, mamori::budget(50_us), mamori::run(kSecond)));
MAMORI_CHECK(kSystem);
