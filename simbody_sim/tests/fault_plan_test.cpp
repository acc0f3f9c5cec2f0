// SPDX-License-Identifier: Apache-2.0
// Goal: a fault plan is read exactly or refused with the reason, and acts at its simulated time only.
#include "mamori/simbody_sim/fault_plan.hpp"

#include <array>
#include <utility>

#include "arm_test_support.hpp"

namespace mamori::sim {
namespace {

using namespace test;

FaultPlan parse(std::string_view text) {
    const ParsedFaultPlan parsed = parse_fault_plan(text);
    EXPECT_TRUE(parsed.plan) << parsed.error;
    return parsed.plan.value_or(FaultPlan{});
}

std::string get_error(std::string_view text) {
    const ParsedFaultPlan parsed = parse_fault_plan(text);
    EXPECT_FALSE(parsed.plan) << text;
    EXPECT_EQ(parsed.error.find('\n'), std::string::npos);
    return parsed.error;
}

TEST(FaultPlanTest, TextGivesEachPart) {
    verifies("SWR-SIM-011");

    const FaultPlan plan =
        parse("kind=encoder_bias,joint=2,channel=both,at=2.5,duration=0.25,magnitude=-0.1,seed=42");
    EXPECT_EQ(plan.kind, FaultKind::kEncoderBias);
    EXPECT_EQ(plan.joint, 1U);
    EXPECT_EQ(plan.channel, FaultChannel::kBoth);
    EXPECT_EQ(plan.at, 2500_ms);
    EXPECT_EQ(plan.span, FaultSpan::kForTime);
    EXPECT_EQ(plan.duration, 250_ms);
    EXPECT_EQ(plan.magnitude, -0.1);
    EXPECT_EQ(plan.seed, 42U);
}

TEST(FaultPlanTest, AFaultStaysUnlessItIsSaidOtherwise) {
    verifies("SWR-SIM-011");

    EXPECT_EQ(parse("kind=power_loss,at=0").span, FaultSpan::kPersistent);
    EXPECT_EQ(parse("kind=power_loss,at=0,duration=persistent").span, FaultSpan::kPersistent);
    EXPECT_EQ(parse("kind=message_lost,at=1,duration=once").span, FaultSpan::kOnce);
    EXPECT_EQ(parse("kind=none"), FaultPlan{});
}

TEST(FaultPlanTest, EveryKindSurvivesTheWayThroughText) {
    verifies("SWR-SIM-011", Technique::kEquivalenceClasses);
    const std::array<std::string, 27U> texts{
        "kind=none",
        "kind=none,seed=18446744073709551615",
        "kind=encoder_freeze,joint=1,channel=a,at=2",
        "kind=encoder_bit_flip,joint=7,channel=b,at=0.000000001,duration=once,magnitude=31",
        "kind=encoder_bias,joint=3,channel=both,at=999999.999999999,duration=0.1,magnitude=0.1",
        "kind=torque_runaway,joint=4,at=3.125,magnitude=-1",
        "kind=power_loss,at=0",
        "kind=brake_fade,joint=2,at=1,magnitude=0.8",
        "kind=controller_hang,at=1,duration=0.05",
        "kind=message_lost,at=1,duration=once,seed=7",
        "kind=message_late,at=1,duration=2,magnitude=0.02",
        "kind=supervisor_hang,at=1.5",
        "kind=power_loss,at=1,latent=brake_stuck_open:7",
        "kind=none,latent=sto_ignored,seed=3",
        "kind=brake_stuck_open,joint=2,at=1",
        "kind=processor_stops,at=1",
        "kind=emergency_stop,channel=both,at=1,duration=0.5",
        "kind=protective_stop,channel=a,at=1",
        "kind=brake_creep,joint=2,at=1,magnitude=0.02",
        "kind=enabling_released,channel=b,at=1,latent=hold_to_run",
        "kind=enabling_squeezed,at=1,latent=reduced_speed",
        "kind=run_released,at=1",
        "kind=power_loss,at=1,latent=reset_stuck",
        "kind=message_damaged,at=1,duration=once,magnitude=65535",
        "kind=controller_wrong,at=1,magnitude=123456789",
        "kind=encoder_drift,joint=2,channel=both,at=1,magnitude=-0.3",
        "kind=clock_wrong,at=1,magnitude=2"};

    for (const std::string& text : texts) {
        EXPECT_EQ(to_text(parse(text)), text);
        EXPECT_EQ(parse(to_text(parse(text))), parse(text));
    }
}

TEST(FaultPlanTest, MisspeltWordsAreRefusedWithTheNearestOne) {
    verifies("SWR-SIM-011", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_EQ(
        get_error("kind=encoder_freze,joint=1,channel=a,at=2"),
        "fault plan 'kind=encoder_freze,joint=1,channel=a,at=2': unknown kind 'encoder_freze'; did you mean "
        "'encoder_freeze'? valid: " +
            list_fault_kinds());
    EXPECT_NE(get_error("kind=power_loss,att=2")
                  .find("unknown key 'att'; did you mean 'at'? valid: kind, joint, channel, at, "),
              std::string::npos);
    EXPECT_NE(get_error("kind=encoder_freeze,joint=1,channel=bth,at=2").find("did you mean 'both'?"),
              std::string::npos);
}

TEST(FaultPlanTest, EveryKindIsListedOnceAndNoOther) {
    verifies("SWR-SIM-015");

    EXPECT_EQ(list_fault_kinds(),
              "none, encoder_freeze, encoder_bit_flip, encoder_bias, torque_runaway, power_loss, brake_fade, "
              "controller_hang, message_lost, message_late, supervisor_hang, brake_stuck_open, "
              "brakes_stuck_open, sto_ignored, relay_stuck, processor_stops, emergency_stop, "
              "protective_stop, brake_creep, enabling_released, enabling_squeezed, run_released, "
              "reduced_speed, hold_to_run, start_stuck, "
              "reset_stuck, message_damaged, controller_wrong, encoder_drift, clock_wrong");
}

TEST(FaultPlanTest, BrokenTextIsRefusedWithTheReason) {
    verifies("SWR-SIM-011", Technique::kErrorGuessing, Polarity::kViolation);
    const std::array<std::pair<const char*, const char*>, 24U> cases{{
        {"", "'' is not key=value"},
        {"kind", "'kind' is not key=value"},
        {"kind=", "'kind=' is not key=value"},
        {"=none", "'=none' is not key=value"},
        {"kind=power_loss,at=1,", "'' is not key=value"},
        {"at=1", "kind= is missing"},
        {"kind=power_loss,at=1,at=2", "at is given twice"},
        {"kind=power_loss", "kind power_loss needs at="},
        {"kind=power_loss,at=1,joint=1", "kind power_loss takes no joint"},
        {"kind=power_loss,at=1,magnitude=1", "kind power_loss takes no magnitude"},
        {"kind=none,at=1", "kind none takes no at"},
        {"kind=none,duration=once", "kind none takes no duration"},
        {"kind=encoder_freeze,channel=a,at=1", "kind encoder_freeze needs joint="},
        {"kind=encoder_freeze,joint=1,at=1", "kind encoder_freeze needs channel="},
        {"kind=torque_runaway,joint=1,channel=a,at=1,magnitude=1", "kind torque_runaway takes no channel"},
        {"kind=torque_runaway,joint=1,at=1", "kind torque_runaway needs magnitude="},
        {"kind=power_loss,at=soon", "at must be a finite number, is 'soon'"},
        {"kind=power_loss,at=nan", "at must be a finite number, is 'nan'"},
        {"kind=power_loss,at=1s", "at must be a finite number, is '1s'"},
        {"kind=power_loss,at=1,duration=long", "duration must be once, persistent or seconds, is 'long'"},
        {"kind=power_loss,at=1,seed=-1", "seed must be a whole number from 0, is '-1'"},
        {"kind=power_loss,at=1,seed=1.5", "seed must be a whole number from 0, is '1.5'"},
        {"kind=encoder_freeze,joint=one,channel=a,at=1", "joint must be a whole number from 0, is 'one'"},
        {"kind=power_loss, at=1", "unknown key ' at'"},
    }};

    for (const auto& [text, reason] : cases) {
        EXPECT_NE(get_error(text).find(reason), std::string::npos) << get_error(text);
    }
}

TEST(FaultPlanTest, BothSidesOfEveryLimit) {
    verifies("SWR-SIM-011", Technique::kBoundaryValues, Polarity::kViolation);
    const std::array<std::pair<std::string, std::array<const char*, 2U>>, 25U> cases{{
        // accepted, refused
        {"kind=encoder_freeze,channel=a,at=1,joint=", {"1", "0"}},
        {"kind=encoder_freeze,channel=a,at=1,joint=", {"7", "8"}},
        {"kind=power_loss,at=", {"0", "-0.000000001"}},
        {"kind=power_loss,at=", {"1000000", "1000000.1"}},
        {"kind=power_loss,at=1,duration=", {"0.000000001", "0"}},
        {"kind=encoder_bit_flip,joint=1,channel=a,at=1,magnitude=", {"0", "-1"}},
        {"kind=encoder_bit_flip,joint=1,channel=a,at=1,magnitude=", {"31", "32"}},
        {"kind=encoder_bit_flip,joint=1,channel=a,at=1,magnitude=", {"1", "1.5"}},
        {"kind=message_damaged,at=1,magnitude=", {"65535", "65536"}},
        {"kind=message_damaged,at=1,magnitude=", {"0", "-1"}},
        {"kind=controller_wrong,at=1,magnitude=", {"1000000000", "1000000001"}},
        {"kind=encoder_drift,joint=1,channel=b,at=1,magnitude=", {"10", "10.01"}},
        {"kind=encoder_drift,joint=1,channel=b,at=1,magnitude=", {"-10", "-10.01"}},
        {"kind=encoder_drift,joint=1,channel=b,at=1,magnitude=", {"0.001", "0"}},
        {"kind=clock_wrong,at=1,magnitude=", {"10", "10.01"}},
        {"kind=clock_wrong,at=1,magnitude=", {"0.1", "0.099"}},
        {"kind=clock_wrong,at=1,magnitude=", {"1.001", "1"}},
        {"kind=encoder_bias,joint=1,channel=a,at=1,magnitude=", {"-10", "-10.1"}},
        {"kind=torque_runaway,joint=1,at=1,magnitude=", {"1", "1.001"}},
        {"kind=torque_runaway,joint=1,at=1,magnitude=", {"-1", "0"}},
        {"kind=brake_fade,joint=1,at=1,magnitude=", {"1", "1.001"}},
        {"kind=brake_fade,joint=1,at=1,magnitude=", {"0.001", "0"}},
        {"kind=message_late,at=1,magnitude=", {"10", "10.1"}},
        {"kind=brake_creep,joint=1,at=1,magnitude=", {"1", "1.001"}},
        {"kind=brake_creep,joint=1,at=1,magnitude=", {"0.001", "0"}},
    }};

    for (const auto& [text, values] : cases) {
        EXPECT_TRUE(parse_fault_plan(text + values[0]).plan) << parse_fault_plan(text + values[0]).error;
        EXPECT_NE(get_error(text + values[1]).find(std::string("is ") + values[1]), std::string::npos);
    }
}

TEST(FaultPlanTest, AFaultIsActiveFromItsInstantForItsLength) {
    verifies("SWR-SIM-012", Technique::kBoundaryValues);
    const auto at = [](std::int64_t ns) { return Instant{ns}; };
    const FaultPlan persistent = parse("kind=power_loss,at=0.002");
    const FaultPlan once = parse("kind=power_loss,at=0.002,duration=once");
    const FaultPlan timed = parse("kind=power_loss,at=0.002,duration=0.003");

    for (const FaultPlan& plan : {persistent, once, timed}) {
        EXPECT_FALSE(is_active(plan, at(1999999)));
        EXPECT_TRUE(is_active(plan, at(2000000)));
    }
    EXPECT_TRUE(is_active(once, at(2999999)));
    EXPECT_FALSE(is_active(once, at(3000000)));
    EXPECT_TRUE(is_active(timed, at(4999999)));
    EXPECT_FALSE(is_active(timed, at(5000000)));
    EXPECT_TRUE(is_active(persistent, at(INT64_MAX)));
    EXPECT_FALSE(is_active(FaultPlan{}, at(0)));
}

TEST(FaultPlanTest, PlantFaultsComeAndGoWithTheirPlan) {
    verifies("SWR-SIM-012");
    const Instant before{999999999};
    const Instant during{1000000000};
    const Instant after{1500000000};
    const auto apply = [](const char* text, Instant now, PlantFaults faults = {}) {
        apply_plant_faults(parse(text), now, faults);
        return faults;
    };
    const char* const freeze = "kind=encoder_freeze,joint=2,channel=both,at=1,duration=0.5";
    const char* const flip = "kind=encoder_bit_flip,joint=3,channel=a,at=1,duration=0.5,magnitude=12";
    const char* const bias = "kind=encoder_bias,joint=4,channel=b,at=1,duration=0.5,magnitude=0.25";
    const char* const runaway = "kind=torque_runaway,joint=5,at=1,duration=0.5,magnitude=-0.5";
    const char* const fade = "kind=brake_fade,joint=6,at=1,duration=0.5,magnitude=0.75";
    const char* const creep = "kind=brake_creep,joint=7,at=1,duration=0.5,magnitude=0.02";
    const char* const power = "kind=power_loss,at=1,duration=0.5";

    EXPECT_TRUE(apply(freeze, during).encoder_a[1].frozen);
    EXPECT_TRUE(apply(freeze, during).encoder_b[1].frozen);
    EXPECT_EQ(apply(flip, during).encoder_a[2].flipped_bit, 12U);
    EXPECT_FALSE(apply(flip, during).encoder_b[2].flipped_bit);
    EXPECT_EQ(apply(bias, during).encoder_b[3].bias_rad, 0.25);
    EXPECT_EQ(apply(bias, during).encoder_a[3].bias_rad, 0.0);
    const char* const drift = "kind=encoder_drift,joint=4,channel=both,at=1,duration=0.5,magnitude=0.3";
    EXPECT_EQ(apply(drift, during).encoder_a[3].bias_rad, 0.0);
    EXPECT_DOUBLE_EQ(apply(drift, Instant{1200000000}).encoder_a[3].bias_rad, 0.06);
    EXPECT_DOUBLE_EQ(apply(drift, Instant{1200000000}).encoder_b[3].bias_rad, 0.06);
    EXPECT_EQ(apply(drift, after, apply(drift, during)).encoder_b[3].bias_rad, 0.0);
    EXPECT_EQ(apply(runaway, during).torque_runaway[4], -0.5);
    EXPECT_EQ(apply(fade, during).brake_fade[5], 0.75);
    EXPECT_EQ(apply(creep, during).brake_creep_rad_s[6], 0.02);
    EXPECT_TRUE(apply(power, during).power_lost);
    using Channels = std::array<bool, 2U>;
    const std::string stop = "kind=emergency_stop,at=1,duration=0.5,channel=";
    EXPECT_EQ(apply((stop + "a").c_str(), during).emergency_stop_open, (Channels{true, false}));
    EXPECT_EQ(apply((stop + "b").c_str(), during).emergency_stop_open, (Channels{false, true}));
    EXPECT_EQ(apply((stop + "both").c_str(), during).emergency_stop_open, (Channels{true, true}));
    EXPECT_EQ(apply("kind=protective_stop,channel=b,at=1", during).protective_stop_open,
              (Channels{false, true}));
    EXPECT_EQ(apply("kind=enabling_released,channel=a,at=1", during).enabling_open, (Channels{true, false}));
    EXPECT_TRUE(apply("kind=enabling_squeezed,at=1", during).enabling_squeezed);
    EXPECT_TRUE(apply("kind=run_released,at=1", during).run_released);
    EXPECT_EQ(apply("kind=reduced_speed,at=1", before).mode, 0U);
    EXPECT_EQ(apply("kind=reduced_speed,at=1", during).mode, 1U);
    EXPECT_EQ(apply("kind=hold_to_run,at=1", during).mode, 2U);
    EXPECT_EQ(apply("kind=power_loss,at=1,latent=hold_to_run", Instant{0}).mode, 2U) << "since power-up";
    EXPECT_TRUE(apply("kind=start_stuck,at=1", during).start_stuck);
    EXPECT_TRUE(apply("kind=reset_stuck,at=1", during).reset_stuck);

    for (const Instant now : {before, after}) {
        EXPECT_FALSE(apply(freeze, now, apply(freeze, during)).encoder_a[1].frozen);
        EXPECT_FALSE(apply(freeze, now, apply(freeze, during)).encoder_b[1].frozen);
        EXPECT_FALSE(apply(flip, now, apply(flip, during)).encoder_a[2].flipped_bit);
        EXPECT_EQ(apply(bias, now, apply(bias, during)).encoder_b[3].bias_rad, 0.0);
        EXPECT_FALSE(apply(runaway, now, apply(runaway, during)).torque_runaway[4]);
        EXPECT_EQ(apply(fade, now, apply(fade, during)).brake_fade[5], 0.0);
        EXPECT_EQ(apply(creep, now, apply(creep, during)).brake_creep_rad_s[6], 0.0);
        EXPECT_FALSE(apply(power, now, apply(power, during)).power_lost);
        EXPECT_EQ(apply((stop + "both").c_str(), now).emergency_stop_open, (Channels{false, false}));
    }
}

TEST(FaultPlanTest, PlansOfTheRunnerLeaveThePlantAlone) {
    verifies("SWR-SIM-012", Technique::kEquivalenceClasses);
    PlantFaults faults;
    faults.power_lost = true;
    faults.brake_fade[0] = 0.5;

    for (const char* const text :
         {"kind=none", "kind=controller_hang,at=0", "kind=message_lost,at=0",
          "kind=message_late,at=0,magnitude=0.1", "kind=clock_wrong,at=0,magnitude=2",
          "kind=supervisor_hang,at=0", "kind=torque_runaway,joint=1,at=5,magnitude=1"}) {
        apply_plant_faults(parse(text), Instant{1}, faults);
        EXPECT_TRUE(faults.power_lost);
        EXPECT_EQ(faults.brake_fade[0], 0.5);
        EXPECT_FALSE(faults.encoder_a[0].frozen);
        EXPECT_FALSE(faults.torque_runaway[0]);
    }
}

TEST(FaultPlanTest, ALatentFaultIsPresentSinceTheStartOfTheMotionOrWithoutAnotherOneSincePowerUp) {
    verifies("SWR-SIM-012", Technique::kBoundaryValues);
    PlantFaults faults;
    const FaultPlan with_other =
        delay(parse("kind=power_loss,at=1,latent=brake_stuck_open:2"), Duration{500});
    apply_plant_faults(with_other, Instant{499}, faults);
    EXPECT_FALSE(faults.brake_stuck_open[1]);
    apply_plant_faults(with_other, Instant{500}, faults);
    EXPECT_TRUE(faults.brake_stuck_open[1]);
    EXPECT_FALSE(faults.brake_stuck_open[0]);
    EXPECT_EQ(with_other.at, Duration{1000000500});

    apply_plant_faults(delay(parse("kind=none,latent=relay_stuck"), Duration{500}), Instant{0}, faults);
    EXPECT_TRUE(faults.relay_stuck);
    apply_plant_faults(parse("kind=none,latent=sto_ignored"), Instant{0}, faults);
    EXPECT_TRUE(faults.sto_ignored);
    apply_plant_faults(parse("kind=none,latent=brake_fade:3"), Instant{0}, faults);
    EXPECT_EQ(faults.brake_fade[2], kLatentFade);
    apply_plant_faults(parse("kind=none,latent=brakes_stuck_open"), Instant{0}, faults);
    EXPECT_TRUE(faults.brake_stuck_open[0] && faults.brake_stuck_open[6]);
}

TEST(FaultPlanTest, ALatentFaultThatIsNoneIsRefused) {
    verifies("SWR-SIM-011", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_NE(get_error("kind=none,latent=power_loss").find("power_loss is not a latent fault; valid: "),
              std::string::npos);
    EXPECT_NE(get_error("kind=none,latent=stoignored").find("did you mean 'sto_ignored'?"),
              std::string::npos);
    EXPECT_NE(get_error("kind=none,latent=brake_stuck_open").find("needs a joint"), std::string::npos);
    EXPECT_NE(get_error("kind=none,latent=brake_stuck_open:8").find("joint must be 1 to 7"),
              std::string::npos);
    EXPECT_NE(get_error("kind=none,latent=relay_stuck:1").find("takes no joint"), std::string::npos);
}

}  // namespace
}  // namespace mamori::sim
