// SPDX-License-Identifier: Apache-2.0
// What the compiler rejects: a port in C and a port in C++ with different payload types.
// Each namespace compiles, and does not with its MAMORI_BREAK_<NAME>.
#include "mamori/kernel/c/c_component.hpp"

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
