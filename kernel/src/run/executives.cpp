// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/run/executives.hpp"

namespace mamori {

Status ExecutiveGroup::initialize() noexcept {
    for (std::size_t core = initialized_count_; core < executives_.size(); ++core) {
        const Status status = executives_[core]->initialize();
        if (status != Status::kOk) {
            failed_core_ = core;
            return status;
        }
        initialized_count_ = core + 1U;
    }
    return Status::kOk;
}

Status ExecutiveGroup::start() noexcept {
    failed_core_ = kNoIndex;
    Status status = initialize();
    for (std::size_t core = 0U; core < executives_.size() && status == Status::kOk; ++core) {
        status = executives_[core]->start();
        if (status != Status::kOk) {
            failed_core_ = core;
            static_cast<void>(stop());
        }
    }
    return status;
}

Status ExecutiveGroup::stop() noexcept {
    Status result = Status::kOk;
    for (std::size_t core = executives_.size(); core > 0U; --core) {
        const Status status = executives_[core - 1U]->stop();
        result = result == Status::kOk ? status : result;
    }
    return result;
}

}  // namespace mamori
