// SPDX-License-Identifier: Apache-2.0
// Broken: an input has two sources.
#include "parts.hpp"

constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms),
                   mamori::window("w", 0_us, 100_us, mamori::budget(50_us),
                                  mamori::run(g_producer, g_second_producer, g_consumer)),
                   mamori::connect(g_producer.real, g_consumer.in)
#ifdef MAMORI_BREAK
                       ,
                   mamori::connect(g_second_producer.real, g_consumer.in)
#endif
    );
MAMORI_CHECK(kSystem);
