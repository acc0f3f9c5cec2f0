# SPDX-License-Identifier: Apache-2.0
"""Small tests of each framework, and their results. The first tag is at a passed test, the second at a failed test, the third in dead code.

Samples with a command are shortened from real runs (GoogleTest 1.12, Catch2 2.13, doctest 2.4, Boost.Test 1.74, pytest, cargo 1.95). Tests
run the framework again if it is installed. The others follow the descriptions of their formats.
"""

from __future__ import annotations

from typing import NamedTuple


class Framework(NamedTuple):
    """`command` writes results.xml; `needs` are the required program and the required header."""

    file: str
    source: str
    result: str
    command: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()

    @property
    def real(self) -> bool:
        return bool(self.command)


_DEAD = "#if 0\n// @verifies SWR-FW-003\n{head} {{}}\n#else\n#endif\n"
_CXX = ("g++", "-std=c++17", "-O0")


def _case(head: str, name: str, inner: str = "") -> str:
    return f'<testcase {head} name="{name}" time="0">{inner}</testcase>'


def _suite(*cases: str) -> str:
    return f'<?xml version="1.0" encoding="UTF-8"?><testsuites><testsuite name="s">{"".join(cases)}</testsuite></testsuites>'


_BAD = '<failure message="1 == 2" type="REQUIRE"/>'

FRAMEWORKS = {
    "googletest": Framework(
        "arm_test.cpp",
        "#include <gtest/gtest.h>\n// @verifies SWR-FW-001\nTEST(Arm, Stops) { EXPECT_EQ(1, 1); }\n"
        "class Rates : public testing::TestWithParam<int> {};\n// @verifies SWR-FW-002\nTEST_P(Rates, Hold) { EXPECT_LT(GetParam(), 2); }\n"
        "INSTANTIATE_TEST_SUITE_P(All, Rates, testing::Values(1, 2));\nTEST(Arm, Other) { EXPECT_EQ(1, 2); }\n" + _DEAD.format(head="TEST(Arm, Dead)"),
        _suite(_case('classname="Arm"', "Stops"), _case('classname="Arm"', "Other", _BAD),
               _case('classname="All/Rates"', "Hold/0"), _case('classname="All/Rates"', "Hold/1", _BAD)),
        ("sh", "-c", "g++ -std=c++17 arm_test.cpp -lgtest -lgtest_main -pthread -o t && ./t --gtest_output=xml:results.xml"),
        ("g++", "gtest/gtest.h"),
    ),
    "catch2": Framework(
        "arm_test.cpp",
        '#define CATCH_CONFIG_MAIN\n#include <catch2/catch.hpp>\nTEST_CASE("Before") { CHECK(true); }\n'
        '// @verifies SWR-FW-001\n'
        'TEST_CASE("Stops within 10 ms [fast] a/b (twice)", "[stop]") { SECTION("one") { CHECK(true); } SECTION("two") { CHECK(true); } }\n'
        '// @verifies SWR-FW-002\nTEMPLATE_TEST_CASE("Holds", "", int, char) { CHECK(sizeof(TestType) == 4); }\n'
        'TEST_CASE("Other") { CHECK(1 == 2); }\n' + _DEAD.format(head='TEST_CASE("Dead")'),
        _suite(_case('classname="t.global"', "Before"), _case('classname="t.global"', "Stops within 10 ms [fast] a/b (twice)/one"),
               _case('classname="t.global"', "Stops within 10 ms [fast] a/b (twice)/two"), _case('classname="t.global"', "Holds - int"),
               _case('classname="t.global"', "Holds - char", _BAD), _case('classname="t.global"', "Other", _BAD)),
        ("sh", "-c", "g++ -std=c++17 -O0 arm_test.cpp -o t && ./t -r junit > results.xml"),
        ("g++", "catch2/catch.hpp"),
    ),
    "doctest": Framework(
        "arm_test.cpp",
        '#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN\n#include <doctest/doctest.h>\nTEST_CASE("Before") { CHECK(true); }\n'
        '// @verifies SWR-FW-001\nSCENARIO("Arm stops") { GIVEN("a") { WHEN("b") { CHECK(true); } } }\n'
        '// @verifies SWR-FW-002\nTEST_CASE_TEMPLATE("Holds", T, int, char) { CHECK(sizeof(T) == 4); }\n'
        'TEST_CASE("Other") { CHECK(1 == 2); }\n' + _DEAD.format(head='TEST_CASE("Dead")'),
        _suite(_case('classname="arm_test.cpp"', "Before"), _case('classname="arm_test.cpp"', "  Scenario: Arm stops/   Given: a/    When: b"),
               _case('classname="arm_test.cpp"', "Holds&lt;int&gt;"), _case('classname="arm_test.cpp"', "Holds&lt;char&gt;", _BAD),
               _case('classname="arm_test.cpp"', "Other", _BAD)),
        ("sh", "-c", "g++ -std=c++17 -O0 arm_test.cpp -o t && ./t -r=junit -o=results.xml"),
        ("g++", "doctest/doctest.h"),
    ),
    "boost": Framework(
        "arm_test.cpp",
        "#define BOOST_TEST_MODULE arm\n#include <boost/test/included/unit_test.hpp>\n#include <boost/test/data/test_case.hpp>\n"
        "#include <boost/test/data/monomorphic.hpp>\nBOOST_AUTO_TEST_SUITE(outer)\nBOOST_AUTO_TEST_SUITE(stop)\n"
        "BOOST_AUTO_TEST_CASE(before) { BOOST_TEST(true); }\n// @verifies SWR-FW-001\nBOOST_AUTO_TEST_CASE(stops) { BOOST_TEST(1 == 1); }\n"
        "BOOST_AUTO_TEST_SUITE_END()\nBOOST_AUTO_TEST_SUITE_END()\n"
        "// @verifies SWR-FW-002\nBOOST_DATA_TEST_CASE(holds, boost::unit_test::data::xrange(2), rate) { BOOST_TEST(rate < 1); }\n"
        "BOOST_AUTO_TEST_CASE(other) { BOOST_TEST(1 == 2); }\n" + _DEAD.format(head="BOOST_AUTO_TEST_CASE(dead)"),
        '<?xml version="1.0" encoding="UTF-8"?><testsuite name="arm">' + _case('classname="outer.stop"', "before") + _case('classname="outer.stop"', "stops")
        + _case('classname="holds"', "_0") + _case('classname="holds"', "_1", _BAD) + _case("", "other", _BAD) + "</testsuite>",
        ("sh", "-c", "g++ -std=c++17 -O0 arm_test.cpp -o t && ./t --logger=JUNIT,all,results.xml; test -s results.xml"),
        ("g++", "boost/test/included/unit_test.hpp"),
    ),
    "pytest": Framework(
        "test_arm.py",
        "import pytest\n\n\n# @verifies SWR-FW-001\ndef test_stops():\n    pass\n\n\nclass TestRates:\n    @pytest.mark.parametrize('rate', [1, 2])\n"
        "    def test_holds(self, rate):\n        \"\"\"@verifies SWR-FW-002\"\"\"\n        assert rate < 2\n\n\ndef test_other():\n    assert False\n",
        _suite(_case('classname="test_arm"', "test_stops"), _case('classname="test_arm.TestRates"', "test_holds[1]"),
               _case('classname="test_arm.TestRates"', "test_holds[2]", _BAD), _case('classname="test_arm"', "test_other", _BAD)),
        ("{python}", "-P", "-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir=.", "--junitxml=results.xml", "test_arm.py"),
    ),
    "unittest": Framework(
        "test_arm.py",
        "import unittest\n\n\nclass StopTest(unittest.TestCase):\n    # @verifies SWR-FW-001\n    def test_stops(self):\n        pass\n\n"
        "    # @verifies SWR-FW-002\n    def test_holds(self):\n        self.fail()\n\n    def test_other(self):\n        self.fail()\n",
        _suite(_case('classname="test_arm.StopTest"', "test_holds", _BAD), _case('classname="test_arm.StopTest"', "test_other", _BAD),
               _case('classname="test_arm.StopTest"', "test_stops")),
        ("{python}", "-P", "-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir=.", "--junitxml=results.xml", "test_arm.py"),
    ),
    "cargo": Framework(
        "src/lib.rs",
        "pub fn stop() -> u32 { 10 }\n#[cfg(test)]\nmod tests {\n    mod inner {\n        #[test]\n        fn before() {}\n    }\n"
        "    // @verifies SWR-FW-001\n    #[test]\n    fn stops() { assert!(super::stop() <= 10); }\n    // @verifies SWR-FW-002\n    #[test]\n"
        "    fn holds() { assert!(super::stop() > 10); }\n    #[test]\n    fn other() { panic!(); }\n}\n",
        _suite(_case('classname="tests::inner"', "before"), _case('classname="tests"', "stops"),
               _case('classname="tests"', "holds", '<failure type="assert"/>'), _case('classname="tests"', "other", '<failure type="assert"/>')),
        ("sh", "-c", "printf '[package]\\nname = \"arm\"\\nversion = \"0.1.0\"\\nedition = \"2021\"\\n' > Cargo.toml && "
                     "RUSTC_BOOTSTRAP=1 cargo test --offline --lib -q -- -Z unstable-options --format junit > results.xml; test -s results.xml"),
        ("cargo",),
    ),
    "zephyr": Framework(
        "tests/main.c",
        "#include <zephyr/ztest.h>\nZTEST(arm, test_before) {}\n// @verifies SWR-FW-001\nZTEST(arm, test_stops)\n{\n}\n// @verifies SWR-FW-002\n"
        "ZTEST_F(arm, test_holds)\n{\n}\nZTEST(arm, test_other) {}\n" + _DEAD.format(head="ZTEST(arm, test_dead)"),
        _suite(_case('classname="arm"', "test_before"), _case('classname="arm"', "test_stops"), _case('classname="arm"', "test_holds", _BAD),
               _case('classname="arm"', "test_other", _BAD)),
    ),
    "unity": Framework(
        "tests/test_arm.c",
        '#include "unity.h"\nvoid setUp(void) {}\nvoid test_before(void) {}\n// @verifies SWR-FW-001\nvoid test_stops(void) { TEST_ASSERT(1); }\n'
        "// @verifies SWR-FW-002\nvoid test_holds(void)\n{\n    TEST_ASSERT(0);\n}\n" + _DEAD.format(head="void test_dead(void)"),
        _suite(_case('classname="test_arm"', "test_before"), _case('classname="test_arm"', "test_stops"), _case('classname="test_arm"', "test_holds", _BAD)),
    ),
    "junit5": Framework(
        "tests/ArmTest.java",
        "class ArmTest {\n  @Test\n  void before() {}\n  // @verifies SWR-FW-001\n  @Test\n  void stops() {}\n  // @verifies SWR-FW-002\n"
        "  @ParameterizedTest\n  void holds(int rate) {}\n}\n",
        _suite(_case('classname="org.arm.ArmTest"', "before()"), _case('classname="org.arm.ArmTest"', "stops()"),
               _case('classname="org.arm.ArmTest"', "holds(int)[1]"), _case('classname="org.arm.ArmTest"', "holds(int)[2]", _BAD)),
    ),
    "ctest": Framework(
        "tests/arm_test.cpp",
        "// @verifies SWR-FW-001\nADD_TEST(stops)\n{\n}\n// @verifies SWR-FW-002\nADD_TEST(holds)\n{\n}\n" + _DEAD.format(head="ADD_TEST(dead)"),
        _suite('<testcase classname="stops" name="stops" status="run"/>', f'<testcase classname="holds" name="holds" status="fail">{_BAD}</testcase>'),
    ),
}
