// SPDX-License-Identifier: Apache-2.0
/// @file
/// A component with parameters for the compile-must-fail cases.
#ifndef MAMORI_KERNEL_TESTS_COMPILE_FAIL_PARAMETER_PARTS_HPP
#define MAMORI_KERNEL_TESTS_COMPILE_FAIL_PARAMETER_PARTS_HPP

#include "mamori/kernel/base/constant_init.hpp"
#include "mamori/kernel/parameter/configuration_set.hpp"

class Axis final : public mamori::Component {
  public:
    constexpr Axis() noexcept : Component("axis") {}
    mamori::Parameter<double> speed{*this, "speed", 1.0, mamori::between(0.5, 3.0)};
    mamori::Parameter<int> gain{*this, "gain", 1};
    using Parameters = mamori::Parameters<&Axis::speed, &Axis::gain>;
};
inline Axis g_axis;
inline Axis g_second_axis;

#endif  // MAMORI_KERNEL_TESTS_COMPILE_FAIL_PARAMETER_PARTS_HPP
