// SPDX-License-Identifier: Apache-2.0
// Alone in its file: a program that never calls it does not link the introspection.
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/run/introspection.hpp"

namespace mamori {

void Executive::set_introspection(Introspection* introspection) noexcept {
    MAMORI_REQUIRE(1, !is_busy_);
    detail::CoreState& core = life_.get_core();
    MAMORI_REQUIRE(2, introspection == nullptr || introspection->is_of(core.view));
    if (!life_.is_table_valid()) {
        life_.check_table();
    }
    core.introspection = introspection;
    life_.get_runner().prepare_work();
    show_windows();
}

}  // namespace mamori
