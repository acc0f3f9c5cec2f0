// SPDX-License-Identifier: Apache-2.0
// The connection of a build without liblcm: it cannot be opened, and says why.
#include "mamori/ports/lcm/lcm_link.hpp"

namespace mamori::ports::lcm {

Status LcmLink::open(const char* /*url*/) noexcept {
    fault_ = LinkFault::kUnsupported;
    return Status::kUnsupported;
}

void LcmLink::close() noexcept {}

Status LcmLink::publish(const char* /*channel*/, Span<const std::byte> /*message*/) noexcept {
    return Status::kPreconditionNotMet;
}

}  // namespace mamori::ports::lcm
