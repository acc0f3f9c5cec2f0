// SPDX-License-Identifier: Apache-2.0
// Broken: a worst case below zero would make room for another one.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr mamori::Duration kFirst{-1};
#else
constexpr mamori::Duration kFirst{0};
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("sense", 0_us, 100_us, mamori::budget(50_us),
                                        mamori::run(mamori::worst_case(g_producer, kFirst),
                                                    mamori::worst_case(g_second_producer, 50_us))));
MAMORI_CHECK(kSystem);
