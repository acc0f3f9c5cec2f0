// SPDX-License-Identifier: Apache-2.0
/// @file
/// Writes an inconclusive real-time result into the running GoogleTest: skipped, with the properties
/// `verdict` and `figure`.
///
/// @satisfies SWR-VER-023      Design: docs/design/test_strength.md#real-time-verdicts
#ifndef MAMORI_VERIFICATION_REAL_TIME_RESULT_HPP
#define MAMORI_VERIFICATION_REAL_TIME_RESULT_HPP

#include <gtest/gtest.h>

#include <string>

namespace mamori::verification {

/// Call last in a test. @param[in] figure what the host did.
inline void report_inconclusive(const std::string& figure) {
    ::testing::Test::RecordProperty("verdict", "inconclusive");
    ::testing::Test::RecordProperty("figure", figure);
    GTEST_SKIP() << "verdict=inconclusive: " << figure;
}

}  // namespace mamori::verification

#endif  // MAMORI_VERIFICATION_REAL_TIME_RESULT_HPP
