// SPDX-License-Identifier: Apache-2.0
// What the compiler rejects: a port in C and a port in C++ with different payload types; temporary actions; a
// create function of RTMSafety with another signature, and none.
// Each namespace compiles, and does not with its MAMORI_BREAK_<NAME>.
#include "mamori/kernel/c/rtmsafety_component.hpp"

// The types have the same size.
namespace c_input_type {
mamori::InPort<float> g_port{mamori::kNoOwner, "port"};
#ifdef MAMORI_BREAK_C_INPUT_TYPE
using Value = std::int32_t;
#else
using Value = float;
#endif
struct Part {
    MAMORI_IN_PORT(Value) in;
};
Part g_part{mamori::c_port(g_port)};
}  // namespace c_input_type

namespace c_output_type {
mamori::OutPort<float> g_port{mamori::kNoOwner, "port"};
#ifdef MAMORI_BREAK_C_OUTPUT_TYPE
using Value = std::int32_t;
#else
using Value = float;
#endif
struct Part {
    MAMORI_OUT_PORT(Value) out;
};
Part g_part{mamori::c_port(g_port)};
}  // namespace c_output_type

namespace temporary_actions {
constexpr MamoriActions kActions{};
class Part final : public mamori::CComponent {
  public:
#ifdef MAMORI_BREAK_TEMPORARY_ACTIONS
    Part() noexcept : CComponent("part", MamoriActions{}, nullptr) {}
#else
    Part() noexcept : CComponent("part", kActions, nullptr) {}
#endif
};
}  // namespace temporary_actions

namespace create_function {
struct Object {
    int (*onInitialize)(), (*onFinalize)(), (*onStartup)(), (*onShutdown)(), (*onActivated)(),
        (*onDeactivated)(), (*onAborting)(), (*onError)(), (*onReset)(), (*onExecute)();
};
int create(Object* object);
void create_nothing(Object* object, int size);
#ifdef MAMORI_BREAK_CREATE_SIGNATURE
constexpr auto kCreate = &create_nothing;
#elif defined(MAMORI_BREAK_CREATE_NULL)
constexpr int (*kCreate)(Object*) = nullptr;
#else
constexpr auto kCreate = &create;
#endif
class Part final : public mamori::RtmSafetyComponent<kCreate> {
  public:
    Part() noexcept : RtmSafetyComponent("part") {}
};
}  // namespace create_function
