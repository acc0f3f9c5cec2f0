// SPDX-License-Identifier: Apache-2.0
#include "mamori/simbody_sim/arm_plant.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bristle_brake.hpp"
#include "drive.hpp"
#include "mamori/simbody_sim/arm_multibody.hpp"

namespace mamori::sim {
namespace {

/// Solves matrix * x = rhs by Cholesky's factorisation in a fixed order of operations.
/// @param[in] matrix symmetric, positive definite; otherwise x is not finite.
JointVector solve(const JointMatrix& matrix, const JointVector& rhs) noexcept {
    JointMatrix lower{};
    JointVector x{};
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        for (std::size_t k = 0U; k <= i; ++k) {
            double sum = matrix[i][k];
            for (std::size_t n = 0U; n < k; ++n) {
                sum -= lower[i][n] * lower[k][n];
            }
            lower[i][k] = i == k ? std::sqrt(sum) : sum / lower[k][k];
        }
        double sum = rhs[i];
        for (std::size_t n = 0U; n < i; ++n) {
            sum -= lower[i][n] * x[n];
        }
        x[i] = sum / lower[i][i];
    }
    for (std::size_t i = kArmJointCount; i-- > 0U;) {
        double sum = x[i];
        for (std::size_t n = i + 1U; n < kArmJointCount; ++n) {
            sum -= lower[n][i] * x[n];
        }
        x[i] = sum / lower[i][i];
    }
    return x;
}

/// Nearest count; a position outside the 32-bit range gives the nearest end of it.
std::int32_t quantise(double position_rad, double counts_per_rad) noexcept {
    constexpr double kMin = std::numeric_limits<std::int32_t>::min();
    constexpr double kMax = std::numeric_limits<std::int32_t>::max();
    return static_cast<std::int32_t>(std::clamp(std::floor(position_rad * counts_per_rad + 0.5), kMin, kMax));
}

/// What an encoder with its fault shows. @param[in,out] last_sound count before a freeze.
std::int32_t read_encoder(double position_rad, double counts_per_rad, const EncoderFault& fault,
                          std::int32_t& last_sound) noexcept {
    if (fault.frozen) {
        return last_sound;
    }
    last_sound = quantise(position_rad, counts_per_rad);
    std::int32_t count = quantise(position_rad + fault.bias_rad, counts_per_rad);
    if (fault.flipped_bit) {
        const std::uint32_t mask = std::uint32_t{1U} << (*fault.flipped_bit % 32U);
        count = static_cast<std::int32_t>(static_cast<std::uint32_t>(count) ^ mask);
    }
    return count;
}

bool is_finite(const JointVector& vector) noexcept {
    return std::all_of(vector.begin(), vector.end(), [](double number) { return std::isfinite(number); });
}

}  // namespace

struct ArmPlant::Impl {
    explicit Impl(const ArmModel& arm) : model(arm), multibody(arm) {}

    void update_switches(const safety::ArmOutputs& outputs) noexcept;
    void calc_motor_torques(const safety::ArmOutputs& outputs) noexcept;
    Status integrate();
    void sample_encoders() noexcept;

    ArmModel model;
    ArmMultibody multibody;
    PlantObserver* observer{nullptr};

    Instant now{};
    JointVector q{};
    JointVector u{};
    JointVector motor_torque{};
    PlantFaults faults{};
    bool watchdog_expired{false};
    bool relay_closed{false};

    detail::DelayedSwitch torque_possible;
    std::array<detail::DelayedSwitch, kArmJointCount> brake_open;
    std::array<detail::BristleBrake, kArmJointCount> brakes;
    std::array<std::int32_t, kArmJointCount> last_sound_a{};
    std::array<std::int32_t, kArmJointCount> last_sound_b{};
    safety::ArmInputs inputs{};
};

void ArmPlant::Impl::update_switches(const safety::ArmOutputs& outputs) noexcept {
    const bool powered = !faults.power_lost;
    if (!powered) {
        torque_possible.reset(false);  // nothing is left to feed the motors during the switch-off delay
    }
    // The watchdog acts on all three outputs, so one of them that is stuck leaves the others.
    const bool relay_wanted = outputs.relay_close && !watchdog_expired;
    relay_closed = relay_wanted || (faults.relay_stuck && relay_closed);
    const bool has_supply = relay_closed && powered;
    const bool is_enabled =
        (outputs.torque_enable && !watchdog_expired) || (faults.sto_ignored && torque_possible.is_on());
    const bool torque_wanted = is_enabled && has_supply;
    static_cast<void>(torque_possible.update(torque_wanted, Duration{}, model.sto_delay, kPlantSubstep));
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        const BrakeModel& brake = model.joints[i].brake;
        const bool is_held_open = faults.brake_stuck_open[i] && brake_open[i].is_on();
        const bool release_wanted =
            (outputs.brake_release && has_supply && !watchdog_expired) || is_held_open;
        if (brake_open[i].update(release_wanted, brake.opening_delay, brake.closing_delay, kPlantSubstep)) {
            brakes[i].open();
        }
    }
}

void ArmPlant::Impl::calc_motor_torques(const safety::ArmOutputs& outputs) noexcept {
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        const JointModel& joint = model.joints[i];
        const std::optional<double> runaway = faults.torque_runaway[i];
        const double wanted = runaway ? *runaway * joint.torque_limit_nm : outputs.torque_nm[i];
        motor_torque[i] = torque_possible.is_on() ? detail::calc_motor_torque(joint, wanted, u[i]) : 0.0;
    }
}

/// Semi-implicit Euler: the new velocity moves the position. Source: E. Hairer et al., Geometric Numerical
/// Integration, symplectic Euler method.
Status ArmPlant::Impl::integrate() {
    multibody.evaluate(q, u);
    JointVector torque{};
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        const JointModel& joint = model.joints[i];
        torque[i] = motor_torque[i] - joint.viscous_friction_nm_s_rad * u[i] - multibody.get_bias_torque()[i];
        if (!brake_open[i].is_on()) {
            const double creep_rad = faults.brake_creep_rad_s[i] * to_seconds(kPlantSubstep);
            torque[i] += brakes[i].hold(joint.brake, faults.brake_fade[i], creep_rad, q[i], u[i]);
        }
    }
    const JointVector acceleration = solve(multibody.get_mass_matrix(), torque);
    if (!is_finite(acceleration)) {
        return Status::kError;
    }
    const double h = to_seconds(kPlantSubstep);
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        u[i] += h * acceleration[i];
        q[i] += h * u[i];
    }
    now = now + kPlantSubstep;
    return is_finite(q) ? Status::kOk : Status::kError;
}

void ArmPlant::Impl::sample_encoders() noexcept {
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        const JointModel& joint = model.joints[i];
        inputs.encoder_a_counts[i] =
            read_encoder(q[i], joint.encoder_a_counts_per_rad, faults.encoder_a[i], last_sound_a[i]);
        inputs.encoder_b_counts[i] =
            read_encoder(q[i], joint.encoder_b_counts_per_rad, faults.encoder_b[i], last_sound_b[i]);
    }
}

ArmPlant::ArmPlant(const ArmModel& model) : impl_(std::make_unique<Impl>(model)) {
    reset({});
}
ArmPlant::~ArmPlant() = default;

void ArmPlant::reset(const JointVector& q0) {
    Impl& plant = *impl_;
    plant.now = {};
    plant.q = q0;
    plant.u = {};
    plant.motor_torque = {};
    plant.faults = {};
    plant.watchdog_expired = false;
    plant.relay_closed = false;
    plant.inputs = {};
    plant.torque_possible.reset(false);
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        plant.brake_open[i].reset(false);
        plant.brakes[i].open();  // so that the closed brake takes its anchor anew
    }
    plant.sample_encoders();
}

Status ArmPlant::step(const safety::ArmOutputs& outputs, Duration duration) {
    if (duration <= Duration{} || duration.ns % kPlantSubstep.ns != 0) {
        return Status::kBadParameter;
    }
    const Instant end = impl_->now + duration;
    while (impl_->now < end) {
        impl_->update_switches(outputs);
        impl_->calc_motor_torques(outputs);
        const Status status = impl_->integrate();
        if (status != Status::kOk) {
            return status;
        }
        if (impl_->observer != nullptr) {
            impl_->observer->on_substep(impl_->now, impl_->q, impl_->u);
        }
    }
    return Status::kOk;
}

const safety::ArmInputs& ArmPlant::sample() {
    Impl& plant = *impl_;
    plant.sample_encoders();
    plant.inputs.measured_torque_nm = plant.motor_torque;
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        plant.inputs.brake_closed[i] = !plant.brake_open[i].is_on();
        plant.inputs.reference_closed[i] = plant.q[i] > 0.0;
    }
    plant.inputs.torque_enabled = plant.torque_possible.is_on();
    plant.inputs.relay_closed = plant.relay_closed;
    plant.inputs.power_good = !plant.faults.power_lost;
    for (std::size_t i = 0U; i < plant.inputs.emergency_stop_closed.size(); ++i) {
        plant.inputs.emergency_stop_closed[i] = !plant.faults.emergency_stop_open[i];
        plant.inputs.protective_stop_closed[i] = !plant.faults.protective_stop_open[i];
        plant.inputs.enabling_closed[i] = !plant.faults.enabling_open[i] && !plant.faults.enabling_squeezed;
    }
    plant.inputs.enabling_squeezed = plant.faults.enabling_squeezed;
    plant.inputs.drive_clock_ns = plant.now.ns;
    plant.inputs.run_button = !plant.faults.run_released;
    for (std::size_t i = 0U; i < plant.inputs.mode_selected.size(); ++i) {
        plant.inputs.mode_selected[i] = plant.faults.mode == i;
    }
    return plant.inputs;
}

void ArmPlant::set_watchdog_expired(bool expired) noexcept {
    impl_->watchdog_expired = expired;
}

void ArmPlant::set_buttons(bool start, bool reset) noexcept {
    safety::ArmInputs& inputs = impl_->inputs;
    inputs.start_button = start || (impl_->faults.start_stuck && inputs.start_button);
    inputs.reset_button = reset || (impl_->faults.reset_stuck && inputs.reset_button);
}

void ArmPlant::set_observer(PlantObserver* observer) noexcept {
    impl_->observer = observer;
}
PlantFaults& ArmPlant::faults() noexcept {
    return impl_->faults;
}
const JointVector& ArmPlant::positions() const noexcept {
    return impl_->q;
}
const JointVector& ArmPlant::velocities() const noexcept {
    return impl_->u;
}
const JointVector& ArmPlant::torques() const noexcept {
    return impl_->motor_torque;
}
Instant ArmPlant::now() const noexcept {
    return impl_->now;
}

double ArmPlant::calc_energy_j() {
    impl_->multibody.evaluate(impl_->q, impl_->u);
    return impl_->multibody.calc_energy_j();
}

}  // namespace mamori::sim
