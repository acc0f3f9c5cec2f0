// SPDX-License-Identifier: Apache-2.0
// Broken: a system has one abort policy.
#include "parts.hpp"

#ifdef MAMORI_BREAK
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::abort_policy(mamori::AbortPolicy::kOpenRtmCompat),
                   mamori::abort_policy(mamori::AbortPolicy::kSpecOnly),
                   mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)));
#else
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms), mamori::abort_policy(mamori::AbortPolicy::kOpenRtmCompat),
                   mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)));
#endif
MAMORI_CHECK(kSystem);
