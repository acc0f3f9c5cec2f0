// SPDX-License-Identifier: Apache-2.0
/// @file
/// Mamori in the scheduler cases: the executive runs components, without supervision and with it.
#include "catalogue.hpp"
#include "executive_rig.hpp"

namespace mamori::verification::bench {
namespace {

template <std::size_t kCount, ClassOrder kOrder>
class UnsupervisedIn final : public Subject {
  public:
    std::uint64_t run(std::uint64_t count) override {
        const std::uint64_t before = rig_.count_runs();
        for (std::uint64_t i = 0U; i < count; ++i) {
            rig_.run_cycle();
        }
        return rig_.count_runs() - before;
    }

  private:
    ExecutiveRig<kCount, CountingClock, kOrder> rig_;
};

template <std::size_t kCount>
using Unsupervised = UnsupervisedIn<kCount, ClassOrder::kInTurn>;
template <std::size_t kCount>
using UnsupervisedInMixedOrder = UnsupervisedIn<kCount, ClassOrder::kMixed>;

template <std::size_t kCount>
class Supervised final : public Subject {
  public:
    Supervised() { rig_.supervise(); }

    std::uint64_t run(std::uint64_t count) override {
        const std::uint64_t before = rig_.count_runs();
        for (std::uint64_t i = 0U; i < count; ++i) {
            rig_.run_supervised_cycle();
        }
        return rig_.count_runs() - before;
    }

  private:
    ExecutiveRig<kCount, SystemClock> rig_;
};

}  // namespace

void add_mamori_executive(std::vector<Case>& schedulers) {
    add_to_schedulers<Unsupervised>(schedulers, "mamori component");
    add_to_schedulers<UnsupervisedInMixedOrder>(schedulers, "mamori component, mixed order");
    add_to_schedulers<Supervised>(schedulers, "mamori supervised component");
}

}  // namespace mamori::verification::bench
