// SPDX-License-Identifier: Apache-2.0
/// @file
/// Lower bounds of the scheduler cases: one virtual call per component, and one call with one clock reading.
#include "catalogue.hpp"
#include "component_pool.hpp"
#include "minimal_host.hpp"

namespace mamori::verification::bench {
namespace {

/// The plain loop over the components; `kReadsClock`: also records a start time for each component.
template <std::size_t kCount, bool kReadsClock, ClassOrder kOrder = ClassOrder::kInTurn>
class BareLoop final : public Subject {
  public:
    BareLoop() {
        for (std::size_t i = 0U; i < kCount; ++i) {
            order_[i] = &pool_.at(i);
        }
    }

    std::uint64_t run(std::uint64_t count) override {
        const std::uint64_t before = pool_.count_runs();
        for (std::uint64_t i = 0U; i < count; ++i) {
            for (std::size_t k = 0U; k < kCount; ++k) {
                if constexpr (kReadsClock) {
                    started_at_[k] = read_clock();
                }
                static_cast<void>(order_[k]->on_execute({0, Instant{}}));
            }
        }
        touch(started_at_);
        return pool_.count_runs() - before;
    }

  private:
    ComponentPool pool_{kCount, kOrder};
    std::array<Component*, kCount> order_{};
    std::array<Instant, kCount> started_at_{};
};

template <std::size_t kCount>
using VirtualCall = BareLoop<kCount, false>;
template <std::size_t kCount>
using VirtualCallWithClock = BareLoop<kCount, true>;
template <std::size_t kCount>
using VirtualCallInMixedOrder = BareLoop<kCount, false, ClassOrder::kMixed>;

}  // namespace

void add_scheduler_floors(std::vector<Case>& schedulers) {
    add_to_schedulers<VirtualCall>(schedulers, "virtual call");
    add_to_schedulers<VirtualCallWithClock>(schedulers, "virtual call + clock");
    add_to_schedulers<VirtualCallInMixedOrder>(schedulers, "virtual call, mixed order");
}

}  // namespace mamori::verification::bench
