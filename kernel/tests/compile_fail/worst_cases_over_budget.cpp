// SPDX-License-Identifier: Apache-2.0
// Broken: two worst cases are 1 ns longer together than their budget.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr mamori::Duration kSecond = 20_us + 1_ns;
#else
constexpr mamori::Duration kSecond = 20_us;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("sense", 0_us, 100_us, mamori::budget(50_us),
                                        mamori::run(mamori::worst_case(g_producer, 30_us),
                                                    mamori::worst_case(g_second_producer, kSecond))));
MAMORI_CHECK(kSystem);
