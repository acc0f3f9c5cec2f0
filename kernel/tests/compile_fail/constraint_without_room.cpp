// SPDX-License-Identifier: Apache-2.0
// Broken: a constraint has one choice more than the parameter has room for.
#include "parameter_parts.hpp"

#ifdef MAMORI_BREAK
MAMORI_CONSTINIT mamori::Parameter<int> g_baud{"baud", 9600, "(2400,4800,9600,19200,38400)"};
#else
MAMORI_CONSTINIT mamori::Parameter<int, 5U> g_baud{"baud", 9600, "(2400,4800,9600,19200,38400)"};
#endif
