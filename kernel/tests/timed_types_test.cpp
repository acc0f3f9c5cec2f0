// SPDX-License-Identifier: Apache-2.0
// Goal: the types of BasicDataType.idl and ExtendedDataTypes.idl have the fields, order and size of the
// originals. Method: encoded sizes worked out by hand from the IDL; each field gets its place as its value;
// both ends of time.
#include "mamori/kernel/payload/timed_types.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/payload/detail/cdr_size.hpp"
#include "mamori/kernel/payload/extended_types_2d.hpp"
#include "mamori/kernel/payload/extended_types_3d.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::rtc {
namespace {

using namespace verification;

/// Largest sizes of several types, in order.
template <typename... T>
std::vector<std::size_t> sizes() {
    return {max_encoded_size<T>()...};
}

/// How many doubles T consists of.
template <typename T>
std::size_t count_doubles() {
    struct Counter {
        std::size_t count{0U};
        void operator()(double /*scalar*/) noexcept { ++count; }
    } counter;
    visit_scalars(T{}, counter);
    return counter.count;
}
template <typename... T>
std::vector<std::size_t> counts() {
    return {count_doubles<T>()...};
}

/// The scalars of a value as written.
template <typename T>
std::vector<double> list(const T& value) {
    struct Notes {
        std::vector<double> values;
        void operator()(double scalar) noexcept { values.push_back(scalar); }
    } notes;
    visit_scalars(value, notes);
    return notes.values;
}

/// Are all numbers of new values of these types 0?
template <typename... T>
bool are_zero() {
    return (... && (list(T{}) == std::vector<double>(count_doubles<T>(), 0.0)));
}

TEST(TimedTypesTest, BasicTypesHaveTheSizesOfTheOriginals) {
    verifies("SWR-CDR-005");

    EXPECT_EQ((sizes<Time, TimedState, TimedShort, TimedUShort, TimedLong, TimedULong>()),
              (std::vector<std::size_t>{8, 10, 10, 10, 12, 12}));
    EXPECT_EQ((sizes<TimedFloat, TimedDouble, TimedChar, TimedOctet, TimedBoolean, TimedString<7>>()),
              (std::vector<std::size_t>{12, 16, 9, 9, 9, 20}));
    EXPECT_EQ(
        (sizes<TimedShortSeq<3>, TimedUShortSeq<3>, TimedLongSeq<3>, TimedULongSeq<3>, TimedFloatSeq<3>>()),
        (std::vector<std::size_t>{18, 18, 24, 24, 24}));
    EXPECT_EQ((sizes<TimedDoubleSeq<3>, TimedCharSeq<3>, TimedOctetSeq<3>, TimedBooleanSeq<3>>()),
              (std::vector<std::size_t>{40, 15, 15, 15}));
    EXPECT_EQ((sizes<TimedStringSeq<2, 3>>()), std::vector<std::size_t>{28});
}

TEST(TimedTypesTest, ExtendedTypesHaveAsManyNumbersAsTheOriginals) {
    verifies("SWR-CDR-005", Technique::kInterface);

    EXPECT_EQ((counts<RGBColour, Point2D, Vector2D, Pose2D, Velocity2D, Acceleration2D, PoseVel2D, Size2D,
                      Geometry2D, Covariance2D, PointCovariance2D, Carlike, SpeedHeading2D>()),
              (std::vector<std::size_t>{3, 2, 2, 3, 3, 2, 6, 2, 5, 6, 3, 2, 2}));
    EXPECT_EQ((counts<Point3D, Vector3D, Orientation3D, Pose3D, Velocity3D, AngularVelocity3D, Acceleration3D,
                      AngularAcceleration3D, PoseVel3D, Size3D, Geometry3D, Covariance3D, SpeedHeading3D, OAP,
                      Quaternion>()),
              (std::vector<std::size_t>{3, 3, 3, 6, 6, 3, 3, 3, 12, 3, 9, 21, 4, 9, 4}));
    EXPECT_EQ((sizes<TimedPose2D, TimedPose3D, TimedGeometry3D, TimedCovariance3D, TimedQuaternion>()),
              (std::vector<std::size_t>{32, 56, 80, 176, 40}));
}

TEST(TimedTypesTest, NewValuesOfExtendedTypesAreZero) {
    verifies("SWR-CDR-005", Technique::kInterface);

    EXPECT_TRUE((are_zero<RGBColour, PoseVel2D, Vector2D, Acceleration2D, Geometry2D, Covariance2D,
                          PointCovariance2D, Carlike, SpeedHeading2D>()));
    EXPECT_TRUE((are_zero<PoseVel3D, AngularVelocity3D, Acceleration3D, AngularAcceleration3D, Geometry3D,
                          Covariance3D, SpeedHeading3D, OAP, Quaternion>()));
}

TEST(TimedTypesTest, FieldsAreInTheOrderOfTheOriginals) {
    verifies("SWR-CDR-005", Technique::kInterface);
    TimedPose3D pose;
    pose.tm = {1U, 2U};
    pose.data.position = {3.0, 4.0, 5.0};
    pose.data.orientation.r = 6.0;
    pose.data.orientation.p = 7.0;
    pose.data.orientation.y = 8.0;
    TimedSpeedHeading3D command;
    command.data.speed = 1.0;
    command.data.direction = {2.0, 3.0, 4.0};
    TimedCovariance3D covariance;
    covariance.data.xa = 6.0;
    covariance.data.aa = 21.0;

    EXPECT_EQ(list(pose), (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8}));
    EXPECT_EQ(list(command), (std::vector<double>{0, 0, 1, 2, 3, 4}));
    EXPECT_EQ(list(covariance)[7], 6.0);
    EXPECT_EQ(list(covariance)[22], 21.0);
}

TEST(TimedTypesTest, EachTypeIsOneOfItsOwnAndTravelsThroughAPort) {
    verifies("SWR-CDR-005", Technique::kInterface);
    static_assert(!std::is_same_v<TimedState, TimedShort>, "one form, two meanings");
    static_assert(!std::is_same_v<TimedPoint2D, TimedVector2D>, "one form, two meanings");
    static_assert(!std::is_same_v<TimedOctet, TimedBoolean> && !std::is_same_v<TimedOctet, TimedChar>);
    static_assert(is_payload<TimedStringSeq<2, 3>>() && is_payload<TimedOAP>());
    OutPort<TimedDoubleSeq<4>> port(kNoOwner, "torques");

    port.write({{1U, 0U}, std::array{0.5, 0.25}});
    ASSERT_TRUE(port.publish(Instant{0}));
    EXPECT_EQ(port.get_published().data[1], 0.25);
}

TEST(TimedTypesTest, InstantsBecomeStampsAndBack) {
    verifies("SWR-CDR-006", Technique::kBoundaryValues);
    constexpr std::int64_t kLast = 4'294'967'295'999'999'999;

    for (const std::int64_t ns :
         {std::int64_t{0}, std::int64_t{999'999'999}, std::int64_t{1'000'000'000}, kLast}) {
        const Result<Time> stamp = calc_time(Instant{ns});
        ASSERT_TRUE(stamp.has_value()) << ns;
        EXPECT_EQ(std::int64_t{stamp.get_value().sec} * 1'000'000'000 + stamp.get_value().nsec, ns);
        EXPECT_EQ(calc_instant(stamp.get_value()).get_value().ns, ns);
    }
}

TEST(TimedTypesTest, InstantsAndStampsWithoutACounterpartAreRefused) {
    verifies("SWR-CDR-006", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_EQ(calc_time(Instant{-1}).get_status(), Status::kBadParameter);
    EXPECT_EQ(calc_time(Instant{4'294'967'296'000'000'000}).get_status(), Status::kBadParameter);
    EXPECT_TRUE(calc_instant(Time{0U, 999'999'999U}).has_value());
    EXPECT_EQ(calc_instant(Time{0U, 1'000'000'000U}).get_status(), Status::kBadParameter);
    EXPECT_EQ(calc_instant(Time{0U, 4'294'967'295U}).get_status(), Status::kBadParameter);
}

}  // namespace
}  // namespace mamori::rtc
