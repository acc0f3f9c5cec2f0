// SPDX-License-Identifier: Apache-2.0
// Broken: a configuration set that nobody can ask for.
#include "parameter_parts.hpp"

#ifdef MAMORI_BREAK
constexpr const char* kName = nullptr;
#else
constexpr const char* kName = "slow";
#endif
constexpr auto kConfiguration =
    mamori::configuration(mamori::parameters_of(g_axis), mamori::configuration_set(kName));
MAMORI_CHECK_CONFIGURATION(kConfiguration);
