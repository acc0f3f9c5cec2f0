// SPDX-License-Identifier: Apache-2.0
// Goal: the shipped model is read as written; a file with any one defect is refused with file, line, place
// and key. Method: the shipped text, with one line of joint J3, the gripper or the head changed at a time.
#include "mamori/simbody_sim/arm_model.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <vector>

#include "arm_test_support.hpp"

namespace mamori::sim {
namespace {

using namespace test;

constexpr std::size_t kNowhere = std::string::npos;

/// A figure of the file: where it stands and what its range forbids.
struct Figure {
    const char* block;    ///< line that begins the block, as written
    const char* section;  ///< line of the map within the block; empty for none
    const char* key;
    std::size_t size;  ///< 0: a number, otherwise elements of a list
    bool negative_ok;
    bool zero_ok;
};

constexpr const char* kJoint = "  - name: J3";
constexpr const char* kGripper = "gripper:";

const std::vector<Figure> kFigures{
    {"gravity_m_s2", "", "gravity_m_s2", 3U, true, true},
    {"motion_columns_ignored", "", "motion_columns_ignored", 0U, false, true},
    {"drive:", "", "sto_delay_s", 0U, false, true},
    {kJoint, "", "axis", 3U, true, false},
    {kJoint, "", "offset_m", 3U, true, true},
    {kJoint, "", "mass_kg", 0U, false, false},
    {kJoint, "", "center_of_mass_m", 3U, true, true},
    {kJoint, "", "inertia_kg_m2", 6U, false, false},
    {kJoint, "", "position_range_rad", 2U, true, false},
    {kJoint, "", "speed_limit_rad_s", 0U, false, false},
    {kJoint, "", "torque_limit_nm", 0U, false, false},
    {kJoint, "", "rotor_inertia_kg_m2", 0U, false, false},
    {kJoint, "", "gear_ratio", 0U, false, false},
    {kJoint, "", "viscous_friction_nm_s_rad", 0U, false, true},
    {kJoint, "    brake:", "torque_nm", 0U, false, false},
    {kJoint, "    brake:", "closing_delay_s", 0U, false, true},
    {kJoint, "    brake:", "opening_delay_s", 0U, false, true},
    {kJoint, "    brake:", "stiffness_nm_rad", 0U, false, false},
    {kJoint, "    brake:", "damping_nm_s_rad", 0U, false, true},
    {kJoint, "    end_stop:", "stiffness_nm_rad", 0U, false, false},
    {kJoint, "    end_stop:", "dissipation_s_rad", 0U, false, true},
    {kJoint, "", "encoder_a_counts_per_rad", 0U, false, false},
    {kJoint, "", "encoder_b_counts_per_rad", 0U, false, false},
    {kGripper, "", "mass_kg", 0U, false, false},
    {kGripper, "", "center_of_mass_m", 3U, true, true},
    {kGripper, "", "inertia_kg_m2", 6U, false, false},
};

class ArmModelTest : public ::testing::Test {
  protected:
    ArmModelTest() {
        std::ifstream file(MAMORI_ARM_MODEL_FILE);
        std::string line;
        while (std::getline(file, line)) {
            lines_.push_back(line);
        }
    }

    std::size_t find_line(std::size_t from, const std::string& text) const {
        for (std::size_t i = from; i < lines_.size(); ++i) {
            if (lines_[i].find(text) != kNowhere) {
                return i;
            }
        }
        ADD_FAILURE() << text;
        return 0U;
    }
    std::size_t find_line(const Figure& figure) const {
        const std::size_t block = find_line(0U, figure.block);
        const std::size_t section = *figure.section == '\0' ? block : find_line(block, figure.section);
        return find_line(section, std::string(figure.key) + ":");
    }
    /// Value of the figure on a line, brackets included.
    static std::string replace_value(const std::string& line, const std::string& value) {
        const std::size_t begin = line.find("value: ") + 7U;
        const std::size_t end = line[begin] == '[' ? line.find(']', begin) + 1U : line.find(',', begin);
        return line.substr(0U, begin) + value + line.substr(end);
    }
    /// The text with line `index` replaced; an empty replacement removes the line.
    std::string join(std::size_t index, const std::string& replacement) const {
        std::string text;
        for (std::size_t i = 0U; i < lines_.size(); ++i) {
            const std::string& line = i == index ? replacement : lines_[i];
            text += i == index && replacement.empty() ? "" : line + "\n";
        }
        return text;
    }
    std::string get_error(std::size_t index, const std::string& replacement) const {
        const LoadedModel loaded = parse_arm_model(join(index, replacement), "arm.yaml");
        EXPECT_FALSE(loaded.model) << replacement;
        EXPECT_EQ(loaded.error.find('\n'), kNowhere);
        return loaded.error;
    }
    /// Error of the figure with another value; checks that it names the line, the place and the key.
    std::string get_error(const Figure& figure, const std::string& value) const {
        const std::size_t index = find_line(figure);
        const std::string error = get_error(index, replace_value(lines_[index], value));
        EXPECT_EQ(error.find("arm.yaml:" + std::to_string(index + 1U) + ": "), 0U) << error;
        expect_names(figure, error);
        return error;
    }
    static void expect_names(const Figure& figure, const std::string& error) {
        EXPECT_NE(error.find(std::string(": ") + figure.key + ": "), kNowhere) << error;
        if (figure.block == kJoint) {
            EXPECT_NE(error.find(": joint J3: "), kNowhere) << error;
        } else if (figure.block == kGripper) {
            EXPECT_NE(error.find(": gripper: "), kNowhere) << error;
        }
    }
    static std::string make_value(const Figure& figure, const std::string& element) {
        std::string list = element;
        for (std::size_t i = 1U; i < figure.size; ++i) {
            list += ", " + element;
        }
        return figure.size == 0U ? element : "[" + list + "]";
    }
    Figure find_figure(const char* key, const char* section = "") const {
        return *std::find_if(kFigures.begin(), kFigures.end(), [key, section](const Figure& figure) {
            return std::string(figure.key) == key && std::string(figure.section) == section &&
                   figure.block != kGripper;
        });
    }

    std::vector<std::string> lines_;
};

TEST_F(ArmModelTest, ShippedModelIsReadAsWritten) {
    verifies("SWR-SIM-001");
    const ArmModel model = load_shipped_model();

    EXPECT_EQ(model.name, "PA10-like");
    EXPECT_EQ(model.motion_columns_ignored, 2U);
    EXPECT_EQ(model.gravity_m_s2, (Vector3{0.0, 0.0, -9.80665}));
    EXPECT_EQ(model.sto_delay, 2_ms);
    EXPECT_EQ(model.gripper.mass_kg, 1.0);
    const JointModel& joint = model.joints[1];
    EXPECT_EQ(joint.name, "J2");
    EXPECT_EQ(joint.axis, (Vector3{1.0, 0.0, 0.0}));
    EXPECT_EQ(joint.offset_m, (Vector3{0.0, 0.0, 0.115}));
    EXPECT_EQ(joint.link.mass_kg, 8.41);
    EXPECT_EQ(joint.link.center_of_mass_m, (Vector3{0.0, 0.0, 0.06175}));
    EXPECT_NEAR(joint.position_max_rad, 94.0 * std::acos(-1.0) / 180.0, 1.0e-6);
    EXPECT_EQ(joint.position_min_rad, -joint.position_max_rad);
    EXPECT_EQ(joint.torque_limit_nm, 232.0);
    EXPECT_EQ(joint.brake.torque_nm, 348.0);
    EXPECT_EQ(joint.brake.closing_delay, 30_ms);
    EXPECT_EQ(joint.brake.opening_delay, 50_ms);
    EXPECT_EQ(joint.encoder_a_counts_per_rad, 65189.8647);
    EXPECT_EQ(joint.encoder_b_counts_per_rad, 20860.7567);
}

TEST_F(ArmModelTest, ShippedInertiasAreThoseOfTheStatedCylinders) {
    verifies("SWR-SIM-001", Technique::kBackToBack);
    const ArmModel model = load_shipped_model();
    const std::array<std::array<double, 2U>, kArmJointCount> cylinders{
        {{0.115, 0.15}, {0.06, 0.34}, {0.09, 0.22}, {0.05, 0.3}, {0.07, 0.275}, {0.035, 0.23}, {0.04, 0.09}}};

    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        const auto [radius, length] = cylinders[i];
        const double mass = model.joints[i].link.mass_kg;
        const auto& inertia = model.joints[i].link.inertia_kg_m2;
        const double across = mass * (3.0 * radius * radius + length * length) / 12.0;
        EXPECT_NEAR(inertia[0], across, 1.0e-5 * across);
        EXPECT_NEAR(inertia[1], across, 1.0e-5 * across);
        EXPECT_NEAR(inertia[2], 0.5 * mass * radius * radius, 1.0e-5 * across);
    }
}

TEST_F(ArmModelTest, AMissingFigureIsRefusedByName) {
    verifies("SWR-SIM-001", Technique::kErrorGuessing, Polarity::kViolation);

    for (const Figure& figure : kFigures) {
        const std::string error = figure.block == std::string("drive:") ? get_error(find_line(figure), "  {}")
                                                                        : get_error(find_line(figure), "");
        expect_names(figure, error);
        EXPECT_NE(error.find("is missing"), kNowhere) << error;
    }
}

TEST_F(ArmModelTest, ANegativeFigureIsRefusedByName) {
    verifies("SWR-SIM-001", Technique::kBoundaryValues, Polarity::kViolation);

    for (const Figure& figure : kFigures) {
        if (!figure.negative_ok) {
            static_cast<void>(get_error(figure, make_value(figure, "-1")));
        }
    }
}

TEST_F(ArmModelTest, AZeroIsRefusedWhereItCannotBe) {
    verifies("SWR-SIM-001", Technique::kBoundaryValues, Polarity::kViolation);

    for (const Figure& figure : kFigures) {
        if (!figure.zero_ok) {
            static_cast<void>(get_error(figure, make_value(figure, "0")));
        } else {
            const std::size_t index = find_line(figure);
            const std::string text = join(index, replace_value(lines_[index], make_value(figure, "0")));
            EXPECT_TRUE(parse_arm_model(text, "arm.yaml").model) << parse_arm_model(text, "arm.yaml").error;
        }
    }
}

TEST_F(ArmModelTest, AFigureThatIsNoFiniteNumberIsRefusedByName) {
    verifies("SWR-SIM-001", Technique::kErrorGuessing, Polarity::kViolation);

    for (const Figure& figure : kFigures) {
        for (const char* const word : {".nan", ".inf", "nan", "inf", "heavy", "1kg", "''", "1e999"}) {
            const std::string error = get_error(figure, make_value(figure, word));
            EXPECT_NE(error.find("must be a finite number"), kNowhere) << error;
        }
    }
}

TEST_F(ArmModelTest, AFigureOfTheWrongShapeIsRefusedByName) {
    verifies("SWR-SIM-001", Technique::kErrorGuessing, Polarity::kViolation);

    for (const Figure& figure : kFigures) {
        const std::string longer =
            figure.size == 0U ? "[1]" : make_value({"", "", "", figure.size + 1U, true, true}, "1");
        const std::string error = get_error(figure, longer);
        EXPECT_NE(error.find(figure.size == 0U ? "must be one number" : "must be a list of"), kNowhere)
            << error;
        const std::size_t index = find_line(figure);
        const std::string bare = lines_[index].substr(0U, lines_[index].find('{')) + "1";
        EXPECT_NE(get_error(index, bare).find("must be written as {value: ..."), kNowhere);
    }
}

TEST_F(ArmModelTest, AFigureWithoutOriginIsRefused) {
    verifies("SWR-SIM-002", Technique::kErrorGuessing, Polarity::kViolation);

    for (const Figure& figure : kFigures) {
        const std::size_t index = find_line(figure);
        const std::string bare = replace_value(lines_[index], "1");
        const std::string without = bare.substr(0U, bare.find(',')) + "}";
        const std::string error = get_error(index, without);
        expect_names(figure, error);
        EXPECT_NE(error.find("needs a source or an assumption"), kNowhere) << error;
    }
}

TEST_F(ArmModelTest, AnOriginMustBeOneText) {
    verifies("SWR-SIM-002", Technique::kEquivalenceClasses, Polarity::kViolation);
    const std::size_t index = find_line(find_figure("mass_kg"));

    EXPECT_NE(get_error(index, "    mass_kg: {value: 1, source: ''}").find("its source must be a text"),
              kNowhere);
    EXPECT_NE(
        get_error(index, "    mass_kg: {value: 1, assumption: []}").find("its assumption must be a text"),
        kNowhere);
    EXPECT_NE(
        get_error(index, "    mass_kg: {value: 1, source: a, assumption: b}").find("more than one origin"),
        kNowhere);
    EXPECT_NE(get_error(index, "    mass_kg: {value: 1, origin: a}").find("unknown key 'origin'"), kNowhere);
    EXPECT_NE(get_error(index, "    mass_kg: {source: a}").find("its value is missing"), kNowhere);
}

TEST_F(ArmModelTest, EitherOriginIsAccepted) {
    verifies("SWR-SIM-002");
    const std::size_t index = find_line(find_figure("mass_kg"));

    for (const char* const line :
         {"    mass_kg: {value: 1.5, source: weighed}", "    mass_kg: {value: 1.5, assumption: guessed}"}) {
        const LoadedModel loaded = parse_arm_model(join(index, line), "arm.yaml");
        ASSERT_TRUE(loaded.model) << loaded.error;
        EXPECT_EQ(loaded.model->joints[2].link.mass_kg, 1.5);
    }
}

TEST_F(ArmModelTest, AnImpossibleInertiaIsRefused) {
    verifies("SWR-SIM-001", Technique::kBoundaryValues, Polarity::kViolation);
    const Figure inertia = find_figure("inertia_kg_m2");

    EXPECT_NE(get_error(inertia, "[1, 1, 2.001, 0, 0, 0]").find("triangle inequality"), kNowhere);
    EXPECT_NE(get_error(inertia, "[1, 2.001, 1, 0, 0, 0]").find("triangle inequality"), kNowhere);
    EXPECT_NE(get_error(inertia, "[2, 2, 1, 1.6, 0, 0]").find("triangle inequality"), kNowhere)
        << "principal moments 3.6, 0.4 and 1";
    EXPECT_NE(get_error(inertia, "[1, 1, 1, 1.1, 0, 0]").find("not positive definite"), kNowhere);
    EXPECT_NE(get_error(inertia, "[1, 1, 1, 0.9, -0.9, 0.9]").find("not positive definite"), kNowhere);
    const std::size_t index = find_line(inertia);
    for (const char* const possible :
         {"[1, 1, 2, 0, 0, 0]", "[1, 1, 1.999, 0, 0, 0]", "[1, 1, 1, 0.1, -0.1, 0.1]"}) {
        const LoadedModel loaded =
            parse_arm_model(join(index, replace_value(lines_[index], possible)), "arm.yaml");
        EXPECT_TRUE(loaded.model) << loaded.error;
    }
}

TEST_F(ArmModelTest, FiguresThatContradictEachOtherAreRefused) {
    verifies("SWR-SIM-001", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_NE(get_error(find_figure("position_range_rad"), "[1, 1]").find("must grow"), kNowhere);
    EXPECT_NE(get_error(find_figure("position_range_rad"), "[1, -1]").find("must grow"), kNowhere);
    EXPECT_NE(get_error(find_figure("axis"), "[0, 0, 0.999]").find("length 1"), kNowhere);
    EXPECT_NE(get_error(find_figure("encoder_a_counts_per_rad"), "1e9").find("32-bit count"), kNowhere);
    EXPECT_NE(get_error(find_figure("motion_columns_ignored"), "1.5").find("whole number"), kNowhere);
    const std::size_t brake = find_line(find_figure("stiffness_nm_rad", "    brake:"));
    EXPECT_NE(get_error(brake, replace_value(lines_[brake], "1e8")).find("joint J3: brake: is too stiff"),
              kNowhere);
    const std::size_t stop = find_line(find_figure("stiffness_nm_rad", "    end_stop:"));
    EXPECT_NE(get_error(stop, replace_value(lines_[stop], "1e8")).find("joint J3: end_stop: is too stiff"),
              kNowhere);
}

TEST_F(ArmModelTest, DelaysHaveAnUpperLimit) {
    verifies("SWR-SIM-001", Technique::kBoundaryValues, Polarity::kViolation);
    const Figure delay = find_figure("closing_delay_s", "    brake:");
    const std::size_t index = find_line(delay);

    EXPECT_TRUE(parse_arm_model(join(index, replace_value(lines_[index], "10")), "arm.yaml").model);
    EXPECT_NE(get_error(delay, "10.001").find("at most 10"), kNowhere);
}

TEST_F(ArmModelTest, UnknownAndRepeatedKeysAreRefused) {
    verifies("SWR-SIM-001", Technique::kErrorGuessing, Polarity::kViolation);
    const std::size_t index = find_line(find_figure("mass_kg"));

    EXPECT_NE(get_error(index, "    mas_kg: {value: 1, source: a}")
                  .find(": joint J3: unknown key 'mas_kg'; did you mean 'mass_kg'?"),
              kNowhere);
    EXPECT_NE(get_error(index, lines_[index] + "\n" + lines_[index]).find("mass_kg: is given twice"),
              kNowhere);
    EXPECT_NE(get_error(index, lines_[index] + "\n    [a]: 1").find("plain word"), kNowhere);
}

TEST_F(ArmModelTest, AFileThatIsNoModelIsRefused) {
    verifies("SWR-SIM-001", Technique::kErrorGuessing, Polarity::kViolation);
    const auto get_text_error = [](const std::string& text) {
        return parse_arm_model(text, "arm.yaml").error;
    };

    EXPECT_NE(get_text_error("").find("must be a map"), kNowhere);
    EXPECT_NE(get_text_error("just words").find("must be a map"), kNowhere);
    EXPECT_NE(get_text_error("schema: [1").find("not readable as YAML"), kNowhere);
    EXPECT_NE(load_arm_model("no/such/file.yaml").error.find("no/such/file.yaml: cannot be read"), kNowhere);
    EXPECT_NE(get_error(find_line(0U, "schema:"), "schema: mamori.arm_model/2")
                  .find("must be 'mamori.arm_model/1'"),
              kNowhere);
    EXPECT_NE(get_error(find_line(0U, "name: PA10-like"), "name: ''").find("name: must be a text"), kNowhere);
    EXPECT_NE(get_error(find_line(0U, "  - name: J3"), "  - name: J2").find("given to two joints"), kNowhere);
}

TEST_F(ArmModelTest, ADifferentNumberOfJointsIsRefused) {
    verifies("SWR-SIM-001", Technique::kBoundaryValues, Polarity::kViolation);
    std::string shorter;
    const std::size_t last = find_line(0U, "  - name: J7");
    const std::size_t end = find_line(0U, kGripper);
    for (std::size_t i = 0U; i < lines_.size(); ++i) {
        shorter += i >= last && i < end ? "" : lines_[i] + "\n";
    }

    const LoadedModel loaded = parse_arm_model(shorter, "arm.yaml");
    EXPECT_FALSE(loaded.model);
    EXPECT_NE(loaded.error.find("joints: must be a list of 7 elements, has 6"), kNowhere) << loaded.error;
}

}  // namespace
}  // namespace mamori::sim
