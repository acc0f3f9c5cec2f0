// SPDX-License-Identifier: Apache-2.0
/// @file
/// Result of a configuration check: the violated rule and the faulty assignment.
///
/// @satisfies SWR-PAR-006      Design: docs/design/parameters.md#configuration-sets
#ifndef MAMORI_KERNEL_CONFIGURATION_FINDING_HPP
#define MAMORI_KERNEL_CONFIGURATION_FINDING_HPP

#include <cstddef>
#include <cstdint>

namespace mamori {

/// Why a configuration is rejected.
enum class ConfigurationRule : std::uint8_t {
    kNone,                    ///< no rule is violated
    kSetNamedTwice,           ///< an earlier set has the same name
    kUnknownParameter,        ///< the parameter belongs to no component of the table
    kParameterAssignedTwice,  ///< the set assigns a value to the parameter twice
    kValueOutsideConstraint,  ///< the value violates the constraint of the parameter
    kParameterRowInvalid,     ///< parameter row without parameter or owner; `set` is its index
    kSetRowInvalid,           ///< set without name, or assignment without parameter or valid range of values
};

/// A violated rule and its location. `set` is a row of the table; `assignment` counts within the set.
struct ConfigurationFinding {
    ConfigurationRule rule{ConfigurationRule::kNone};
    std::size_t set{0U};
    std::size_t assignment{0U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_CONFIGURATION_FINDING_HPP
