// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the tests of the simulated arm share: the shipped model, a seeded source of numbers, commands, a
/// state hash.
#ifndef MAMORI_SIMBODY_SIM_TESTS_ARM_TEST_SUPPORT_HPP
#define MAMORI_SIMBODY_SIM_TESTS_ARM_TEST_SUPPORT_HPP

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>

#include "mamori/simbody_sim/arm_model.hpp"
#include "mamori/simbody_sim/arm_plant.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::sim::test {

using namespace mamori::literals;
using verification::Polarity;
using verification::Technique;
using verification::verifies;

/// A bent pose, far from every end stop, in which gravity loads the x joints.
inline constexpr JointVector kBentPose{0.0, 0.8, 0.0, 0.8, 0.0, 0.8, 1.57};

inline ArmModel load_shipped_model() {
    LoadedModel loaded = load_arm_model(MAMORI_ARM_MODEL_FILE);
    EXPECT_TRUE(loaded.model) << loaded.error;
    return loaded.model.value_or(ArmModel{});
}

/// Numbers that are the same with every library: the engine's bits are fixed by the standard.
class Numbers final {
  public:
    explicit Numbers(std::uint64_t seed) : engine_(seed) {}
    double draw(double min, double max) {
        return min + (max - min) * static_cast<double>(engine_() >> 11U) * 0x1.0p-53;
    }
    JointVector draw_vector(double min, double max) {
        JointVector result{};
        for (double& element : result) {
            element = draw(min, max);
        }
        return result;
    }

  private:
    std::mt19937_64 engine_;
};

inline safety::ArmOutputs command(const JointVector& torque_nm) {
    safety::ArmOutputs outputs;
    outputs.torque_nm = torque_nm;
    outputs.torque_enable = true;
    outputs.brake_release = true;
    outputs.relay_close = true;
    return outputs;
}

inline double calc_distance(const JointVector& a, const JointVector& b) {
    double distance = 0.0;
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        distance = std::fmax(distance, std::fabs(a[i] - b[i]));
    }
    return distance;
}

/// FNV-1a over the bits of every true state that it observes.
class StateHash final : public PlantObserver {
  public:
    void on_substep(Instant, const JointVector& q, const JointVector& u) override {
        for (std::size_t i = 0U; i < kArmJointCount; ++i) {
            add(q[i]);
            add(u[i]);
        }
    }
    std::uint64_t get() const noexcept { return hash_; }

  private:
    void add(double number) noexcept {
        std::uint64_t bits = 0U;
        std::memcpy(&bits, &number, sizeof bits);
        for (unsigned shift = 0U; shift < 64U; shift += 8U) {
            hash_ = (hash_ ^ ((bits >> shift) & 0xFFU)) * 1099511628211U;
        }
    }
    std::uint64_t hash_{14695981039346656037U};
};

}  // namespace mamori::sim::test

#endif  // MAMORI_SIMBODY_SIM_TESTS_ARM_TEST_SUPPORT_HPP
