// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/reaction/safe_state.hpp"

namespace mamori::safety {

const char* get_name(SafeState state) noexcept {
    switch (state) {
        case SafeState::kSelfTest:
            return "SelfTest";
        case SafeState::kStandby:
            return "Standby";
        case SafeState::kOperational:
            return "Operational";
        case SafeState::kDegraded:
            return "Degraded";
        case SafeState::kProtectiveStopSs2:
            return "ProtectiveStopSs2";
        case SafeState::kProtectiveStopSs1:
            return "ProtectiveStopSs1";
        case SafeState::kStandstillHold:
            return "StandstillHold";
        case SafeState::kSafe:
            return "Safe";
        case SafeState::kLockedOut:
            return "LockedOut";
        case SafeState::kLockedHold:
            return "LockedHold";
    }
    return "Invalid";
}

const char* get_name(SafeStateEvent event) noexcept {
    switch (event) {
        case SafeStateEvent::kLockOut:
            return "LockOut";
        case SafeStateEvent::kSelfTestFailed:
            return "SelfTestFailed";
        case SafeStateEvent::kDemandSto:
            return "DemandSto";
        case SafeStateEvent::kDemandSs1:
            return "DemandSs1";
        case SafeStateEvent::kBrakesFailed:
            return "BrakesFailed";
        case SafeStateEvent::kStopTimeout:
            return "StopTimeout";
        case SafeStateEvent::kDemandSs2:
            return "DemandSs2";
        case SafeStateEvent::kStandstillConfirmed:
            return "StandstillConfirmed";
        case SafeStateEvent::kDegrade:
            return "Degrade";
        case SafeStateEvent::kReset:
            return "Reset";
        case SafeStateEvent::kRestore:
            return "Restore";
        case SafeStateEvent::kSelfTestPassed:
            return "SelfTestPassed";
        case SafeStateEvent::kStart:
            return "Start";
    }
    return "Invalid";
}

}  // namespace mamori::safety
