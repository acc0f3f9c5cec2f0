// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/notice/survival_notifier.hpp"

#include "mamori/kernel/base/text.hpp"

namespace mamori::safety::detail {

bool have_names(Span<Component* const> components, Span<const char* const> names) noexcept {
    if (components.size() != names.size()) {
        return false;
    }
    for (std::size_t i = 0U; i < components.size(); ++i) {
        if (!(make_text(components[i]->get_name()) == make_text(names[i]))) {
            return false;
        }
    }
    return true;
}

void report_components(Span<Component* const> components, const ExecutionSupervisor& supervision,
                       Span<std::uint8_t> bytes) noexcept {
    for (std::size_t i = 0U; i < components.size(); ++i) {
        bytes[i] = to_byte({supervision.get_state(i), supervision.get_local_status(i)});
    }
}

}  // namespace mamori::safety::detail
