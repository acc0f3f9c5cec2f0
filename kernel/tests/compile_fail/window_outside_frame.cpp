// SPDX-License-Identifier: Apache-2.0
// Broken: a window closes one nanosecond after its frame.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr mamori::Duration kLength = 1_ms + 1_ns;
#else
constexpr mamori::Duration kLength = 1_ms;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, kLength, mamori::budget(50_us), mamori::run(g_producer)));
MAMORI_CHECK(kSystem);
