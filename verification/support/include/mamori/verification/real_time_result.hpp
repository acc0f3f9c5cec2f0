// SPDX-License-Identifier: Apache-2.0
/// @file
/// Writes the verdict of a real-time run into the running GoogleTest: an inconclusive run is skipped with the
/// properties `verdict` and `figure`.
///
/// @satisfies SWR-VER-023      Design: docs/design/test_strength.md#real-time-verdicts
#ifndef MAMORI_VERIFICATION_REAL_TIME_RESULT_HPP
#define MAMORI_VERIFICATION_REAL_TIME_RESULT_HPP

#include <gtest/gtest.h>

#include <string>

#include "mamori/verification/run_verdict.hpp"

namespace mamori::verification {

/// Call last in a test. @param[in] facts what a failure shows besides its reason.
inline void report_run(const RunFinding& finding, const std::string& facts = {}) {
    ::testing::Test::RecordProperty("verdict", get_name(finding.verdict));
    if (finding.verdict == RunVerdict::kPassed) {
        return;
    }
    ::testing::Test::RecordProperty("figure", finding.reason);
    if (finding.verdict == RunVerdict::kFailed) {
        ADD_FAILURE() << finding.reason << '\n' << facts;
        return;
    }
    GTEST_SKIP() << "verdict=inconclusive: " << finding.reason;
}

}  // namespace mamori::verification

#endif  // MAMORI_VERIFICATION_REAL_TIME_RESULT_HPP
