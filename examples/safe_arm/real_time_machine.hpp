// SPDX-License-Identifier: Apache-2.0
/// @file
/// Environment of the safety software in real time. The plant runs on a separate thread, so that it uses no
/// time of a window. As in virtual time, it follows the commands one major frame later.
///
/// @satisfies SWR-TIM-004      Design: docs/design/timing.md#plant
#ifndef EXAMPLES_SAFE_ARM_REAL_TIME_MACHINE_HPP
#define EXAMPLES_SAFE_ARM_REAL_TIME_MACHINE_HPP

#include <semaphore.h>

#include <atomic>
#include <cstdint>
#include <thread>

#include "mamori/ports/posix_rt/core_runner.hpp"
#include "mamori/simbody_sim/arm_plant.hpp"

namespace safe_arm {

/// Devices of a real-time run. The operator presses start as in virtual time.
///
/// Calling context: the observer calls come from the thread that runs the windows; each is O(1) and does not
/// block.
/// Memory: only that of the plant.
class RealTimeMachine final : public mamori::ports::posix_rt::OpeningObserver {
  public:
    /// Starts the thread. @param[in] plant must outlive this object; meanwhile, no other code may access it.
    explicit RealTimeMachine(mamori::sim::ArmPlant& plant);
    RealTimeMachine(const RealTimeMachine&) = delete;
    RealTimeMachine& operator=(const RealTimeMachine&) = delete;
    ~RealTimeMachine();

    /// Before the first window of a major frame: copies the newest sample to the process image.
    void before_opening(const mamori::FrameSchedule::Opening& opening,
                        mamori::Instant woke) noexcept override;
    /// After the last window of a major frame: forwards the commands to the plant.
    void after_opening(const mamori::FrameSchedule::Opening& opening,
                       mamori::WindowOutcome outcome) noexcept override;

    /// Major frames for which the plant was not ready. Its time was stopped meanwhile, and its sample was
    /// old.
    std::uint64_t get_late_count() const noexcept { return late_count_; }
    /// False after the state of the plant has become infinite or not-a-number.
    bool is_plant_sound() const noexcept { return is_plant_sound_.load(std::memory_order_relaxed); }

  private:
    struct Command {
        mamori::safety::ArmOutputs outputs{};
        bool is_watchdog_expired{false};
        bool is_start_pushed{false};
    };
    void serve();

    mamori::sim::ArmPlant& plant_;
    Command command_{};                   ///< used by the thread during its step
    mamori::safety::ArmInputs sample_{};  ///< likewise
    bool is_stepping_{false};             ///< state that the runner knows
    std::uint64_t late_count_{0U};
    std::atomic<bool> is_plant_sound_{true};
    std::atomic<bool> is_ending_{false};
    sem_t wanted_{};
    sem_t done_{};
    std::thread thread_;
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_REAL_TIME_MACHINE_HPP
