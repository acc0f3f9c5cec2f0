// SPDX-License-Identifier: Apache-2.0
// Broken: a component lists a member that is no port.
#include "parts.hpp"

class Odd final : public mamori::Component {
  public:
    constexpr Odd() noexcept : Component("odd") {}
    mamori::OutPort<double> out{"out"};
    double number{0.0};
#ifdef MAMORI_BREAK
    using Ports = mamori::Ports<&Odd::out, &Odd::number>;
#else
    using Ports = mamori::Ports<&Odd::out>;
#endif
};
Odd g_odd;
[[maybe_unused]] constexpr auto kRunList = mamori::run(g_odd);
