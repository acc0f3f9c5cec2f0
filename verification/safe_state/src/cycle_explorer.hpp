// SPDX-License-Identifier: Apache-2.0
/// @file
/// Executes the compiled safety cycle in every situation of its state machine, brakes and faults, with every
/// combination of inputs. Shows that it takes only steps that machine and brakes can take, and records when
/// it keeps torque that they do not give.
///
/// @satisfies SWR-PRF-052, SWR-PRF-053      Design: docs/design/safe_state.md#the-cycle-in-the-models
#ifndef MAMORI_VERIFICATION_SAFE_STATE_CYCLE_EXPLORER_HPP
#define MAMORI_VERIFICATION_SAFE_STATE_CYCLE_EXPLORER_HPP

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "mamori/safety/cycle/safety_cycle.hpp"

namespace mamori::verification {

using namespace literals;
using safety::BrakeSequence;
using safety::CycleInputs;
using safety::FaultIndex;
using safety::kNoFault;
using safety::Reaction;
using safety::SafeState;
using safety::SafeStateInputs;
using safety::SafeStateMachine;
using safety::SelfTestStatus;
using safety::StopOutputs;

/// Declared by brakes_first; STO for another reason; a milder fault whose reaction depends on the mode.
enum class ProbeFault : FaultIndex { kLost, kDrive, kSlip };
inline constexpr std::size_t kProbeFaultCount = 3U;
enum class ProbeMode { kFast, kSlow, kStay };
enum class ProbeCommand { kSwitch };

/// Has the row of the cycle in the table; the probe itself is created for each exploration.
class ProbeRow final : public Component, public safety::CycleComponent {
  public:
    constexpr explicit ProbeRow(const char* name) noexcept : Component(name) {}
    InPort<std::uint32_t> seen{*this, "seen"};
    using Ports = mamori::Ports<&ProbeRow::seen>;
};
inline ProbeRow g_probe_row{"cycle"};
class ProbeSensor final : public Component {
  public:
    constexpr explicit ProbeSensor(const char* name) noexcept : Component(name) {}
    OutPort<std::uint32_t> seen{*this, "seen"};
    using Ports = mamori::Ports<&ProbeSensor::seen>;
};
inline ProbeSensor g_probe_sensor{"sensor"};

/// Bounds in frames. They are short, because only the comparison with them counts.
inline constexpr Duration kProbeFrame = 1_ms;
inline constexpr safety::StopBounds kProbeStops{2_ms, 3_ms};
inline constexpr safety::BrakeLimits kProbeBrakes{2_ms, true};
inline constexpr Duration kProbeNever = 100'000_s;
inline constexpr auto kProbeSystem = safety::system(
    frame(kProbeFrame), window("all", 0_us, 500_us, budget(500_us), run(g_probe_sensor, g_probe_row)),
    connect(g_probe_sensor.seen, g_probe_row.seen, any_age()),
    system_mode<ProbeMode::kFast>("fast", runs(g_probe_sensor, g_probe_row)),
    system_mode<ProbeMode::kSlow>("slow", runs(g_probe_sensor, g_probe_row)),
    safe_mode<ProbeMode::kStay>("stay", runs(g_probe_sensor, g_probe_row)),
    mode_transition("fast", ProbeCommand::kSwitch, "slow"),
    mode_transition("slow", ProbeCommand::kSwitch, "fast"),
    faults<ProbeFault::kLost, ProbeFault::kDrive, ProbeFault::kSlip>(),
    react(ProbeFault::kLost, Reaction::kSto, within(kProbeNever)),
    react(ProbeFault::kDrive, Reaction::kSto, within(kProbeNever)),
    react(ProbeFault::kSlip, Reaction::kSs2, within(kProbeNever), in_modes<ProbeMode::kFast>()),
    react(ProbeFault::kSlip, Reaction::kSs1, within(kProbeNever), in_modes<ProbeMode::kSlow>()),
    react(ProbeFault::kSlip, Reaction::kDegrade, within(kProbeNever), in_modes<ProbeMode::kStay>()),
    safety::supervise(g_probe_row, safety::alive(2U, 3U), safety::deadline(100_us)),
    safety::supervise(g_probe_sensor, safety::alive(2U, 3U), safety::deadline(100_us)),
    safety::confirmed_by(g_probe_sensor.seen, safety::StopConfirmation::kStandstill,
                         safety::StopConfirmation::kClosedBrakes, safety::StopConfirmation::kTorqueOff),
    safety::cycle(kProbeStops, kProbeBrakes, safety::WatchdogWindow{0_ms, kProbeNever},
                  safety::torque_feedback(kProbeNever), safety::tolerated_lateness(kProbeNever),
                  safety::on_late_reaction(safety::raises(ProbeFault::kDrive)),
                  safety::on_failed_self_test(safety::raises(ProbeFault::kDrive)),
                  safety::on_unconfirmed_brakes(safety::raises(ProbeFault::kSlip)),
                  safety::brakes_first<ProbeFault::kLost>()));
MAMORI_SAFETY_CHECK(kProbeSystem);

class ProbeWatchdog final : public safety::Watchdog {
  public:
    Status service(Instant) noexcept override { return Status::kOk; }
};

/// Machine of which each input is set. Its self test runs for one cycle and passes.
class Probe final : public safety::SafetyCycle {
  public:
    explicit Probe(safety::SafetyState& state) noexcept : SafetyCycle("cycle", state) {}

    CycleInputs inputs{};
    std::array<bool, kProbeFaultCount> present{};
    SelfTestStatus self_test{SelfTestStatus::kPassed};  ///< answer in this cycle
    StopOutputs outputs{};

    using SafetyCycle::is_watchdog_serviced;

  private:
    CycleInputs read_inputs(Instant) noexcept override {
        self_test = SelfTestStatus::kPassed;
        return inputs;
    }
    SelfTestStatus step_self_test(bool is_first, Instant) noexcept override {
        self_test = is_first ? SelfTestStatus::kRunning : SelfTestStatus::kPassed;
        return self_test;
    }
    bool is_present(FaultIndex fault) noexcept override { return present[fault]; }
    void command(SafeState, const StopOutputs& wanted) noexcept override { outputs = wanted; }
};

/// Reason for which STO is demanded.
enum class StoCause : std::uint8_t { kNone, kBrakesFirst, kOther };

/// What decides about torque at the end of a cycle.
struct TorqueLetter {
    SafeState state{SafeState::kSelfTest};  ///< of the machine, after its step
    bool is_own{false};                     ///< the brake sequence gives torque
    bool is_closing{false};                 ///< BrakeSequence::is_closing()
    bool had_torque{false};                 ///< in the cycle before
    bool can_hold{false};
    StoCause cause{StoCause::kNone};
};
inline bool operator<(const TorqueLetter& a, const TorqueLetter& b) {
    return std::tie(a.state, a.is_own, a.is_closing, a.had_torque, a.can_hold, a.cause) <
           std::tie(b.state, b.is_own, b.is_closing, b.had_torque, b.can_hold, b.cause);
}

/// The torque of each letter that occurs.
struct CycleRelation {
    std::map<TorqueLetter, bool> torque;
    std::size_t situations{0U};
    std::uint64_t cycles{0U};  ///< executed
};

/// Inputs of one cycle.
struct CycleLetter {
    std::array<bool, kProbeFaultCount> present{};
    std::size_t mode{0U};
    bool start{false};
    bool reset{false};
    bool is_standing{false};
    bool are_closed{false};
    bool can_hold{false};
    Duration elapsed{0};  ///< since the cycle before
};

/// @return all combinations of levels; in each, the clock advances by a frame in each mode and in one that is
/// invalid, beyond all bounds, or runs backwards.
inline std::vector<CycleLetter> make_cycle_letters() {
    struct Step {
        std::size_t mode;
        std::int64_t frames;
    };
    std::vector<CycleLetter> letters;
    for (unsigned bits = 0U; bits < 64U; ++bits) {
        const auto is_set = [bits](unsigned place) { return ((bits >> place) & 1U) != 0U; };
        for (const unsigned buttons : {0U, 1U, 2U}) {
            for (const Step step : {Step{0U, 1}, Step{1U, 1}, Step{2U, 1}, Step{kSystemModeMax, 1},
                                    Step{0U, 4}, Step{0U, -1}}) {
                letters.push_back({{is_set(0U), is_set(1U), is_set(2U)},
                                   step.mode,
                                   buttons == 1U,
                                   buttons == 2U,
                                   is_set(3U),
                                   is_set(4U),
                                   is_set(5U),
                                   Duration{step.frames * kProbeFrame.ns}});
            }
        }
    }
    return letters;
}

/// Explores one safety cycle from power-up.
class CycleExplorer final {
  public:
    CycleExplorer() : real_(std::make_unique<Real>()) {
        if (real_->cycle.initialize() != Status::kOk) {
            throw std::runtime_error("the safety cycle does not initialise");
        }
    }

    /// @throw std::runtime_error if the safety cycle does what machine and brakes cannot do, answers two
    /// cycles of equal letters with different torque, or has more than kSituationsMax situations.
    const CycleRelation& explore() {
        const std::vector<CycleLetter> letters = make_cycle_letters();
        find_or_add(Shadow{});
        for (std::size_t i = 0U; i < snapshots_.size(); ++i) {
            for (const CycleLetter& letter : letters) {
                find_or_add(take(load(i), letter));
            }
        }
        relation_.situations = snapshots_.size();
        return relation_;
    }

    static constexpr std::size_t kSituationsMax = 40'000U;

  private:
    /// The compiled cycle with all its memory.
    struct Real {
        safety::SafetyStorage<kProbeSystem> storage{};
        ProbeWatchdog watchdog{};
        safety::SafetyState state{storage, watchdog};
        Probe cycle{state};
    };
    using Image = std::array<unsigned char, sizeof(Real)>;

    /// What an external observer expects of the cycle: machine and brakes, and the demand of each fault.
    struct Shadow {
        SafeStateMachine machine{kProbeStops};
        BrakeSequence brakes{kProbeBrakes};
        std::array<Reaction, kProbeFaultCount> demands{};  ///< worst since the fault was latched
        Instant now{kFirst};
        bool had_torque{false};
        bool was_reset{true};
    };
    struct Snapshot {
        Shadow shadow;
        Image image;
    };
    static constexpr std::size_t kBrakesAt = sizeof(SafeStateMachine);
    static constexpr std::size_t kDemandsAt = kBrakesAt + sizeof(BrakeSequence);
    using Key = std::array<char, kDemandsAt + kProbeFaultCount + 1U>;

    static constexpr Instant kFirst{4'000'000'000'000'000'000};  // recognisable as an instant in memory

    /// All memory of the shadow. Times are relative to the cycle, and equal when they are beyond each bound.
    static Key make_key(const Shadow& shadow) {
        Key key{};
        std::memcpy(key.data(), &shadow.machine, sizeof(shadow.machine));
        std::memcpy(key.data() + kBrakesAt, &shadow.brakes, sizeof(shadow.brakes));
        for (std::size_t i = 0U; i < kDemandsAt; i += sizeof(std::int64_t)) {
            std::int64_t word = 0;
            std::memcpy(&word, key.data() + i, sizeof(word));
            if (word >= kFirst.ns / 2 && word <= kFirst.ns + kFirst.ns / 2) {
                word = std::clamp(shadow.now.ns - word, -kProbeFrame.ns, 4 * kProbeFrame.ns);
                std::memcpy(key.data() + i, &word, sizeof(word));
            }
        }
        for (std::size_t i = 0U; i < kProbeFaultCount; ++i) {
            key[kDemandsAt + i] = static_cast<char>(shadow.demands[i]);
        }
        key.back() = static_cast<char>((shadow.had_torque ? 1U : 0U) | (shadow.was_reset ? 2U : 0U));
        return key;
    }

    void find_or_add(const Shadow& shadow) {
        const Key key = make_key(shadow);
        if (numbers_.find({key.data(), key.size()}) == numbers_.end()) {
            if (snapshots_.size() == kSituationsMax) {
                throw std::runtime_error("the safety cycle has no end of situations");
            }
            keys_.push_back(key);
            numbers_.insert({std::string_view{keys_.back().data(), key.size()}, snapshots_.size()});
            snapshots_.push_back({shadow, {}});
            std::memcpy(snapshots_.back().image.data(), static_cast<const void*>(real_.get()), sizeof(Real));
        }
    }

    /// @return a copy: the list grows meanwhile.
    Shadow load(std::size_t number) {
        std::memcpy(static_cast<void*>(real_.get()), snapshots_[number].image.data(), sizeof(Real));
        return snapshots_[number].shadow;
    }

    static void require(bool is_met, const char* words) {
        if (!is_met) {
            throw std::runtime_error(std::string{"the safety cycle "} + words);
        }
    }

    static Reaction find_reaction(std::size_t fault, std::size_t mode) {
        constexpr std::array kSlip{Reaction::kSs2, Reaction::kSs1, Reaction::kDegrade};
        const bool is_slip = fault == static_cast<std::size_t>(ProbeFault::kSlip) && mode < kSlip.size();
        return is_slip ? kSlip[mode] : Reaction::kSto;
    }

    /// One cycle of the compiled code, compared with what is expected. @return the situation after it.
    Shadow take(Shadow shadow, const CycleLetter& letter) {
        const SafeState before = shadow.machine.get_state();
        shadow.now = shadow.now + letter.elapsed;
        Probe& cycle = real_->cycle;
        cycle.inputs = {letter.is_standing, letter.are_closed, shadow.had_torque,
                        letter.start,       letter.reset,      true,
                        cycle.outputs,      letter.mode,       letter.can_hold};
        cycle.present = letter.present;
        const bool is_permitted = cycle.is_watchdog_serviced();
        for (ExecutionRecord& record : real_->state.get_observer().get_records()) {
            record.note_run(shadow.now, shadow.now + 10_us);
        }
        require(cycle.on_execute({0, shadow.now}) == Status::kOk, "fails");
        ++relation_.cycles;

        SafeStateInputs inputs{};
        inputs.standstill = shadow.brakes.confirm(before, letter.is_standing, letter.are_closed, shadow.now);
        const StoCause cause = follow_faults(shadow, letter);
        inputs.now = shadow.now;
        inputs.demand = *std::max_element(shadow.demands.begin(), shadow.demands.end());
        inputs.faults_cleared = inputs.demand == Reaction::kNone;
        inputs.self_test = cycle.self_test;
        inputs.start_button = letter.start;
        inputs.reset_button = letter.reset;
        inputs.start_permitted = is_permitted;
        inputs.lock_out = letter.elapsed < Duration{0} && real_has_stepped(shadow);
        step_machine(shadow, inputs);
        compare_outputs(shadow, letter, cause);
        shadow.was_reset = letter.reset;
        return shadow;
    }

    bool real_has_stepped(const Shadow& shadow) const { return shadow.now + kProbeFrame > kFirst; }

    /// A fault that is present is latched. Only a push of the reset ends a demand, and only that of a fault
    /// that has gone; a mode switch does not lower it.
    StoCause follow_faults(Shadow& shadow, const CycleLetter& letter) const {
        auto cause = StoCause::kNone;
        const bool is_pushed = letter.reset && !shadow.was_reset;
        for (std::size_t i = 0U; i < kProbeFaultCount; ++i) {
            const safety::FaultRecord& record =
                real_->state.get_faults().get_record(static_cast<FaultIndex>(i));
            const bool was_latched = shadow.demands[i] != Reaction::kNone;
            require(record.is_latched || !letter.present[i], "does not latch a fault that is present");
            require(record.is_latched || !was_latched || is_pushed, "forgets a fault without a reset");
            const Reaction demand = std::max(shadow.demands[i], find_reaction(i, letter.mode));
            shadow.demands[i] = record.is_latched ? demand : Reaction::kNone;
            require(record.demand.reaction == shadow.demands[i], "demands another reaction than the table");
            if (shadow.demands[i] == Reaction::kSto) {
                const bool is_first = i == static_cast<std::size_t>(ProbeFault::kLost);
                cause = is_first && cause == StoCause::kNone ? StoCause::kBrakesFirst
                        : is_first                           ? cause
                                                             : StoCause::kOther;
            }
        }
        return cause;
    }

    /// The machine may be told that its brakes failed, or not.
    void step_machine(Shadow& shadow, SafeStateInputs inputs) const {
        const SafeState wanted = real_->state.get_state();
        SafeStateMachine failed = shadow.machine;
        inputs.brakes_failed = true;
        const SafeState with_failure = failed.step(inputs);
        inputs.brakes_failed = false;
        if (shadow.machine.step(inputs) != wanted) {
            require(with_failure == wanted, "enters another state than its machine");
            shadow.machine = failed;
        }
    }

    void compare_outputs(Shadow& shadow, const CycleLetter& letter, StoCause cause) {
        const SafeState state = shadow.machine.get_state();
        StopOutputs own = shadow.brakes.apply(state, shadow.now);
        const StopOutputs& real = real_->cycle.outputs;
        const TorqueLetter torque{state,
                                  own.torque_enable,
                                  shadow.brakes.is_closing(shadow.now),
                                  shadow.had_torque,
                                  letter.can_hold,
                                  cause};
        own.stop_requested = own.stop_requested || real.torque_enable != own.torque_enable;
        own.torque_enable = real.torque_enable;
        require(real == own, "gives other outputs than its brakes");
        const auto [place, is_new] = relation_.torque.insert({torque, real.torque_enable});
        require(is_new || place->second == real.torque_enable, "keeps torque for another reason than known");
        shadow.had_torque = real.torque_enable;
    }

    std::unique_ptr<Real> real_;
    std::unordered_map<std::string_view, std::size_t> numbers_;  ///< keys: bytes in keys_
    std::deque<Key> keys_;
    std::vector<Snapshot> snapshots_;
    CycleRelation relation_;
};

}  // namespace mamori::verification

#endif  // MAMORI_VERIFICATION_SAFE_STATE_CYCLE_EXPLORER_HPP
