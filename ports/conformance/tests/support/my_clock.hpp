// SPDX-License-Identifier: Apache-2.0
// The example clock of docs/manual/porting.md.
#ifndef MAMORI_PORTS_CONFORMANCE_TESTS_SUPPORT_MY_CLOCK_HPP
#define MAMORI_PORTS_CONFORMANCE_TESTS_SUPPORT_MY_CLOCK_HPP

#include "mamori/kernel/base/time.hpp"

class MyClock final {
  public:
    mamori::Instant get_now() const { return now_; }
    void wait_until(mamori::Instant instant) { now_ = instant > now_ ? instant : now_; }

  private:
    mamori::Instant now_{};
};

#endif  // MAMORI_PORTS_CONFORMANCE_TESTS_SUPPORT_MY_CLOCK_HPP
