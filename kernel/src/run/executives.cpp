// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/run/executives.hpp"

namespace mamori {

/// @param[in] guards none, or one span with a guard per core.
template <typename... Guards>
Status ExecutiveGroup::start_by(const Guards&... guards) noexcept {
    failed_core_ = kNoIndex;
    for (std::size_t core = initialized_count_; core < executives_.size(); ++core) {
        const Status status = executives_[core]->initialize(*guards[core]...);
        if (status != Status::kOk) {
            failed_core_ = core;
            return status;
        }
        initialized_count_ = core + 1U;
    }
    Status status = Status::kOk;
    for (std::size_t core = 0U; core < executives_.size() && status == Status::kOk; ++core) {
        status = executives_[core]->start(*guards[core]...);
        if (status != Status::kOk) {
            failed_core_ = core;
            static_cast<void>(stop_by(guards...));
        }
    }
    return status;
}

template <typename... Guards>
Status ExecutiveGroup::stop_by(const Guards&... guards) noexcept {
    Status result = Status::kOk;
    for (std::size_t core = executives_.size(); core > 0U; --core) {
        const Status status = executives_[core - 1U]->stop(*guards[core - 1U]...);
        result = result == Status::kOk ? status : result;
    }
    return result;
}

Status ExecutiveGroup::start() noexcept {
    return start_by();
}

Status ExecutiveGroup::start(Span<ActionGuard* const> guards) noexcept {
    return start_by(guards);
}

Status ExecutiveGroup::stop() noexcept {
    return stop_by();
}

Status ExecutiveGroup::stop(Span<ActionGuard* const> guards) noexcept {
    return stop_by(guards);
}

}  // namespace mamori
