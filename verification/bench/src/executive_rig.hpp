// SPDX-License-Identifier: Apache-2.0
/// @file
/// A running system of `kCount` components with minimal work in one window. The remaining cost is that of the
/// executive.
#ifndef MAMORI_VERIFICATION_BENCH_EXECUTIVE_RIG_HPP
#define MAMORI_VERIFICATION_BENCH_EXECUTIVE_RIG_HPP

#include <cstddef>
#include <stdexcept>

#include "component_pool.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/safety/supervision/execution_supervisor.hpp"
#include "minimal_host.hpp"

namespace mamori::verification::bench {

/// Executive over `kCount` components, started. Its host reads `Clock`.
template <std::size_t kCount, typename Clock, ClassOrder kOrder = ClassOrder::kInTurn>
class ExecutiveRig {
  public:
    ExecutiveRig() : table_(make_table(pool_)), executive_(table_) {
        if (executive_.initialize() != Status::kOk || executive_.start() != Status::kOk) {
            throw std::runtime_error("the executive did not start");
        }
    }

    /// Adds a supervisor that checks every component. Call once.
    void supervise() {
        for (std::size_t i = 0U; i < kCount; ++i) {
            if (supervisor_.watch(i, kLimits) != Status::kOk) {
                throw std::runtime_error("a component could not be watched");
            }
        }
        executive_.set_observer(&supervisor_);
    }

    /// One cycle of the window.
    void run_cycle() noexcept { static_cast<void>(executive_.run_window(0U, host_)); }

    /// One cycle, then the evaluation of all components, as in a supervision window.
    void run_supervised_cycle() noexcept {
        run_cycle();
        is_healthy_ = supervisor_.step(host_.get_now()) == safety::GlobalStatus::kOk && is_healthy_;
    }

    /// @return runs of all components so far; 0 if a supervised cycle was not healthy.
    std::uint64_t count_runs() const noexcept { return is_healthy_ ? pool_.count_runs() : 0U; }

  private:
    /// Long enough for a busy host: nothing may expire here.
    static constexpr Duration kFrame = Duration{3'600'000'000'000};
    static constexpr safety::ComponentLimits kLimits{{1U, 2U}, {Duration{0}, kFrame}};

    using Table = SystemTable<1U, kCount, 0U, 0U>;

    /// The rows of a window of one component, as the kernel creates them, repeated for all components. A list
    /// of a thousand arguments would exceed the limits of a compiler.
    static Table make_table(ComponentPool& pool) noexcept {
        const auto one =
            system(frame(kFrame), window("bench", Duration{0}, kFrame, budget(kFrame), run(pool.at(0U))));
        Table table{};
        table.frame = one.frame;
        table.windows[0] = one.windows[0];
        table.windows[0].component_count = kCount;
        // Through the references of the pool, the table cannot detect that no component has a second pass.
        table.windows[0].has_second_pass = false;
        table.component_rows.fill(one.component_rows[0]);
        for (std::size_t i = 0U; i < kCount; ++i) {
            table.components[i] = &pool.at(i);
        }
        return table;
    }

    ComponentPool pool_{kCount, kOrder};
    const Table table_;
    ExecutiveFor<Table> executive_;
    safety::ExecutionStorage<kCount> storage_{};
    safety::ExecutionSupervisor supervisor_{storage_, kFrame};
    MinimalHost<Clock> host_;
    bool is_healthy_{true};
};

}  // namespace mamori::verification::bench

#endif  // MAMORI_VERIFICATION_BENCH_EXECUTIVE_RIG_HPP
