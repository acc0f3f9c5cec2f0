// SPDX-License-Identifier: Apache-2.0
/// @file
/// What every port promises of memory that outlives the program: what was stored is there again, after an
/// orderly end and after a crash, and a region that is refused is left as it is.
///
/// @satisfies SWR-CNF-007      Design: docs/design/conformance.md#storage
#ifndef MAMORI_PORTS_CONFORMANCE_STORAGE_CONTRACT_HPP
#define MAMORI_PORTS_CONFORMANCE_STORAGE_CONTRACT_HPP

#include <cstddef>
#include <functional>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/ports/conformance/trial.hpp"

namespace mamori::ports::conformance {

/// One place for a region, which is empty at first.
class StorageRig {
  public:
    StorageRig() = default;
    virtual ~StorageRig() = default;
    StorageRig(const StorageRig&) = delete;
    StorageRig& operator=(const StorageRig&) = delete;

    /// Opens the region, or makes it. @param[in] size [byte]; 0 is refused as kBadParameter.
    /// @return kOk; kPreconditionNotMet (open already); else why not.
    virtual Status open(std::size_t size) = 0;
    virtual void close() = 0;
    /// Empty while closed.
    virtual Span<std::byte> get_region() = 0;

    /// Another user asks for the same region, and gives it back if it gets it. @return what it was answered.
    virtual Status open_as_another(std::size_t size) = 0;

    /// A program of its own opens the region, runs `write` on it, and ends there as by a power switch or a
    /// kill: nothing is closed. Called while closed.
    virtual void crash(std::size_t size, const std::function<void(Span<std::byte>)>& write) = 0;
};

/// @param[in] make_rig a new port each time. @return the trials, for the runners of rule_runner.hpp.
TrialFactory make_storage_trials(RigFactory<StorageRig> make_rig);

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_STORAGE_CONTRACT_HPP
