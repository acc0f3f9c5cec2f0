// SPDX-License-Identifier: Apache-2.0
// What the compiler cannot see of a table that it has checked.
// @satisfies SWR-KRN-070
#include <array>

#include "mamori/kernel/table/initial_check.hpp"

namespace mamori::detail {
namespace {

/// Functions that the compiler assumes to be set, see is_function().
void check_functions(const SystemView& view, FindingList& findings) noexcept {
    for (std::size_t i = 0U; i < view.ports.size(); ++i) {
        if (view.ports[i].count == nullptr) {
            findings.add(Rule::kPortRowInvalid, i);
        }
    }
    for (std::size_t i = 0U; i < view.connections.size(); ++i) {
        const ConnectionOperations& operations = view.connections[i].operations;
        if (operations.latch == nullptr || operations.restart == nullptr) {
            findings.add(Rule::kConnectionRowInvalid, i);
        }
    }
}

}  // namespace

Finding check_objects(const SystemView& view) noexcept {
    std::array<Finding, 1U> first{};
    FindingList findings{first};
    check_functions(view, findings);
    for (std::size_t i = 0U; i < view.components.size(); ++i) {
        check_component_name(view, i, findings);
        check_ports_of(view, i, findings);
        if (view.components[i]->get_first(MemberKind::kParameter) != nullptr) {
            findings.add(Rule::kParameterNotListed, i);
        }
    }
    return first[0];
}

Finding check_objects_with_parameters(const SystemView& view) noexcept {
    std::array<Finding, 1U> first{};
    FindingList findings{first};
    check_functions(view, findings);
    check_parameter_rows(view, findings);
    for (std::size_t i = 0U; findings.get_count() == 0U && i < view.components.size(); ++i) {
        check_component_name(view, i, findings);
        check_ports_of(view, i, findings);
        check_parameters_of(view, i, findings);
    }
    return first[0];
}

}  // namespace mamori::detail
