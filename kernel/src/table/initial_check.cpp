// SPDX-License-Identifier: Apache-2.0
// Alone in its file: a program that never calls it does not link it.
// @satisfies SWR-KRN-025, SWR-KRN-070
#include "mamori/kernel/table/initial_check.hpp"

namespace mamori::detail {

Finding check_everything(const SystemView& view) noexcept {
    return check(view);
}

}  // namespace mamori::detail
