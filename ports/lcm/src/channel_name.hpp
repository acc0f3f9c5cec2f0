// SPDX-License-Identifier: Apache-2.0
/// @file
/// Which names of channels every transport of LCM messages accepts. Not for users.
///
/// @satisfies SWR-LCM-010      Design: docs/design/lcm.md#transports
#ifndef MAMORI_PORTS_LCM_CHANNEL_NAME_HPP
#define MAMORI_PORTS_LCM_CHANNEL_NAME_HPP

namespace mamori::ports::lcm::detail {

/// Whether `name` has 1 to 63 characters without a meaning in the regular expressions of liblcm.
bool is_channel_name(const char* name) noexcept;

}  // namespace mamori::ports::lcm::detail

#endif  // MAMORI_PORTS_LCM_CHANNEL_NAME_HPP
