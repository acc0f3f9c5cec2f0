// SPDX-License-Identifier: Apache-2.0
// Shows that headers, libraries and CMake targets of the installed package fit together. Exit status 0 if
// they do.
#include <cstdio>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/arm/arm_device.hpp"
#include "mamori/version.hpp"

static_assert(MAMORI_VERSION ==
              mamori::kVersionMajor * 10000 + mamori::kVersionMinor * 100 + mamori::kVersionPatch);

namespace {

/// Maximum torque that the consumer requests from a joint [N m].
constexpr double kTorqueMaxNm = 10.0;

/// Copies a torque for `joint` to the outputs.
/// @return kOk; kBadParameter if there is no such joint or the torque exceeds kTorqueMaxNm.
mamori::Status set_torque(mamori::safety::ArmOutputs& outputs, std::size_t joint, double torque_nm) {
    if (joint >= outputs.torque_nm.size() || !(torque_nm >= -kTorqueMaxNm && torque_nm <= kTorqueMaxNm)) {
        return mamori::Status::kBadParameter;
    }
    outputs.torque_nm[joint] = torque_nm;
    return mamori::Status::kOk;
}

}  // namespace

int main() {
    using namespace mamori::literals;
    mamori::safety::ArmOutputs outputs;
    // Calls code of the kernel library, not only of its headers: the linker must have found the library.
    mamori::set_assertion_handler(nullptr);

    const bool is_safe_by_default = !outputs.torque_enable && !outputs.brake_release;
    const mamori::Status inside = set_torque(outputs, 0U, 1.0);
    const mamori::Status outside = set_torque(outputs, mamori::safety::kArmJointCount, 1.0);
    std::printf("mamori %s\n", mamori::kVersionText);
    std::printf("frame %lld ns, torque on joint 1: %s, on joint 8: %s\n", static_cast<long long>((1_ms).ns),
                mamori::get_name(inside), mamori::get_name(outside));
    return is_safe_by_default && inside == mamori::Status::kOk && outside == mamori::Status::kBadParameter
               ? 0
               : 1;
}
