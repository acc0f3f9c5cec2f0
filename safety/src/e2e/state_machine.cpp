// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/e2e/state_machine.hpp"

namespace mamori::safety {

inline void ChannelStateMachine::note(ProfileStatus status) noexcept {
    window_[next_] = status;
    next_ = next_ + 1U == window_.size() ? 0U : next_ + 1U;
    // Counted anew each time: a count that is carried along would carry a bit flip along, too.
    std::size_t ok_count = 0U;
    std::size_t error_count = 0U;
    for (const ProfileStatus noted : window_) {
        ok_count += noted == ProfileStatus::kOk ? 1U : 0U;
        error_count += noted == ProfileStatus::kError ? 1U : 0U;
    }
    ok_count_ = ok_count;
    error_count_ = error_count;
}

inline bool ChannelStateMachine::meets(const WindowDemand& demand) const noexcept {
    return error_count_ <= demand.error_max && ok_count_ >= demand.ok_min;
}

inline ChannelState ChannelStateMachine::calc_next(ProfileStatus status) const noexcept {
    switch (state_) {
        case ChannelState::kNoData: {
            const bool has_frame = status != ProfileStatus::kError && status != ProfileStatus::kNoNewData;
            return has_frame ? ChannelState::kInit : ChannelState::kNoData;
        }
        case ChannelState::kInit:
            if (error_count_ > demands_.in_init.error_max) {
                return ChannelState::kInvalid;
            }
            return meets(demands_.in_init) ? ChannelState::kValid : ChannelState::kInit;
        case ChannelState::kValid:
            return meets(demands_.in_valid) ? ChannelState::kValid : ChannelState::kInvalid;
        case ChannelState::kInvalid:
            return meets(demands_.in_invalid) ? ChannelState::kValid : ChannelState::kInvalid;
    }
    return ChannelState::kInvalid;  // only a corrupted state comes here
}

Status ChannelStateMachine::check(ProfileStatus status) noexcept {
    if (!is_ready_) {
        return Status::kPreconditionNotMet;
    }
    note(status);
    state_ = calc_next(status);
    return Status::kOk;
}

}  // namespace mamori::safety
