// SPDX-License-Identifier: Apache-2.0
// Broken: an array of three elements for a sequence of two.
#include "mamori/kernel/payload/bounded_sequence.hpp"

#ifdef MAMORI_BREAK
inline constexpr mamori::BoundedSequence<int, 2> kNumbers = std::array{1, 2, 3};
#else
inline constexpr mamori::BoundedSequence<int, 3> kNumbers = std::array{1, 2, 3};
#endif
