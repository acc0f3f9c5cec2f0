// SPDX-License-Identifier: Apache-2.0
// Broken: a literal of four characters for a string of three.
#include "mamori/kernel/payload/bounded_string.hpp"

#ifdef MAMORI_BREAK
inline constexpr mamori::BoundedString<3> kName = "four";
#else
inline constexpr mamori::BoundedString<4> kName = "four";
#endif
