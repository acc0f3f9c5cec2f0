// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/dataflow/data_port.hpp"

namespace mamori {

void OutPortBase::hash_into(TraceHash& hash) const noexcept {
    hash(sequence_);
    hash(published_at_.ns);
    hash_published_(*this, hash);
}

}  // namespace mamori
