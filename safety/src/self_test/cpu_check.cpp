// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/self_test/cpu_check.hpp"

namespace mamori::safety {

// The processor itself, compiled here for every target.
template class CpuCheck<NativeCpu>;

}  // namespace mamori::safety
