// SPDX-License-Identifier: Apache-2.0
/// @file
/// A platform host with the model of its contract, which predicts the result of work from the times of its
/// steps.
///
/// @satisfies SWR-CNF-002, SWR-CNF-003, SWR-CNF-004, SWR-CNF-005
/// Design: docs/design/conformance.md#windows
#ifndef MAMORI_PORTS_CONFORMANCE_SRC_HOST_SUBJECT_HPP
#define MAMORI_PORTS_CONFORMANCE_SRC_HOST_SUBJECT_HPP

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "mamori/ports/conformance/host_contract.hpp"
#include "work_log.hpp"

namespace mamori::ports::conformance {

/// Work that a rule requests.
struct Order {
    std::size_t window{0U};
    std::size_t first{0U};  ///< index of the first step
    WindowHost::Pass pass{WindowHost::Pass::kExecute};
    std::vector<StepPlan> steps;
    Duration budget{0};  ///< time to the deadline; negative: deadline has passed
};

/// Prediction of the model for an order: exact with simulated time, else a bound, since steps can take
/// longer.
struct Prediction {
    std::size_t count{0U};  ///< steps that can return in time
    Duration end{0};        ///< time from the start to the return of run_within()
    bool has_hang{false};   ///< the first late step hangs
};
Prediction predict(const Order& order);

class HostSubject final {
  public:
    explicit HostSubject(std::unique_ptr<HostRig> rig);
    /// Releases hanging work and waits for its return.
    ~HostSubject();
    HostSubject(const HostSubject&) = delete;
    HostSubject& operator=(const HostSubject&) = delete;

    Duration get_tick() const { return rig_->get_tick(); }
    bool is_hanging(std::size_t window) const { return windows_.at(window).is_hanging; }
    std::string describe_state() const;

    /// Executes an order on the host and compares the result with the model. The window must not hang.
    void run(const Order& order, Judge& judge);
    /// Queries whether the work of a hanging window has returned.
    void ask(std::size_t window, Judge& judge);
    /// Releases the work of a hanging window and waits for its return.
    void release(std::size_t window, Judge& judge);
    /// Lets time pass without work.
    void idle(Duration time, Judge& judge);

  private:
    struct Window {
        bool is_hanging{false};
        bool is_at_rest{true};  ///< the host reported the end of the work
        std::size_t begun_at_rest{0U};
        std::size_t latest{0U};  ///< Prediction::count of the last order (index of its first late step)
        Instant begin{};         ///< start of the last order
        Instant deadline{};
        std::size_t asked{0U};    ///< steps of the last order
        std::size_t counted{0U};  ///< steps that the host counted
    };

    Instant read_now(Judge& judge);
    void check_answer(const Order& order, const Prediction& prediction, std::size_t count, Instant after,
                      Judge& judge);
    void check_steps(std::size_t window, std::size_t count, Judge& judge) const;
    void check_rest(std::size_t window, Judge& judge);
    void check_quiet(Judge& judge) const;
    bool wait_for_return(std::size_t window);

    std::array<WorkLog, HostRig::kWindowCount> logs_;
    std::array<Window, HostRig::kWindowCount> windows_;
    std::unique_ptr<HostRig>
        rig_;  ///< destroyed first, since it can wait for work that still writes to its log
    Instant last_;
};

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_SRC_HOST_SUBJECT_HPP
