// SPDX-License-Identifier: Apache-2.0
/// @file
/// Mamori in the end-to-end protection cases: the port case with a protected message.
///
/// @satisfies SWR-BEN-010      Design: docs/design/bench.md#method
#include "catalogue.hpp"
#include "e2e_rig.hpp"

namespace mamori::verification::bench {
namespace {

template <std::size_t kSize>
class MamoriE2ePort final : public Subject {
  public:
    std::uint64_t run(std::uint64_t count) override {
        std::uint64_t sum = 0U;
        for (std::uint64_t i = 0U; i < count; ++i) {
            rig_.exchange(values_[i]);
            sum += rig_.get_read()[0];
        }
        return sum;
    }

  private:
    WrittenValues<kSize> values_;
    E2eRig<kSize> rig_;
};

}  // namespace

void add_mamori_e2e(std::vector<Case>& e2e) {
    add_to_e2e<MamoriE2ePort>(e2e, "mamori protected port");
}

}  // namespace mamori::verification::bench
