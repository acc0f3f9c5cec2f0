// SPDX-License-Identifier: Apache-2.0
/// @file
/// A host with the model of its contract: what may come of a piece of work, by the times that its steps take.
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

/// A piece of work as a rule asks for it.
struct Order {
    std::size_t window{0U};
    std::size_t first{0U};  ///< number of the first step
    WindowHost::Pass pass{WindowHost::Pass::kExecute};
    std::vector<StepPlan> steps;
    Duration budget{0};  ///< from now to the deadline; below 0 it has passed already
};

/// What the model says of an order: exact where times are, else a bound, since steps may take longer.
struct Prediction {
    std::size_t count{0U};  ///< steps that may be back in time
    Duration end{0};        ///< from the beginning until run_within() returns
    bool has_hang{false};   ///< the first step that is not in time hangs
};
Prediction predict(const Order& order);

class HostSubject final {
  public:
    explicit HostSubject(std::unique_ptr<HostRig> rig);
    /// Releases what hangs and waits for it.
    ~HostSubject();
    HostSubject(const HostSubject&) = delete;
    HostSubject& operator=(const HostSubject&) = delete;

    Duration get_tick() const { return rig_->get_tick(); }
    bool is_hanging(std::size_t window) const { return windows_.at(window).is_hanging; }
    std::string describe_state() const;

    /// Gives an order to the host and compares. Its window must not hang.
    void run(const Order& order, Judge& judge);
    /// Asks whether the work of a window that hangs has returned.
    void ask(std::size_t window, Judge& judge);
    /// Lets the work of a window that hangs go and waits for it.
    void release(std::size_t window, Judge& judge);
    /// Lets time pass without work.
    void idle(Duration time, Judge& judge);

  private:
    struct Window {
        bool is_hanging{false};
        bool is_at_rest{true};  ///< the host said that nothing runs, and nothing will begin
        std::size_t begun_at_rest{0U};
        std::size_t latest{0U};  ///< Prediction::count of the last order
        Instant begin{};         ///< of the last order
        Instant deadline{};
        std::size_t asked{0U};    ///< steps of it
        std::size_t counted{0U};  ///< what the host answered
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
    std::unique_ptr<HostRig> rig_;  ///< goes first: it may have to wait for work that still writes its log
    Instant last_;
};

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_SRC_HOST_SUBJECT_HPP
