// SPDX-License-Identifier: Apache-2.0
/// @file
/// Record of one run: the data of docs/design/trace.md#evidence-files, collected in each major frame and
/// written after the run.
///
/// @satisfies SWR-SAF-016      Design: docs/design/safe_arm.md#record
#ifndef EXAMPLES_SAFE_ARM_RUN_RECORD_HPP
#define EXAMPLES_SAFE_ARM_RUN_RECORD_HPP

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "mamori/kernel/record/event_log.hpp"
#include "mamori/safety/reaction/fault_register.hpp"
#include "mamori/safety/reaction/reaction_table.hpp"
#include "mamori/simbody_sim/arm_plant.hpp"
#include "mamori/simbody_sim/fault_plan.hpp"
#include "mamori/simbody_sim/physical_verdict.hpp"
#include "messages.hpp"
#include "run_options.hpp"

namespace safe_arm {

/// State and outputs of the software in one major frame.
struct FrameFacts {
    mamori::Instant start{};
    mamori::Instant end{};
    mamori::safety::SafeState state{};
    mamori::safety::FaultIndex first_fault{mamori::safety::kNoFault};
    mamori::safety::Reaction reaction{};  ///< most severe requested reaction so far
    bool is_stopping{false};              ///< torque off, or a controlled stop requested
    bool is_watchdog_expired{false};
    JointVector setpoint_rad{};
    bool torque_enable{false};
    bool brake_release{false};
};

/// Writes a file atomically: to a temporary file next to it, which is then renamed. @return false on failure.
bool replace_file(const std::filesystem::path& path, const std::string& text);

/// Creates the folder of a record and a test file in it, so that a long run does not end without a writable
/// folder.
/// @return empty on success, otherwise one line with the cause.
std::string claim_folder(const std::string& folder);

/// Collects the data of one run. Host only; owns heap memory. Thread safety: none.
class RunRecord final {
  public:
    /// @param[in] fault with `at` in simulated time. @param[in] motion_start instant at which the path
    /// begins.
    RunRecord(const RunOptions& options, const mamori::sim::ArmModel& model,
              const mamori::sim::FaultPlan& fault, mamori::Instant motion_start, mamori::Instant motion_end);

    /// To be installed in the plant: checks the true motion in every integration step.
    mamori::sim::PhysicalVerdict& get_verdict() noexcept { return verdict_; }

    /// Call once per major frame, after the step of the plant.
    void add_frame(const FrameFacts& facts, const mamori::sim::ArmPlant& plant);

    /// Closing facts of a run.
    struct Closing {
        std::uint64_t frames{0U};
        std::uint64_t trace_hash{0U};
        double wall_s{0.0};
    };
    /// Writes series.csv, events.csv and, last, run.json to the folder, each atomically.
    /// @return empty on success, otherwise one line with the cause, and run.json does not exist.
    std::string write(const mamori::EventLog& events, const Closing& closing) const;

  private:
    void add_series_line(const FrameFacts& facts, const mamori::sim::ArmPlant& plant);
    void note_instants(const FrameFacts& facts, const mamori::sim::ArmPlant& plant);
    std::string make_summary(const Closing& closing) const;
    bool has_fault() const noexcept { return fault_.kind != mamori::sim::FaultKind::kNone; }

    RunOptions options_;
    mamori::sim::ArmModel model_;
    mamori::sim::FaultPlan fault_;
    mamori::Instant motion_start_;
    mamori::Instant motion_end_;
    mamori::sim::PhysicalVerdict verdict_;
    std::string series_;
    FrameFacts last_{};
    std::optional<mamori::Instant> operational_at_{};
    std::optional<mamori::Instant> detected_at_{};
    std::optional<mamori::Instant> reacted_at_{};
    bool is_injected_{false};
    const char* detector_{nullptr};  ///< name of the fault or of the detector; nullptr: not detected
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_RUN_RECORD_HPP
