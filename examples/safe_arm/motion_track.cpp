// SPDX-License-Identifier: Apache-2.0
#include "motion_track.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace safe_arm {
namespace {

constexpr std::size_t kJoints = mamori::safety::kArmJointCount;
/// Half width of the difference quotients [s]: wide enough that a step of the recorded velocity does not ask
/// for an acceleration that no drive has, short against the motion itself.
constexpr double kVelocityHalfWidthS = 0.004;
constexpr double kAccelerationHalfWidthS = 0.008;

struct Row {
    double time_s{0.0};
    JointVector position_rad{};
};

bool parse_row(const std::string& line, Row& row) {
    std::istringstream words{line};
    if (!(words >> row.time_s) || !std::isfinite(row.time_s)) {
        return false;
    }
    for (double& position : row.position_rad) {
        if (!(words >> position) || !std::isfinite(position)) {
            return false;
        }
    }
    std::string rest;
    return !(words >> rest);
}

bool read_rows(const std::string& path, std::vector<Row>& rows, std::string& error) {
    std::ifstream file{path};
    if (!file) {
        error = path + ": cannot be opened: name a motion table that exists and can be read";
        return false;
    }
    std::string line;
    for (std::size_t number = 1U; std::getline(file, line); ++number) {
        line.erase(std::find(line.begin(), line.end(), '#'), line.end());
        if (line.find_first_not_of(" \t\r") == std::string::npos) {
            continue;
        }
        Row row{};
        const std::string where = path + ":" + std::to_string(number) + ": ";
        if (!parse_row(line, row)) {
            error = where + "a line holds the time and 7 joint angles, all finite numbers";
            return false;
        }
        if (rows.empty() ? row.time_s != 0.0 : row.time_s <= rows.back().time_s) {
            error = where + "times begin at 0 and rise from line to line";
            return false;
        }
        rows.push_back(row);
    }
    if (rows.size() < 2U) {
        error = path + ": holds fewer than 2 lines of motion";
        return false;
    }
    return true;
}

/// Cubic Hermite between rows, with the slopes of the neighbours: passes through every row without a corner.
double interpolate(const std::vector<Row>& rows, std::size_t left, double time_s, std::size_t joint) {
    const auto slope = [&rows, joint](std::size_t i) {
        const std::size_t before = i == 0U ? 0U : i - 1U;
        const std::size_t after = std::min(i + 1U, rows.size() - 1U);
        return (rows[after].position_rad[joint] - rows[before].position_rad[joint]) /
               (rows[after].time_s - rows[before].time_s);
    };
    const double width = rows[left + 1U].time_s - rows[left].time_s;
    const double u = (time_s - rows[left].time_s) / width;
    const double p0 = rows[left].position_rad[joint];
    const double p1 = rows[left + 1U].position_rad[joint];
    const double m0 = slope(left) * width;
    const double m1 = slope(left + 1U) * width;
    const double u2 = u * u;
    const double u3 = u2 * u;
    return (2.0 * u3 - 3.0 * u2 + 1.0) * p0 + (u3 - 2.0 * u2 + u) * m0 + (-2.0 * u3 + 3.0 * u2) * p1 +
           (u3 - u2) * m1;
}

std::vector<PathPoint> resample(const std::vector<Row>& rows, double period_s) {
    const auto count = static_cast<std::size_t>(std::ceil(rows.back().time_s / period_s)) + 1U;
    std::vector<PathPoint> points(count);
    std::size_t left = 0U;
    for (std::size_t i = 0U; i < count; ++i) {
        const double time_s = std::min(static_cast<double>(i) * period_s, rows.back().time_s);
        while (left + 2U < rows.size() && rows[left + 1U].time_s <= time_s) {
            ++left;
        }
        for (std::size_t j = 0U; j < kJoints; ++j) {
            points[i].position_rad[j] = interpolate(rows, left, time_s, j);
        }
    }
    return points;
}

/// Velocity and acceleration from central differences over the resampled positions.
void differentiate(std::vector<PathPoint>& points, double period_s) {
    const auto steps = [period_s](double half_width_s) {
        return std::max<std::ptrdiff_t>(1, std::lround(half_width_s / period_s));
    };
    const auto last = static_cast<std::ptrdiff_t>(points.size()) - 1;
    const auto at = [&points, last](std::ptrdiff_t i) -> const JointVector& {
        return points[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, last))].position_rad;
    };
    const std::ptrdiff_t nv = steps(kVelocityHalfWidthS);
    const std::ptrdiff_t na = steps(kAccelerationHalfWidthS);
    const double hv = static_cast<double>(nv) * period_s;
    const double ha = static_cast<double>(na) * period_s;
    for (std::ptrdiff_t i = 0; i <= last; ++i) {
        PathPoint& point = points[static_cast<std::size_t>(i)];
        for (std::size_t j = 0U; j < kJoints; ++j) {
            point.velocity_rad_s[j] = (at(i + nv)[j] - at(i - nv)[j]) / (2.0 * hv);
            point.acceleration_rad_s2[j] = (at(i + na)[j] - 2.0 * at(i)[j] + at(i - na)[j]) / (ha * ha);
        }
    }
}

}  // namespace

bool MotionTrack::read(const std::string& path, double period_s, std::string& error) {
    std::vector<Row> rows;
    if (!read_rows(path, rows, error)) {
        return false;
    }
    points_ = resample(rows, period_s);
    differentiate(points_, period_s);
    period_s_ = period_s;
    return true;
}

PathPoint MotionTrack::calc_point(double path_time_s) const {
    const double position = path_time_s <= 0.0 || period_s_ <= 0.0 ? 0.0 : path_time_s / period_s_;
    const auto last = static_cast<double>(points_.size() - 1U);
    if (position <= 0.0 || position >= last) {
        return {position <= 0.0 ? points_.front().position_rad : points_.back().position_rad, {}, {}};
    }
    const double left = std::floor(position);
    const double share = position - left;
    const PathPoint& a = points_[static_cast<std::size_t>(left)];
    const PathPoint& b = points_[static_cast<std::size_t>(left) + 1U];
    PathPoint point{};
    for (std::size_t j = 0U; j < kJoints; ++j) {
        point.position_rad[j] = a.position_rad[j] + share * (b.position_rad[j] - a.position_rad[j]);
        point.velocity_rad_s[j] = a.velocity_rad_s[j] + share * (b.velocity_rad_s[j] - a.velocity_rad_s[j]);
        point.acceleration_rad_s2[j] =
            a.acceleration_rad_s2[j] + share * (b.acceleration_rad_s2[j] - a.acceleration_rad_s2[j]);
    }
    return point;
}

double MotionTrack::get_duration_s() const {
    return static_cast<double>(points_.size() - 1U) * period_s_;
}

}  // namespace safe_arm
