// SPDX-License-Identifier: Apache-2.0
// Broken: a limit is one more than the type of the parameter can hold.
#include "parameter_parts.hpp"

#ifdef MAMORI_BREAK
MAMORI_CONSTINIT mamori::Parameter<std::uint8_t> g_retries{"retries", 3U, "x<=256"};
#else
MAMORI_CONSTINIT mamori::Parameter<std::uint8_t> g_retries{"retries", 3U, "x<=255"};
#endif
