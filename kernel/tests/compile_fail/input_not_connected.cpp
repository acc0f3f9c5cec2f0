// SPDX-License-Identifier: Apache-2.0
// Broken: a mandatory input has no source.
#include "parts.hpp"

constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("w", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer, g_consumer))
#ifndef MAMORI_BREAK
        ,
    mamori::connect(g_producer.real, g_consumer.in)
#endif
);
MAMORI_CHECK(kSystem);
