// SPDX-License-Identifier: Apache-2.0
/// @file
/// Defects that a campaign program seeds in the software under test, to show that its run then fails.
#ifndef MAMORI_VERIFICATION_SEEDED_DEFECT_HPP
#define MAMORI_VERIFICATION_SEEDED_DEFECT_HPP

#include <cstdint>

namespace mamori::verification {

enum class Defect : std::uint8_t {
    kNone,
    kLateRelease,  ///< a window starts too late, or outputs close too late
    kOverrun,      ///< a component computes for longer than its budget
    kWrongName     ///< a report names another component or fault
};
inline constexpr std::size_t kDefectCount{4U};
/// Frames between two seeded defects.
inline constexpr std::uint64_t kDefectEvery{41U};

const char* get_name(Defect defect) noexcept;
/// Removes `--defect NAME` from the end of the arguments. @param[in,out] count of the arguments. @return
/// false for an unknown name.
bool take_defect(int& count, char** arguments, Defect& defect) noexcept;

}  // namespace mamori::verification

#endif  // MAMORI_VERIFICATION_SEEDED_DEFECT_HPP
