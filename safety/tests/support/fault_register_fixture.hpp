// SPDX-License-Identifier: Apache-2.0
/// @file
/// A register of four faults whose cycles are ten nanoseconds apart.
#ifndef MAMORI_SAFETY_TESTS_SUPPORT_FAULT_REGISTER_FIXTURE_HPP
#define MAMORI_SAFETY_TESTS_SUPPORT_FAULT_REGISTER_FIXTURE_HPP

#include <gtest/gtest.h>

#include <array>

#include "mamori/safety/reaction/fault_register.hpp"

namespace mamori::safety::testing_support {

class FaultRegisterFixture : public ::testing::Test {
  protected:
    void report(FaultIndex fault, bool is_present) {
        now_ = now_ + Duration{10};
        sut_.report(fault, is_present, now_);
    }

    Instant now_{};
    std::array<FaultRecord, 4U> records_{};
    FaultRegister sut_{records_};
};

}  // namespace mamori::safety::testing_support

#endif  // MAMORI_SAFETY_TESTS_SUPPORT_FAULT_REGISTER_FIXTURE_HPP
