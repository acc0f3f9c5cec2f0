// SPDX-License-Identifier: Apache-2.0
/// @file
/// Contract of each port for memory that is retained after the end of the program: stored data is available
/// again after an orderly end and after a crash, and a rejected region is unchanged.
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

/// Test adapter for one region, which does not exist at first.
class StorageRig {
  public:
    StorageRig() = default;
    virtual ~StorageRig() = default;
    StorageRig(const StorageRig&) = delete;
    StorageRig& operator=(const StorageRig&) = delete;

    /// Opens or creates the region. @param[in] size [byte]; 0 is rejected as kBadParameter.
    /// @return kOk; kPreconditionNotMet (open already); another status with the cause.
    virtual Status open(std::size_t size) = 0;
    virtual void close() = 0;
    /// Empty while closed.
    virtual Span<std::byte> get_region() = 0;

    /// Opens the same region as another user, and closes it again on success. @return status of this open.
    virtual Status open_as_another(std::size_t size) = 0;

    /// A separate program opens the region, runs `write` on it, and ends as after a power loss or kill,
    /// without closing the region. Called while closed.
    virtual void crash(std::size_t size, const std::function<void(Span<std::byte>)>& write) = 0;
};

/// @param[in] make_rig returns a new port on each call.
/// @return the trials for the runners of rule_runner.hpp.
TrialFactory make_storage_trials(RigFactory<StorageRig> make_rig);

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_STORAGE_CONTRACT_HPP
