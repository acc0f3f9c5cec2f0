// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/conformance/trial.hpp"

namespace mamori::ports::conformance {

void Judge::expect(bool holds, const char* sentence) {
    if (!holds && finding_.empty()) {
        finding_ = sentence;
    }
}

void Judge::expect_equal(std::int64_t actual, std::int64_t expected, const char* sentence) {
    if (actual != expected && finding_.empty()) {
        finding_ =
            std::string{sentence} + ": " + std::to_string(actual) + " instead of " + std::to_string(expected);
    }
}

void Judge::expect_equal(Instant actual, Instant expected, const char* sentence) {
    expect_equal(actual.ns, expected.ns, sentence);
}

}  // namespace mamori::ports::conformance
