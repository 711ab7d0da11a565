#include "io/ascii_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace talus {
namespace {

const std::string header =
    "ncols 3\nnrows 2\nxllcorner 100\nyllcorner -50\ncellsize 10\nNODATA_value -9999\n";

std::string failure_of(const std::string& text) {
    try {
        parse_ascii_grid(text);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

TEST(AsciiGrid, PlacesValuesAtCentresOfCellsFromTheSouth) {
    const TerrainGrid grid = parse_ascii_grid(header + "1 2 3\n4 -9999 6\n");
    EXPECT_EQ(grid.columns, 3U);
    EXPECT_EQ(grid.rows, 2U);
    EXPECT_EQ(grid.origin, (std::array<double, 2>{105, -45}));
    EXPECT_EQ(grid.spacing, (std::array<double, 2>{10, 10}));
    EXPECT_EQ(grid.at(0, 0), 4);
    EXPECT_EQ(grid.at(2, 1), 3);
    EXPECT_TRUE(std::isnan(grid.at(1, 0)));
}

TEST(AsciiGrid, ReadsWhatPeersWrite) {
    const TerrainGrid centred = parse_ascii_grid(
        "NCOLS 2\r\nNROWS 2\r\nXLLCENTER 1e2\r\nYLLCENTER +3\r\nDX 2\r\nDY 4\r\n1 2\r\n 3 4\r\n");
    EXPECT_EQ(centred.origin, (std::array<double, 2>{100, 3}));
    EXPECT_EQ(centred.spacing, (std::array<double, 2>{2, 4}));
    EXPECT_EQ(centred.at(1, 1), 2);
    // Lines may be broken anywhere, the value for nothing may be NaN.
    const TerrainGrid broken =
        parse_ascii_grid("nrows 2 ncols 2 xllcorner 0 yllcenter 0\ncellsize 1\nnodata_value nan\n1\nnan 3 4");
    EXPECT_EQ(broken.origin, (std::array<double, 2>{0.5, 0}));
    EXPECT_TRUE(std::isnan(broken.at(1, 1)));
    EXPECT_EQ(broken.at(1, 0), 4);
}

TEST(AsciiGrid, RefusesWhatIsNotANumber) {
    EXPECT_EQ(failure_of(header + "1 2 3\n4 x 6\n"), "line 8: 'x' in column 2, row 2 is not a number");
    EXPECT_EQ(failure_of(header + "1 2,5 3\n4 5 6\n"), "line 7: '2,5' in column 2, row 1 is not a number");
    EXPECT_EQ(failure_of(header + "1 nan 3\n4 5 6\n"), "line 7: 'nan' in column 2, row 1 is not a number");
    EXPECT_EQ(failure_of(header + "1 inf 3\n4 5 6\n"), "line 7: 'inf' in column 2, row 1 is not a number");
    EXPECT_EQ(failure_of("ncols x\n"), "line 1: ncols is 'x', not a number");
}

TEST(AsciiGrid, RefusesHeadersThatAreNotWhole) {
    EXPECT_EQ(failure_of("ncolumns 3\n"), "line 1: 'ncolumns' is no key of an ESRI ASCII grid");
    EXPECT_EQ(failure_of("ncols 3\nncols 3\n"), "line 2: ncols is given twice");
    EXPECT_EQ(failure_of("ncols 3\nnrows 2\n1 2 3 4 5 6"),
              "its header must have cellsize, or dx and dy, positive");
    EXPECT_EQ(failure_of("ncols 3\nnrows 2.5\n"), "its header must have nrows, a whole number of at least 2");
    EXPECT_EQ(failure_of("ncols 3\nnrows 2\ncellsize 1\nxllcorner 1\nxllcenter 1\nyllcorner 1\n1"),
              "its header must have one of xllcorner and xllcenter");
    EXPECT_EQ(failure_of(""), "its header must have ncols, a whole number of at least 2");
}

TEST(AsciiGrid, RefusesTooFewAndTooManyValues) {
    EXPECT_EQ(failure_of(header + "1 2 3\n4 5\n"), "ends in row 2 of 2, column 3 of 3");
    EXPECT_EQ(failure_of(header + "1 2 3\n4 5 6\n7\n"), "line 9: '7' after the 3 x 2 values");
}

TEST(AsciiGrid, WritesWhatItReads) {
    for (const std::string sizes : {"cellsize 4.997688906601\n", "dx 5\ndy 2.5\n"}) {
        const TerrainGrid grid =
            parse_ascii_grid("ncols 3\nnrows 2\nxllcenter 176973.437998359208\nyllcorner 376237.8\n" + sizes +
                             "NODATA_value -1\n0.5 1234.125 -1\n-3 1e-3 2\n");
        const TerrainGrid again = parse_ascii_grid(ascii_grid(grid));
        EXPECT_EQ(again.spacing, grid.spacing);
        EXPECT_NEAR(again.origin[0], grid.origin[0], 1e-9);
        EXPECT_NEAR(again.origin[1], grid.origin[1], 1e-9);
        for (std::size_t k = 0; k < 6; ++k) {
            EXPECT_EQ(std::isnan(again.elevations[k]), std::isnan(grid.elevations[k]));
            if (!std::isnan(grid.elevations[k])) {
                EXPECT_EQ(static_cast<float>(again.elevations[k]), static_cast<float>(grid.elevations[k]));
            }
        }
    }
}

// Before any room is made for them.
TEST(AsciiGrid, RefusesAHeaderThatPromisesMoreThanThereIs) {
    EXPECT_EQ(failure_of("ncols 1000000\nnrows 1000000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n"),
              "its header says 1000000 x 1000000 values; its 69 characters hold fewer");
}

}  // namespace
}  // namespace talus
