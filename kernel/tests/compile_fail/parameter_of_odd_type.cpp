// SPDX-License-Identifier: Apache-2.0
// Broken: a parameter is a pointer.
#include "parameter_parts.hpp"

#ifdef MAMORI_BREAK
mamori::Parameter<const char*> g_name{"name", "value"};
#else
mamori::Parameter<int> g_name{"name", 1};
#endif
