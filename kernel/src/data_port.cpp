// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/data_port.hpp"

namespace mamori {

bool OutPortBase::publish(Instant now) noexcept {
    if (!is_staged_) {
        return false;
    }
    copy_staged_(*this);
    published_at_ = now;
    published_revision_ = revision_;
    ++sequence_;
    is_staged_ = false;
    return true;
}

void OutPortBase::hash_into(TraceHash& hash) const noexcept {
    hash(sequence_);
    hash(published_at_.ns);
    hash_published_(*this, hash);
}

}  // namespace mamori
