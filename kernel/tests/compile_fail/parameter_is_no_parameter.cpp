// SPDX-License-Identifier: Apache-2.0
// Broken: a component lists a member that is no parameter.
#include "parameter_parts.hpp"

class Odd final : public mamori::Component {
  public:
    constexpr Odd() noexcept : Component("odd") {}
    mamori::Parameter<double> real{"real", 0.0};
    double number{0.0};
#ifdef MAMORI_BREAK
    using Parameters = mamori::Parameters<&Odd::real, &Odd::number>;
#else
    using Parameters = mamori::Parameters<&Odd::real>;
#endif
};
Odd g_odd;
[[maybe_unused]] constexpr auto kList = mamori::parameters_of(g_odd);
