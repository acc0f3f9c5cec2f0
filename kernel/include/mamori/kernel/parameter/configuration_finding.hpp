// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a check of a configuration finds: the broken rule and the assignment that is guilty.
///
/// @satisfies SWR-PAR-006      Design: docs/design/parameters.md#configuration-sets
#ifndef MAMORI_KERNEL_CONFIGURATION_FINDING_HPP
#define MAMORI_KERNEL_CONFIGURATION_FINDING_HPP

#include <cstddef>
#include <cstdint>

namespace mamori {

/// Why a configuration is refused.
enum class ConfigurationRule : std::uint8_t {
    kNone,                    ///< the configuration keeps every rule
    kSetNamedTwice,           ///< the set has the name of one before it
    kUnknownParameter,        ///< the parameter belongs to no component of the table
    kParameterAssignedTwice,  ///< the set gives it a value twice
    kValueOutsideConstraint,  ///< the parameter may not have this value
    kParameterRowInvalid,     ///< row of `parameters` without a parameter or its owner; `set` is its place
    kSetRowInvalid,           ///< the set has no name, or the assignment or its values are not in the table
};

/// A broken rule and where: `set` is a row of the table, `assignment` counts within the set.
struct ConfigurationFinding {
    ConfigurationRule rule{ConfigurationRule::kNone};
    std::size_t set{0U};
    std::size_t assignment{0U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_CONFIGURATION_FINDING_HPP
