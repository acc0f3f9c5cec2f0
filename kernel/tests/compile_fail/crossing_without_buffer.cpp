// SPDX-License-Identifier: Apache-2.0
// Broken: a connection leaves its core with nothing in between.
#include "parts.hpp"

constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("sense", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::window("plan", 100_us, 100_us, mamori::core(1), mamori::budget(50_us), mamori::run(g_consumer)),
#ifdef MAMORI_BREAK
    mamori::connect(g_producer.real, g_consumer.in));
#else
    mamori::connect(g_producer.real, g_consumer.in, mamori::through(g_crossing)));
#endif
MAMORI_CHECK(kSystem);
