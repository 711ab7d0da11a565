#include "io/raster.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>

#include "agreed_failure.hpp"
#include "random_particles.hpp"
#include "tests/support/shapefile.hpp"

namespace talus {
namespace {

using testing::agreed_failure;
using testing::SharedFolder;

/// A transverse Mercator grid of Austria, as GIS programs of two makers word it.
const std::string austria =
    R"(PROJCS["MGI / Austria GK West",GEOGCS["MGI",DATUM["Militar-Geographische_Institut",)"
    R"(SPHEROID["Bessel 1841",6377397.155,299.1528128]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],)"
    R"(PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",10.3333333333333],)"
    R"(PARAMETER["scale_factor",1],PARAMETER["false_easting",0],PARAMETER["false_northing",-5000000],UNIT["metre",1]])";
const std::string austria_of_esri =
    R"(PROJCS["MGI_Austria_GK_West",GEOGCS["GCS_MGI",DATUM["D_MGI",SPHEROID["Bessel_1841",6377397.155,299.1528128]],)"
    R"(PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],)"
    R"(PARAMETER["False_Easting",0.0],PARAMETER["False_Northing",-5000000.0],PARAMETER["Central_Meridian",10.3333333333333],)"
    R"(PARAMETER["Scale_Factor",1.0],PARAMETER["Latitude_Of_Origin",0.0],UNIT["Meter",1.0]])";
const std::string degrees =
    R"(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],)"
    R"(UNIT["degree",0.0174532925199433]])";

std::string with_meridian(std::string reference, const std::string& meridian) {
    const std::string before = "10.3333333333333";
    return reference.replace(reference.find(before), before.size(), meridian);
}

Raster hill() {
    Raster raster;
    raster.reference = austria;
    raster.grid = {
        .origin = {1002.5, 250005}, .spacing = {5, 10}, .columns = 40, .rows = 30, .elevations = {}};
    for (int k = 0; k < 1200; ++k) raster.grid.elevations.push_back(1500 + 90 * std::sin(0.1 * k));
    raster.grid.elevations[77] = std::numeric_limits<double>::quiet_NaN();
    return raster;
}

void write_text(const Communicator& comm, const std::filesystem::path& file, const std::string& text) {
    if (comm.is_root()) std::ofstream(file) << text;
    comm.all_barrier();
}

TEST(Raster, IsWrittenAndReadInBothFormats) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    const Raster raster = hill();
    for (const char* name : {"hill.tif", "hill.asc"}) {
        write_raster(comm, folder.path / name, comm.is_root() ? raster : Raster{});
        const Raster again = read_raster(comm, folder.path / name);
        EXPECT_EQ(again.grid.columns, 40U);
        EXPECT_EQ(again.grid.rows, 30U);
        EXPECT_EQ(again.grid.origin, raster.grid.origin);
        EXPECT_EQ(again.grid.spacing, raster.grid.spacing);
        ASSERT_EQ(again.grid.elevations.size(), raster.grid.elevations.size());
        EXPECT_TRUE(std::isnan(again.grid.elevations[77]));
        for (std::size_t k = 0; k < 1200; k += 11)
            if (k != 77) {
                EXPECT_EQ(static_cast<float>(again.grid.elevations[k]),
                          static_cast<float>(raster.grid.elevations[k]));
            }
        EXPECT_TRUE(is_same_reference(comm, again.reference, austria)) << name;
    }
}

TEST(Raster, TheContentSaysTheFormatNotTheName) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    write_raster(comm, folder.path / "hill.tif", hill());
    if (comm.is_root()) std::filesystem::rename(folder.path / "hill.tif", folder.path / "hill.asc");
    comm.all_barrier();
    EXPECT_EQ(read_raster(comm, folder.path / "hill.asc").grid.columns, 40U);
}

TEST(Raster, FaultsNameFileAndPlace) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    const auto failure = [&](const char* name, const std::string& text) {
        write_text(comm, folder.path / name, text);
        const std::string message = agreed_failure(comm, [&] { read_raster(comm, folder.path / name); });
        EXPECT_NE(message.find(name), std::string::npos) << message;
        return message.substr(std::min(message.size(), message.find(name) + std::string(name).size()));
    };
    const std::string header = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 5\n";
    EXPECT_EQ(failure("a.asc", header + "1 2\n3 x\n"), ": line 7: 'x' in column 2, row 2 is not a number");
    EXPECT_EQ(failure("b.asc", ""), ": its header must have ncols, a whole number of at least 2");
    EXPECT_EQ(failure("c.tif", std::string("II*\0 not the rest of a TIFF", 27)).substr(0, 16),
              ": cannot be read");
    write_text(comm, folder.path / "d.prj", degrees);
    EXPECT_EQ(failure("d.asc", header + "1 2\n3 4\n"),
              ": its coordinates are degrees; project them to metres");
    EXPECT_NE(agreed_failure(comm, [&] { read_raster(comm, folder.path / "none.tif"); })
                  .find("none.tif: cannot be opened"),
              std::string::npos);
}

TEST(Raster, ReferencesAreComparedByWhatTheyMean) {
    const Communicator comm(MPI_COMM_WORLD);
    EXPECT_TRUE(is_same_reference(comm, austria, austria_of_esri));
    EXPECT_FALSE(is_same_reference(comm, austria, with_meridian(austria, "13.3333333333333")));
    EXPECT_FALSE(
        is_same_reference(comm, austria_of_esri, with_meridian(austria_of_esri, "13.3333333333333")));
    EXPECT_TRUE(is_same_reference(comm, austria, ""));
    EXPECT_NE(agreed_failure(comm, [&] { is_same_reference(comm, austria, "nonsense"); })
                  .find("cannot be understood"),
              std::string::npos);
}

TEST(Areas, AreReadWithHolesAndAttributes) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    Polygon polygon;
    polygon.rings = {{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{4, 4}, {4, 6}, {6, 6}, {6, 4}}};
    if (comm.is_root()) testing::write_shapefile(folder.path / "release.shp", polygon, 1.25, austria_of_esri);
    comm.all_barrier();
    const Areas areas = read_areas(comm, folder.path / "release.shp");
    ASSERT_EQ(areas.polygons.size(), 1U);
    EXPECT_EQ(areas.polygons[0].numbers.at("d0"), 1.25);
    EXPECT_DOUBLE_EQ(areas.polygons[0].area(), 96);
    EXPECT_TRUE(areas.polygons[0].contains(2, 5));
    EXPECT_FALSE(areas.polygons[0].contains(5, 5));
    EXPECT_TRUE(is_same_reference(comm, areas.reference, austria));
    EXPECT_NE(agreed_failure(comm, [&] { read_areas(comm, folder.path / "none.shp"); })
                  .find("none.shp: cannot be read"),
              std::string::npos);
}

/// The data of a real avalanche, if they are there: two formats, two ways to word the same reference.
TEST(Raster, RealTerrainAndRelease) {
    const char* const data = std::getenv("TALUS_DATA");
    if (!data || !std::filesystem::exists(std::filesystem::path(data) / "avaKot"))
        GTEST_SKIP() << "needs the folders avaKot and avaAlr in TALUS_DATA";
    const Communicator comm(MPI_COMM_WORLD);
    const std::filesystem::path folder(data);
    const Raster kot = read_raster(comm, folder / "avaKot/avaKot.asc");
    EXPECT_EQ(kot.grid.columns, 439U);
    EXPECT_EQ(kot.grid.rows, 517U);
    EXPECT_NEAR(kot.grid.origin[0], 176973.437998359208 + 4.997688906601 / 2, 1e-9);
    const Raster alr = read_raster(comm, folder / "avaAlr/avaAlr.tif");
    const Areas release = read_areas(comm, folder / "avaAlr/REL/relAlr.shp");
    EXPECT_TRUE(is_same_reference(comm, alr.reference, release.reference));
    const Terrain terrain(alr.grid);
    for (const Polygon& polygon : release.polygons)
        for (const auto& corner : polygon.rings[0]) EXPECT_TRUE(terrain.contains(corner[0], corner[1]));
}

}  // namespace
}  // namespace talus
