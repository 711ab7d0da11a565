#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "io/geodata/module.hpp"

namespace talus {

namespace {

constexpr float nothing = -9999;

/// Only the formats that are used; messages go into exceptions, not to the terminal.
void prepare() {
    static const bool is_ready = [] {
        GDALRegister_GTiff();
        RegisterOGRShape();
        CPLSetErrorHandler(CPLQuietErrorHandler);
        return true;
    }();
    static_cast<void>(is_ready);
    CPLErrorReset();
}

[[noreturn]] void fail(const std::string& what) {
    const std::string why = CPLGetLastErrorMsg();
    throw std::runtime_error(why.empty() ? what : fmt::format("{} ({})", what, why));
}

std::string well_known_text(const OGRSpatialReference* reference) {
    if (!reference) return "";
    char* text = nullptr;
    const OGRErr failure = reference->exportToWkt(&text);
    const std::string copy = text && failure == OGRERR_NONE ? text : "";
    CPLFree(text);
    return copy;
}

/// ESRI's own wording of references, as in .prj files, is understood too.
OGRSpatialReference reference_of(const std::string& text) {
    OGRSpatialReference reference;
    if (reference.importFromWkt(text.c_str()) != OGRERR_NONE)
        fail("its coordinate reference cannot be understood");
    reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return reference;
}

std::string why_not_metres(const std::string& text) {
    prepare();
    const OGRSpatialReference reference = reference_of(text);
    if (reference.IsGeographic()) return "its coordinates are degrees; project them to metres";
    const char* unit = nullptr;
    if (const double metres = reference.GetLinearUnits(&unit); metres != 1)
        return fmt::format("its coordinates are in units of {} m ({}); project them to metres", metres, unit);
    return "";
}

Raster read_geotiff(const std::string& file) {
    prepare();
    const std::unique_ptr<GDALDataset> dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
    if (!dataset) fail("cannot be read");
    if (dataset->GetRasterCount() != 1)
        throw std::runtime_error(fmt::format("has {} bands, not one", dataset->GetRasterCount()));
    double place[6];
    if (dataset->GetGeoTransform(place) != CE_None) throw std::runtime_error("does not say where it lies");
    if (place[2] != 0 || place[4] != 0 || !(place[1] > 0) || !(place[5] < 0))
        throw std::runtime_error("is turned or mirrored: columns must go east, rows south");

    Raster raster;
    raster.reference = well_known_text(dataset->GetSpatialRef());
    TerrainGrid& grid = raster.grid;
    const int columns = dataset->GetRasterXSize(), rows = dataset->GetRasterYSize();
    if (columns < 2 || rows < 2)
        throw std::runtime_error(fmt::format("has {} x {} cells; at least 2 x 2 are needed", columns, rows));
    grid.columns = static_cast<std::size_t>(columns);
    grid.rows = static_cast<std::size_t>(rows);
    grid.spacing = {place[1], -place[5]};
    grid.origin = {place[0] + place[1] / 2, place[3] + place[5] * (rows - 0.5)};
    grid.elevations.resize(grid.columns * grid.rows);
    GDALRasterBand* const band = dataset->GetRasterBand(1);
    int has_nodata = 0;
    const double nodata = band->GetNoDataValue(&has_nodata);
    const double scale = band->GetScale(), offset = band->GetOffset();
    for (int row = 0; row < rows; ++row) {
        double* const values =
            grid.elevations.data() + (grid.rows - 1 - static_cast<std::size_t>(row)) * grid.columns;
        if (band->RasterIO(GF_Read, 0, row, columns, 1, values, columns, 1, GDT_Float64, 0, 0) != CE_None)
            fail(fmt::format("row {} cannot be read", row + 1));
        for (int column = 0; column < columns; ++column) {
            double& value = values[column];
            if ((has_nodata && value == nodata) || std::isnan(value))
                value = std::numeric_limits<double>::quiet_NaN();
            else
                value = value * scale + offset;
            if (std::isinf(value))
                throw std::runtime_error(
                    fmt::format("the value in column {}, row {} is infinite", column + 1, row + 1));
        }
    }
    return raster;
}

std::string geotiff(const Raster& raster) {
    prepare();
    const TerrainGrid& grid = raster.grid;
    constexpr const char* in_memory = "/vsimem/talus.tif";
    {
        CPLStringList options;
        options.SetNameValue("COMPRESS", "DEFLATE");
        options.SetNameValue("PREDICTOR", "3");
        const auto columns = static_cast<int>(grid.columns), rows = static_cast<int>(grid.rows);
        const std::unique_ptr<GDALDataset> dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
            in_memory, columns, rows, 1, GDT_Float32, options.List()));
        if (!dataset) fail("cannot be written");
        double place[6]{grid.origin[0] - grid.spacing[0] / 2,
                        grid.spacing[0],
                        0,
                        grid.origin[1] + grid.spacing[1] * (rows - 0.5),
                        0,
                        -grid.spacing[1]};
        dataset->SetGeoTransform(place);
        if (!raster.reference.empty()) {
            const OGRSpatialReference reference = reference_of(raster.reference);
            dataset->SetSpatialRef(&reference);
        }
        GDALRasterBand* const band = dataset->GetRasterBand(1);
        band->SetNoDataValue(nothing);
        std::vector<float> values(grid.columns);
        for (int row = 0; row < rows; ++row) {
            for (std::size_t column = 0; column < grid.columns; ++column) {
                const double value = grid.at(column, grid.rows - 1 - static_cast<std::size_t>(row));
                values[column] = std::isfinite(value) ? static_cast<float>(value) : nothing;
            }
            if (band->RasterIO(GF_Write, 0, row, columns, 1, values.data(), columns, 1, GDT_Float32, 0, 0) !=
                CE_None)
                fail("cannot be written");
        }
    }
    vsi_l_offset length = 0;
    GByte* const bytes = VSIGetMemFileBuffer(in_memory, &length, TRUE);
    if (!bytes) fail("cannot be written");
    std::string copy(reinterpret_cast<const char*>(bytes), length);
    CPLFree(bytes);
    return copy;
}

void add_rings(const OGRPolygon& polygon, Polygon& area) {
    for (const OGRLinearRing* ring : polygon) {
        Polygon::Ring corners;
        for (int k = 0; k < ring->getNumPoints(); ++k) corners.push_back({ring->getX(k), ring->getY(k)});
        if (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
        if (corners.size() >= 3) area.rings.push_back(std::move(corners));
    }
}

Areas read_areas(const std::string& file) {
    prepare();
    const std::unique_ptr<GDALDataset> dataset(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR));
    if (!dataset) fail("cannot be read as a shapefile");
    if (dataset->GetLayerCount() != 1)
        throw std::runtime_error(fmt::format("has {} layers, not one", dataset->GetLayerCount()));
    OGRLayer* const layer = dataset->GetLayer(0);
    Areas areas;
    areas.reference = well_known_text(layer->GetSpatialRef());
    for (const OGRFeatureUniquePtr& feature : *layer) {
        Polygon area;
        const OGRGeometry* const geometry = feature->GetGeometryRef();
        const auto kind = geometry ? wkbFlatten(geometry->getGeometryType()) : wkbNone;
        if (kind == wkbPolygon) {
            add_rings(*geometry->toPolygon(), area);
        } else if (kind == wkbMultiPolygon) {
            for (const OGRPolygon* part : *geometry->toMultiPolygon()) add_rings(*part, area);
        }
        if (area.rings.empty())
            throw std::runtime_error(fmt::format("feature {} is not a polygon", feature->GetFID() + 1));
        for (int k = 0; k < feature->GetFieldCount(); ++k) {
            if (!feature->IsFieldSetAndNotNull(k)) continue;
            const OGRFieldDefn& attribute = *feature->GetFieldDefnRef(k);
            const std::string name = attribute.GetNameRef();
            const OGRFieldType type = attribute.GetType();
            if (type == OFTReal || type == OFTInteger || type == OFTInteger64)
                area.numbers[name] = feature->GetFieldAsDouble(k);
            else
                area.texts[name] = feature->GetFieldAsString(k);
        }
        areas.polygons.push_back(std::move(area));
    }
    if (areas.polygons.empty()) throw std::runtime_error("has no polygons");
    return areas;
}

/// By their definition or, where files word it differently, by the code of the registry both are found under.
bool is_same_reference(const std::string& one, const std::string& other) {
    prepare();
    OGRSpatialReference first = reference_of(one), second = reference_of(other);
    if (first.IsSame(&second)) return true;
    const auto code = [](OGRSpatialReference& reference) -> std::string {
        if (reference.AutoIdentifyEPSG() != OGRERR_NONE) {
            int count = 0;
            int* confidence = nullptr;
            OGRSpatialReferenceH* const matches = reference.FindMatches(nullptr, &count, &confidence);
            std::string found;
            if (count > 0 && confidence[0] >= 70)
                if (const char* const match = OSRGetAuthorityCode(matches[0], nullptr)) found = match;
            OSRFreeSRSArray(matches);
            CPLFree(confidence);
            return found;
        }
        const char* const identified = reference.GetAuthorityCode(nullptr);
        return identified ? identified : "";
    };
    const std::string first_code = code(first);
    return !first_code.empty() && first_code == code(second);
}

}  // namespace

const GeodataModule talus_geodata_module{read_geotiff, geotiff, read_areas, is_same_reference,
                                         why_not_metres};

}  // namespace talus
