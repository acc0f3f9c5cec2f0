// SPDX-License-Identifier: Apache-2.0
/// @file
/// Parts of the kernel that the arm does not use, in the image so that the proofs cover them too.
#ifndef MAMORI_VERIFICATION_PROOFS_TARGET_OTHER_PARTS_HPP
#define MAMORI_VERIFICATION_PROOFS_TARGET_OTHER_PARTS_HPP

#include "mamori/kernel/base/status.hpp"

namespace proof {

/// @param[in] set_name configuration set to begin with. @return kOk; otherwise the status of the first part
/// that rejected its input.
mamori::Status prepare_other_parts(const char* set_name) noexcept;

}  // namespace proof

#endif  // MAMORI_VERIFICATION_PROOFS_TARGET_OTHER_PARTS_HPP
