// SPDX-License-Identifier: Apache-2.0
/// @file
/// Every code that an action can answer with.
#ifndef MAMORI_KERNEL_TESTS_SUPPORT_EVERY_STATUS_HPP
#define MAMORI_KERNEL_TESTS_SUPPORT_EVERY_STATUS_HPP

#include <array>

#include "mamori/kernel/base/status.hpp"

namespace mamori::testing_support {

inline constexpr std::array<Status, 6> kEveryStatus{
    Status::kOk,          Status::kError,          Status::kBadParameter,
    Status::kUnsupported, Status::kOutOfResources, Status::kPreconditionNotMet};

}  // namespace mamori::testing_support

#endif  // MAMORI_KERNEL_TESTS_SUPPORT_EVERY_STATUS_HPP
