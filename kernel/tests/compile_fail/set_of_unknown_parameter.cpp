// SPDX-License-Identifier: Apache-2.0
// Broken: a set assigns a parameter of a component that the configuration does not list.
#include "parameter_parts.hpp"

constexpr auto kConfiguration = mamori::configuration(
#ifdef MAMORI_BREAK
    mamori::parameters_of(g_axis),
#else
    mamori::parameters_of(g_axis, g_second_axis),
#endif
    mamori::configuration_set("fast", mamori::assign(g_second_axis.speed, 1.0)));
MAMORI_CHECK_CONFIGURATION(kConfiguration);
