// SPDX-License-Identifier: Apache-2.0
/// @file
/// Components with parameters, for the tests of configurations.
#ifndef MAMORI_KERNEL_TESTS_CONFIGURED_COMPONENTS_HPP
#define MAMORI_KERNEL_TESTS_CONFIGURED_COMPONENTS_HPP

#include <array>
#include <cstdint>

#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/parameter/parameter.hpp"

namespace mamori::testing_support {

/// The compiler can make one and ask it.
class Axis final : public Component {
  public:
    constexpr explicit Axis(const char* name = "axis") noexcept : Component(name) {}

    Parameter<double> speed{*this, "speed", 1.0, between(0.5, 3.0)};
    Parameter<std::array<std::int32_t, 3U>> gains{*this, "gains", {1, 1, 1}, above(0)};
    using Parameters = mamori::Parameters<&Axis::speed, &Axis::gains>;
};

/// It needs a name, so only the object itself can be asked.
class NamedAxis final : public Component {
  public:
    constexpr explicit NamedAxis(const char* name) noexcept : Component(name) {}

    Parameter<std::int16_t> level{*this, "level", 0, between(-10, 10)};
    using Parameters = mamori::Parameters<&NamedAxis::level>;
};

}  // namespace mamori::testing_support

#endif  // MAMORI_KERNEL_TESTS_CONFIGURED_COMPONENTS_HPP
