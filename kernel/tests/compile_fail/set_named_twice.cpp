// SPDX-License-Identifier: Apache-2.0
// Broken: two sets have one name.
#include "parameter_parts.hpp"

#ifdef MAMORI_BREAK
constexpr const char* kName = "slow";
#else
constexpr const char* kName = "fast";
#endif
constexpr auto kConfiguration = mamori::configuration(
    mamori::parameters_of(g_axis), mamori::configuration_set("slow"), mamori::configuration_set(kName));
MAMORI_CHECK_CONFIGURATION(kConfiguration);
