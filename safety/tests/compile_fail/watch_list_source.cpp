// SPDX-License-Identifier: Apache-2.0
// Compiled by watch_list_compile_test.cpp with one defect at a time; without a defect it compiles.
#include "mamori/kernel/system/system.hpp"
#include "mamori/safety/supervision/watch_check.hpp"

namespace {

using namespace mamori::literals;
using mamori::safety::watch;

class Part final : public mamori::Component {
  public:
    constexpr explicit Part(const char* name) noexcept : Component(name) {}
};
Part first{"first"};
Part second{"second"};
Part stranger{"stranger"};

constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("all", 0_us, 1_ms, mamori::budget(1_ms), mamori::run(first, second)));
MAMORI_CHECK(kSystem);

constexpr std::array kLimits = {
    watch(first, {{1U, 2U}, {0_us, 40_us}}),
#ifdef MAMORI_DEFECT_UNKNOWN_COMPONENT
    watch(stranger, {{1U, 2U}, {0_us, 40_us}}),
#endif
#ifdef MAMORI_DEFECT_TWICE
    watch(first, {{1U, 3U}, {0_us, 40_us}}),
#endif
#ifdef MAMORI_DEFECT_ALIVE
    watch(second, {{3U, 2U}, {0_us, 40_us}}),
#endif
#ifdef MAMORI_DEFECT_DEADLINE
    watch(second, {{1U, 2U}, {0_us, 0_us}}),
#endif
};
static_assert(mamori::safety::is_watch_list_of<kSystem, kLimits>());

}  // namespace
