// SPDX-License-Identifier: Apache-2.0
/// @file
/// Finds what a user may have meant by a misspelt word.
#ifndef MAMORI_SIMBODY_SIM_NEAREST_NAME_HPP
#define MAMORI_SIMBODY_SIM_NEAREST_NAME_HPP

#include <string_view>
#include <vector>

namespace mamori::sim {

/// @return the element of `names` with the smallest edit distance to `word`, the first of equals.
/// @param[in] names not empty.
std::string_view find_nearest_name(std::string_view word, const std::vector<std::string_view>& names);

}  // namespace mamori::sim

#endif  // MAMORI_SIMBODY_SIM_NEAREST_NAME_HPP
