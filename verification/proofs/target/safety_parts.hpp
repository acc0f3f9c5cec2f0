// SPDX-License-Identifier: Apache-2.0
/// @file
/// Parts of the safety layer that the arm does not use, in the image so that the proofs cover them too.
#ifndef MAMORI_VERIFICATION_PROOFS_TARGET_SAFETY_PARTS_HPP
#define MAMORI_VERIFICATION_PROOFS_TARGET_SAFETY_PARTS_HPP

#include "mamori/kernel/base/status.hpp"

namespace proof {

/// Calls each of them once, and tests the processor. @return kOk; kError (one of them returned a wrong
/// result).
mamori::Status prepare_safety_parts() noexcept;

}  // namespace proof

#endif  // MAMORI_VERIFICATION_PROOFS_TARGET_SAFETY_PARTS_HPP
