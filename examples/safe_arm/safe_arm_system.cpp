// SPDX-License-Identifier: Apache-2.0
#include "safe_arm_system.hpp"

namespace safe_arm {

mamori::Status watch_components() noexcept {
    using mamori::safety::SupervisionScope;
    struct Row {
        std::size_t component;
        mamori::Duration longest;
        SupervisionScope scope;
    };
    constexpr std::array<Row, 5U> kRows{{{kReaderIndex, kSafetyComponentMax, SupervisionScope::kGlobal},
                                         {kMonitorIndex, kSafetyComponentMax, SupervisionScope::kGlobal},
                                         {kSupervisorIndex, kSafetyComponentMax, SupervisionScope::kGlobal},
                                         {kGateIndex, kSafetyComponentMax, SupervisionScope::kGlobal},
                                         {kControllerIndex, kControllerMax, SupervisionScope::kLocal}}};
    for (const Row& row : kRows) {
        const mamori::Status result =
            supervision.watch(row.component, {kAliveLimits, {mamori::Duration{0}, row.longest}, row.scope});
        if (result != mamori::Status::kOk) {
            return result;
        }
    }
    return mamori::Status::kOk;
}

}  // namespace safe_arm
