// SPDX-License-Identifier: Apache-2.0
/// @file
/// Records in a GoogleTest result which requirement the running test verifies, and how.
/// Technique and polarity are enumerators, so a misspelt one does not compile. One requirement per test.
///
/// @satisfies SWR-VER-032      Design: docs/design/test_strength.md#requirement-of-a-test
#ifndef MAMORI_VERIFICATION_VERIFIES_HPP
#define MAMORI_VERIFICATION_VERIFIES_HPP

#include <gtest/gtest.h>

#include <cstring>

namespace mamori::verification {

/// How the test case was derived. Names follow IEC 61508-3 Annex B where it defines one.
enum class Technique {
    kRequirementsBased,
    kBoundaryValues,
    kEquivalenceClasses,
    kFaultInjection,
    kStateTransition,
    kErrorGuessing,
    kInterface,
    kBackToBack,
};

/// kNominal: the required behaviour occurs. kViolation: the protection prevents the unwanted behaviour.
enum class Polarity { kNominal, kViolation };

constexpr const char* get_name(Technique technique) noexcept {
    switch (technique) {
        case Technique::kRequirementsBased:
            return "requirements_based";
        case Technique::kBoundaryValues:
            return "boundary_values";
        case Technique::kEquivalenceClasses:
            return "equivalence_classes";
        case Technique::kFaultInjection:
            return "fault_injection";
        case Technique::kStateTransition:
            return "state_transition";
        case Technique::kErrorGuessing:
            return "error_guessing";
        case Technique::kInterface:
            return "interface";
        case Technique::kBackToBack:
            return "back_to_back";
    }
    return "invalid";
}

constexpr const char* get_name(Polarity polarity) noexcept {
    return polarity == Polarity::kNominal ? "nominal" : "violation";
}

/// The requirement of the running test; nullptr if none was named yet, or no test is running.
inline const char* find_requirement() {
    const ::testing::TestInfo* const test = ::testing::UnitTest::GetInstance()->current_test_info();
    const int count = test == nullptr ? 0 : test->result()->test_property_count();
    for (int i = 0; i < count; ++i) {
        if (std::strcmp(test->result()->GetTestProperty(i).key(), "requirement") == 0) {
            return test->result()->GetTestProperty(i).value();
        }
    }
    return nullptr;
}

/// Call once, first in a test: a second call fails the test and records nothing.
/// @param[in] requirement id of one requirement, for example "SWR-KRN-001".
inline void verifies(const char* requirement, Technique technique = Technique::kRequirementsBased,
                     Polarity polarity = Polarity::kNominal) {
    if (const char* const first = find_requirement(); first != nullptr) {
        ADD_FAILURE() << "verifies() is called twice, with " << first << " and " << requirement
                      << ": a result holds one requirement, so split the test";
        return;
    }
    ::testing::Test::RecordProperty("requirement", requirement);
    ::testing::Test::RecordProperty("technique", get_name(technique));
    ::testing::Test::RecordProperty("polarity", get_name(polarity));
}

}  // namespace mamori::verification

#endif  // MAMORI_VERIFICATION_VERIFIES_HPP
