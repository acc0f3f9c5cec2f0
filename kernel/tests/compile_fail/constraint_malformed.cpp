// SPDX-License-Identifier: Apache-2.0
// Broken: the upper limit of a constraint has a letter too many, at character 11.
#include "parameter_parts.hpp"

class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
#ifdef MAMORI_BREAK
    mamori::Parameter<double> limit{"limit", 1.0, "0.1<=x<=3.0a"};
#else
    mamori::Parameter<double> limit{"limit", 1.0, "0.1<=x<=3.0"};
#endif
};
MAMORI_CONSTINIT Monitor g_monitor;
