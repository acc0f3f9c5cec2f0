// SPDX-License-Identifier: Apache-2.0
/// @file
/// Which processor a run by the clock takes.
#ifndef MAMORI_TIME_FAULTS_PROCESSOR_HPP
#define MAMORI_TIME_FAULTS_PROCESSOR_HPP

namespace mamori::time_faults {

/// @return number of the first processor that this process might use when it was asked first.
int find_processor() noexcept;

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_PROCESSOR_HPP
