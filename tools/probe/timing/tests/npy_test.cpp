// SPDX-License-Identifier: Apache-2.0
// Goal: the output is a NumPy array of format 1.0. Method: bytes derived from the description of the format;
// the tests of the host tool read such files with NumPy itself.
#include "npy.hpp"

#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"

namespace mamori::timing {
namespace {

using namespace verification;

TEST(Npy, RowsFollowAHeaderThatNamesThemAndEndsAtAMultipleOf64) {
    verifies("SWR-TIM-003");
    NpyTable sut{{{"at", 8U}, {"who", 4U}}};

    for (const std::int64_t cell : {std::int64_t{-2}, std::int64_t{258}}) {
        sut.add(cell);
    }
    const std::string file = sut.make();

    const std::size_t size = static_cast<unsigned char>(file[8]) + 256U * static_cast<unsigned char>(file[9]);
    EXPECT_EQ(file.substr(0U, 8U), (std::string{"\x93NUMPY\x01\x00", 8U}));
    EXPECT_EQ((10U + size) % 64U, 0U);
    EXPECT_EQ(file[9U + size], '\n');
    const std::string header =
        "{'descr': [('at', '<i8'), ('who', '<u4'), ], 'fortran_order': False, 'shape': (1,), }";
    EXPECT_EQ(file.substr(10U, header.size()), header);
    EXPECT_EQ(file.substr(10U + size),
              (std::string{"\xFE\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x02\x01\x00\x00", 12U}));
}

TEST(Npy, ATableWithoutRowsIsAValidFile) {
    verifies("SWR-TIM-003");
    const std::string file = NpyTable{{{"at", 8U}}}.make();

    EXPECT_NE(file.find("'shape': (0,)"), std::string::npos);
    EXPECT_EQ(file.back(), '\n');
}

}  // namespace
}  // namespace mamori::timing
