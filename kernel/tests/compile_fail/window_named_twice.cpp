// SPDX-License-Identifier: Apache-2.0
// Broken: two windows of one name, which no report could tell apart.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr const char* kSecondName = "sense";
#else
constexpr const char* kSecondName = "act";
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("sense", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::window(kSecondName, 100_us, 100_us, mamori::budget(50_us), mamori::run(g_second_producer)));
MAMORI_CHECK(kSystem);
