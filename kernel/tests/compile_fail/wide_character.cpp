// SPDX-License-Identifier: Apache-2.0
// Broken: a character is encoded whose form on the wire depends on the peers.
#include "mamori/kernel/payload/cdr.hpp"

#ifdef MAMORI_BREAK
using Character = wchar_t;
#else
using Character = char;
#endif
inline constexpr std::size_t kSize = mamori::max_encoded_size<mamori::BoundedSequence<Character, 4>>();
