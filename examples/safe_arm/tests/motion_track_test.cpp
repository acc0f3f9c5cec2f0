// SPDX-License-Identifier: Apache-2.0
// Goal: a table becomes the motion it describes, and a broken one is refused by file and line. Method: tables
// written here.
#include "motion_track.hpp"

#include <cmath>
#include <fstream>

#include "mamori/trace/verifies.hpp"

namespace safe_arm {
namespace {

using namespace mamori::verification;

class MotionTrackTest : public ::testing::Test {
  protected:
    std::string write_table(const std::string& text) {
        const std::string path = ::testing::TempDir() + "motion_track_test.dat";
        std::ofstream{path} << text;
        return path;
    }
    /// Reads `text` and expects a refusal that names `where` and contains `what`.
    void expect_refused(const std::string& text, const std::string& where, const std::string& what) {
        std::string error;
        EXPECT_FALSE(sut_.read(write_table(text), 0.001, error));
        EXPECT_NE(error.find(where), std::string::npos) << error;
        EXPECT_NE(error.find(what), std::string::npos) << error;
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }

    MotionTrack sut_;
};

TEST_F(MotionTrackTest, ParabolaComesBackWithItsVelocityAndAcceleration) {
    verifies("SWR-SAF-011");
    std::string table = "# time and seven joints\n";
    for (int i = 0; i <= 100; ++i) {
        const double t = 0.01 * i;
        table +=
            std::to_string(t) + " " + std::to_string(0.5 * t * t) + " 1 2 3 4 5 " + std::to_string(-t) + "\n";
    }
    std::string error;
    ASSERT_TRUE(sut_.read(write_table(table), 0.001, error)) << error;

    EXPECT_NEAR(sut_.get_duration_s(), 1.0, 1e-9);
    const PathPoint point = sut_.calc_point(0.5035);
    EXPECT_NEAR(point.position_rad[0], 0.5 * 0.5035 * 0.5035, 2e-6);
    EXPECT_NEAR(point.velocity_rad_s[0], 0.5035, 2e-3);
    EXPECT_NEAR(point.acceleration_rad_s2[0], 1.0, 0.1);
    EXPECT_DOUBLE_EQ(point.position_rad[3], 3.0);
    EXPECT_NEAR(point.velocity_rad_s[6], -1.0, 1e-6);
}

TEST_F(MotionTrackTest, PathIsHeldAtBothEnds) {
    verifies("SWR-SAF-011", Technique::kBoundaryValues);
    std::string error;
    ASSERT_TRUE(sut_.read(write_table("0 1 1 1 1 1 1 1\n0.5 2 2 2 2 2 2 2\n"), 0.001, error)) << error;

    EXPECT_EQ(sut_.calc_point(-1.0).position_rad[0], 1.0);
    EXPECT_EQ(sut_.calc_point(0.0).velocity_rad_s[0], 0.0);
    EXPECT_EQ(sut_.calc_point(9.0).position_rad[6], 2.0);
    EXPECT_EQ(sut_.calc_point(9.0).velocity_rad_s[6], 0.0);
}

TEST_F(MotionTrackTest, BrokenTableIsRefusedWithFileAndLine) {
    verifies("SWR-SAF-011", Technique::kErrorGuessing, Polarity::kViolation);
    const std::string good = "0 1 1 1 1 1 1 1\n";

    expect_refused(good + "0.1 1 1 1 1 1 1\n", ".dat:2:", "7 joint angles");
    expect_refused(good + "0.1 1 1 1 1 1 1 1 1\n", ".dat:2:", "7 joint angles");
    expect_refused(good + "0.1 1 1 1 nan 1 1 1\n", ".dat:2:", "finite");
    expect_refused(good + "0.1 1 1 1 x 1 1 1\n", ".dat:2:", "finite");
    expect_refused(good + "0 1 1 1 1 1 1 1\n", ".dat:2:", "rise");
    expect_refused("0.1 1 1 1 1 1 1 1\n", ".dat:1:", "begin at 0");
    expect_refused(good, ".dat:", "fewer than 2");
    expect_refused("", ".dat:", "fewer than 2");
}

TEST_F(MotionTrackTest, RefusedTableLeavesTheTrackAsItWas) {
    verifies("SWR-SAF-011", Technique::kErrorGuessing, Polarity::kViolation);
    std::string error;
    ASSERT_TRUE(sut_.read(write_table("0 1 1 1 1 1 1 1\n1 2 2 2 2 2 2 2\n"), 0.001, error)) << error;

    EXPECT_FALSE(sut_.read("/nowhere/motion.dat", 0.001, error));
    EXPECT_NE(error.find("/nowhere/motion.dat"), std::string::npos);
    EXPECT_EQ(sut_.get_duration_s(), 1.0);
}

}  // namespace
}  // namespace safe_arm
