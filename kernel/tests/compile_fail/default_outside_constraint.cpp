// SPDX-License-Identifier: Apache-2.0
// Broken: a default lies below the lower limit.
#include "parameter_parts.hpp"

#ifdef MAMORI_BREAK
constexpr double kDefault = 0.09;
#else
constexpr double kDefault = 0.1;
#endif
MAMORI_CONSTINIT mamori::Parameter<double> g_limit{"limit", kDefault, "0.1<=x<=3.0"};
