// SPDX-License-Identifier: Apache-2.0
// Broken: a set gives one parameter two values.
#include "parameter_parts.hpp"

constexpr auto kConfiguration = mamori::configuration(
    mamori::parameters_of(g_axis), mamori::configuration_set("fast", mamori::assign(g_axis.speed, 1.0)
#ifdef MAMORI_BREAK
                                                                         ,
                                                             mamori::assign(g_axis.speed, 2.0)
#endif
                                                                 ));
MAMORI_CHECK_CONFIGURATION(kConfiguration);
