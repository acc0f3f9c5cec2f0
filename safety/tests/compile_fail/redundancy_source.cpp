// SPDX-License-Identifier: Apache-2.0
// Compiled by the tests of tests/redundancy with one defect at a time; without a defect it compiles.
#include <limits>

#include "mamori/safety/redundancy/complement_stored.hpp"
#include "mamori/safety/redundancy/cross_comparison.hpp"

struct Ports {
    double position_rad;
    float torque_nm;
    int mode;
    bool is_on;
    mamori::BoundedSequence<double, 2U> forces_n;
    mamori::BoundedString<4U> name;
};
MAMORI_FIELDS(Ports, position_rad, torque_nm, mode, is_on, forces_n, name)

struct Gap {
    char small;
    int large;
};
struct FloatGap {
    float small;
    double large;
};
MAMORI_FIELDS(FloatGap, small, large)
struct Floats {
    double a;
    double b;
};
MAMORI_FIELDS(Floats, a, b)
struct Owner {
    Owner() = default;
    Owner(const Owner&) {}
};

namespace {

using mamori::safety::ComplementStored;
using mamori::safety::CrossComparison;

constexpr ComplementStored<Floats> kStored({1.0, 2.0});
#ifdef MAMORI_DEFECT_PADDING
constexpr ComplementStored<Gap> kGap({'a', 1});
#endif
#ifdef MAMORI_DEFECT_FLOAT_PADDING
constexpr ComplementStored<FloatGap> kFloatGap({1.0F, 1.0});
#endif
#ifdef MAMORI_DEFECT_NOT_BYTES
const ComplementStored<Owner> kOwner(Owner{});
#endif

constexpr Ports make_tolerance() {
    Ports tolerance{0.5, 0.25F, 0, false, std::array{1.0, 1.0}, {}};
#ifdef MAMORI_DEFECT_NEGATIVE
    tolerance.position_rad = -0.5;
#endif
#ifdef MAMORI_DEFECT_INFINITE
    tolerance.torque_nm = std::numeric_limits<float>::infinity();
#endif
#ifdef MAMORI_DEFECT_NAN
    tolerance.position_rad = std::numeric_limits<double>::quiet_NaN();
#endif
#ifdef MAMORI_DEFECT_EXACT_INTEGER
    tolerance.mode = 1;
#endif
#ifdef MAMORI_DEFECT_EXACT_BOOL
    tolerance.is_on = true;
#endif
#ifdef MAMORI_DEFECT_SHORT_SEQUENCE
    tolerance.forces_n = std::array{1.0};
#endif
#ifdef MAMORI_DEFECT_TEXT
    tolerance.name = "a";
#endif
    return tolerance;
}

constexpr Ports kTolerance = make_tolerance();
[[maybe_unused]] CrossComparison<Ports, kTolerance> g_comparison(mamori::Duration{0});

}  // namespace
