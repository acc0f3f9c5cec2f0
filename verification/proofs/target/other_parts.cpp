// SPDX-License-Identifier: Apache-2.0
// Parts of the kernel that the arm does not use: a parameter of each kind of request, a state machine with a
// guard. They are linked so that the proofs also cover them.
#include "other_parts.hpp"

#include "mamori/kernel/base/constant_init.hpp"
#include "mamori/kernel/component/fsm_check.hpp"
#include "mamori/kernel/component/fsm_component.hpp"
#include "mamori/kernel/parameter/configuration_admin.hpp"
#include "mamori/kernel/parameter/configuration_set.hpp"
#include "mamori/kernel/parameter/parameter.hpp"
#include "mamori/kernel/system/system.hpp"

namespace proof {

bool is_firm(const mamori::FsmComponent&, const mamori::FsmEvent& event) noexcept {
    return event.argument > 0;
}

namespace {

class Axis final : public mamori::Component {
  public:
    constexpr Axis() noexcept : Component("axis") {}

    mamori::Parameter<double> speed_rad_s{*this, "speed_rad_s", 1.0, mamori::between(0.5, 3.0)};
    mamori::Parameter<std::array<std::int32_t, 3U>> gains{*this, "gains", {1, 1, 1}, mamori::above(0)};
    using Parameters = mamori::Parameters<&Axis::speed_rad_s, &Axis::gains>;
};

enum : mamori::FsmIndex { kClosed, kOpen };
enum : mamori::FsmIndex { kPush };

constexpr std::array<mamori::FsmState, 2U> kStates{{{"closed"}, {"open"}}};
constexpr std::array<mamori::FsmMessage, 1U> kMessages{{{"push"}}};
constexpr std::array<mamori::FsmTransition, 2U> kTransitions{
    {{kClosed, kPush, kOpen, &is_firm}, {kOpen, kPush, kClosed}}};
constexpr mamori::FsmTable kDoorTable{"door", kStates, kMessages, kTransitions, kClosed};
MAMORI_CHECK_FSM(kDoorTable);

class Door final : public mamori::FsmComponentFor<4U> {
  public:
    constexpr Door() noexcept : FsmComponentFor("door", kDoorTable) {}
};

MAMORI_CONSTINIT Axis axis;
constexpr auto kConfiguration = mamori::configuration(
    mamori::parameters_of(axis), mamori::configuration_set("slow", mamori::assign(axis.speed_rad_s, 0.5)));
MAMORI_CHECK_CONFIGURATION(kConfiguration);

}  // namespace

static Door door;
static mamori::ConfigurationAdmin configuration_admin{mamori::make_view(kConfiguration)};

mamori::Status prepare_other_parts(const char* set_name) noexcept {
    const mamori::Status result = door.initialize();
    if (result != mamori::Status::kOk) {
        return result;
    }
    const mamori::Status asked = configuration_admin.activate_configuration_set(mamori::make_text(set_name));
    return asked == mamori::Status::kOk ? configuration_admin.switch_at_frame_boundary() : asked;
}

}  // namespace proof
