// SPDX-License-Identifier: Apache-2.0
/// @file
/// Judges what the arm really did, from the plant's truth in every integration step: speed, margin to the
/// position range, travel after a fault, standstill, drift afterwards, tracking error. It knows nothing of
/// the safety code.
///
/// @satisfies SWR-SIM-014      Design: docs/design/simulation.md#verdict
#ifndef MAMORI_SIMBODY_SIM_PHYSICAL_VERDICT_HPP
#define MAMORI_SIMBODY_SIM_PHYSICAL_VERDICT_HPP

#include <optional>

#include "mamori/simbody_sim/arm_model.hpp"
#include "mamori/simbody_sim/arm_plant.hpp"

namespace mamori::sim {

/// When the arm counts as standing: every joint slower than the speed, without a break, for the time.
struct StandstillRule {
    double speed_rad_s{0.01};
    Duration confirmation{50000000};
};

/// Recorder of one run. Install it with ArmPlant::set_observer.
///
/// Thread safety: none. Time: O(joints) per call. Memory: no heap.
class PhysicalVerdict final : public PlantObserver {
  public:
    /// @param[in] model for the position range of each joint.
    explicit PhysicalVerdict(const ArmModel& model, StandstillRule rule = {});
    ~PhysicalVerdict() = default;

    void on_substep(Instant now, const JointVector& q, const JointVector& u) override;

    /// A fault begins now: travel is measured from `q` [rad] until standstill.
    void mark_injection(const JointVector& q) noexcept;
    /// A stop is due from now on: the first confirmed standstill from here is the one that is recorded, and
    /// every later movement is drift. Without this call no standstill is looked for, since an arm may also
    /// rest in a motion.
    void mark_stop() noexcept;
    /// Compares the true positions with the wanted ones [rad]. Call it once per frame while tracking is
    /// judged.
    void judge_tracking(const JointVector& q, const JointVector& q_ref) noexcept;

    /// Largest absolute speed of each joint over the whole run [rad/s].
    const JointVector& get_max_speed_rad_s() const noexcept { return max_speed_rad_s_; }
    /// Smallest distance of any joint to its end stops over the whole run [rad]; negative: inside a stop.
    /// +infinity before the first step.
    double get_min_position_margin_rad() const noexcept { return min_position_margin_rad_; }
    /// Largest distance of each joint from its place at the injection, until standstill [rad]; zero without
    /// injection.
    const JointVector& get_stop_travel_rad() const noexcept { return stop_travel_rad_; }
    /// Instant from which the arm stood; empty until it is confirmed.
    std::optional<Instant> get_standstill() const noexcept { return standstill_; }
    /// Largest movement of any joint away from where it stood at get_standstill() [rad]; zero before it.
    double get_hold_drift_rad() const noexcept { return hold_drift_rad_; }
    /// Largest absolute tracking error of any joint [rad]; zero when never judged.
    double get_max_tracking_error_rad() const noexcept { return max_tracking_error_rad_; }

  private:
    void judge_limits(const JointVector& q, const JointVector& u) noexcept;
    void judge_standstill(Instant now, const JointVector& q, const JointVector& u) noexcept;

    JointVector position_min_rad_{};
    JointVector position_max_rad_{};
    StandstillRule rule_;

    JointVector max_speed_rad_s_{};
    double min_position_margin_rad_;
    std::optional<JointVector> injection_rad_;
    JointVector stop_travel_rad_{};
    bool stop_due_{false};
    std::optional<Instant> slow_since_;
    JointVector slow_position_rad_{};
    double slow_drift_rad_{0.0};
    std::optional<Instant> standstill_;
    double hold_drift_rad_{0.0};
    double max_tracking_error_rad_{0.0};
};

}  // namespace mamori::sim

#endif  // MAMORI_SIMBODY_SIM_PHYSICAL_VERDICT_HPP
