// SPDX-License-Identifier: Apache-2.0
// Broken: an enumeration is encoded although nothing tells which of its values exist.
#include "mamori/kernel/payload/cdr.hpp"

enum class Mode { kIdle, kRun };
#ifndef MAMORI_BREAK
MAMORI_LAST_ENUMERATOR(Mode, kRun)
#endif
inline constexpr std::size_t kSize = mamori::max_encoded_size<Mode>();
