// SPDX-License-Identifier: Apache-2.0
// Broken: the reader opens 1 ns before its writer on the other core closes.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr mamori::Duration kOffset = 100_us - 1_ns;
#else
constexpr mamori::Duration kOffset = 100_us;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("sense", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::window("plan", kOffset, 100_us, mamori::core(1), mamori::budget(50_us), mamori::run(g_consumer)),
    mamori::connect(g_producer.real, g_consumer.in, mamori::through(g_crossing)));
MAMORI_CHECK(kSystem);
