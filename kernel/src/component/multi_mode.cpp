// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/component/multi_mode.hpp"

#include "mamori/kernel/component/execution_context.hpp"

namespace mamori {

bool ModeSwitch::has(const Mode& mode) const noexcept {
    bool is_own = false;
    for (const Mode* own : modes_) {
        is_own = is_own || own == &mode;
    }
    return is_own;
}

void ModeSwitch::commit(const Mode& mode) noexcept {
    current_ = &mode;
    pending_ = nullptr;
}

bool ModeSwitch::take_change() noexcept {
    if (pending_ != nullptr) {
        commit(*pending_);
    }
    const bool is_untold = told_ != current_;
    told_ = current_;
    return is_untold;
}

const Mode* MultiModeComponent::get_current_mode_in_context(const ExecutionContext& context) const noexcept {
    return context_ == &context ? switch_.get_current() : nullptr;
}

const Mode* MultiModeComponent::get_pending_mode_in_context(const ExecutionContext& context) const noexcept {
    return context_ == &context ? switch_.get_pending() : nullptr;
}

Status MultiModeComponent::set_mode(const Mode& mode, bool immediate, Instant now) noexcept {
    if (!switch_.has(mode)) {
        return Status::kBadParameter;
    }
    if (context_ == nullptr) {
        switch_.wish(mode);
        static_cast<void>(switch_.take_change());
        return Status::kOk;
    }
    turn_ |= kModeNotice;
    if (!immediate) {
        switch_.wish(mode);
        return Status::kOk;
    }
    switch_.commit(mode);
    return context_->tell_mode(*this, now);
}

}  // namespace mamori
