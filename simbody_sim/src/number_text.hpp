// SPDX-License-Identifier: Apache-2.0
/// @file
/// Numbers from and to text, without any locale.
#ifndef MAMORI_SIMBODY_SIM_SRC_NUMBER_TEXT_HPP
#define MAMORI_SIMBODY_SIM_SRC_NUMBER_TEXT_HPP

#include <string>
#include <string_view>

namespace mamori::sim::detail {

/// The whole text as a finite number. @return false when it is none; `number` is unchanged then.
bool try_parse_number(std::string_view text, double& number);
/// Shortest text that reads back as the same number.
std::string to_text(double number);

}  // namespace mamori::sim::detail

#endif  // MAMORI_SIMBODY_SIM_SRC_NUMBER_TEXT_HPP
