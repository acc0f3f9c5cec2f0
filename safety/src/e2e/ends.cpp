// SPDX-License-Identifier: Apache-2.0
// Both ends of each profile, so that the proofs about the library (symbols, stack, controller's compiler) see
// what a user's program will hold. Nothing refers to this object, so no program takes its tables along.
#include "mamori/safety/e2e/e2e.hpp"

namespace mamori::safety {

template class E2eProtector<E2eProfile01<>>;
template class E2eProtector<E2eProfile02<>>;
template class E2eProtector<E2eProfile04<>>;
template class E2eProtector<E2eProfile05<>>;
template class E2eProtector<E2eProfile06<>>;
template class E2eProtector<E2eProfile07<>>;
template class E2eProtector<E2eProfile08<>>;
template class E2eProtector<E2eProfile11<>>;
template class E2eProtector<E2eProfile22<>>;
template class E2eProtector<E2eProfile44<>>;

template class E2eChecker<E2eProfile01<>>;
template class E2eChecker<E2eProfile02<>>;
template class E2eChecker<E2eProfile04<>>;
template class E2eChecker<E2eProfile05<>>;
template class E2eChecker<E2eProfile06<>>;
template class E2eChecker<E2eProfile07<>>;
template class E2eChecker<E2eProfile08<>>;
template class E2eChecker<E2eProfile11<>>;
template class E2eChecker<E2eProfile22<>>;
template class E2eChecker<E2eProfile44<>>;
template class E2eChecker<E2eProfile01<>, HardenedSequence>;
template class E2eChecker<E2eProfile04<>, HardenedSequence>;
template class E2eChecker<E2eProfile04<1U>, HardenedSequence>;
template class E2eChecker<E2eProfile04<0U>, HardenedSequence>;

}  // namespace mamori::safety
