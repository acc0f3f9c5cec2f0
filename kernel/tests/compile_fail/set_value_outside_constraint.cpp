// SPDX-License-Identifier: Apache-2.0
// Broken: the second value of the second set is beyond its limit.
#include "parameter_parts.hpp"

#ifdef MAMORI_BREAK
constexpr double kSpeed = 3.1;
#else
constexpr double kSpeed = 3.0;
#endif
constexpr auto kConfiguration = mamori::configuration(
    mamori::parameters_of(g_axis), mamori::configuration_set("normal"),
    mamori::configuration_set("fast", mamori::assign(g_axis.gain, 1), mamori::assign(g_axis.speed, kSpeed)));
MAMORI_CHECK_CONFIGURATION(kConfiguration);
