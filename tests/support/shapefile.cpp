#include "shapefile.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <fstream>

namespace talus::testing {
namespace {

struct Bytes {
    std::string text;

    template <class T>
    void little(T value) {
        text.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void big(std::int32_t value) {
        for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(value >> shift);
    }
    std::int32_t words() const { return static_cast<std::int32_t>(text.size() / 2); }
};

void box(Bytes& bytes, const Polygon& polygon) {
    for (const auto& corner : {polygon.lower(), polygon.upper()})
        for (const double coordinate : corner) bytes.little(coordinate);
}

constexpr std::int32_t polygon_type = 5, header_words = 50;

std::string with_header(const Bytes& records, const Polygon& polygon) {
    Bytes file;
    file.big(9994);
    for (int unused = 0; unused < 5; ++unused) file.big(0);
    file.big(header_words + records.words());
    file.little(std::int32_t{1000});
    file.little(polygon_type);
    box(file, polygon);
    for (int unused = 0; unused < 4; ++unused) file.little(0.0);
    return file.text + records.text;
}

void write(std::filesystem::path file, const char* suffix, const std::string& text) {
    std::ofstream(file.replace_extension(suffix), std::ios::binary) << text;
}

}  // namespace

void write_shapefile(const std::filesystem::path& file, const Polygon& polygon, double d0,
                     const std::string& reference) {
    Bytes content;
    std::int32_t points = 0;
    for (const Polygon::Ring& ring : polygon.rings) points += static_cast<std::int32_t>(ring.size() + 1);
    content.little(polygon_type);
    box(content, polygon);
    content.little(static_cast<std::int32_t>(polygon.rings.size()));
    content.little(points);
    std::int32_t start = 0;
    for (const Polygon::Ring& ring : polygon.rings) {
        content.little(start);
        start += static_cast<std::int32_t>(ring.size() + 1);
    }
    for (const Polygon::Ring& ring : polygon.rings)  // clockwise, closed
        for (std::size_t k = 0; k <= ring.size(); ++k)
            for (const double coordinate : ring[(ring.size() - k) % ring.size()]) content.little(coordinate);

    Bytes record, index;
    record.big(1);
    record.big(content.words());
    record.text += content.text;
    index.big(header_words);
    index.big(content.words());
    write(file, ".shp", with_header(record, polygon));
    write(file, ".shx", with_header(index, polygon));

    constexpr std::uint8_t width = 20;
    Bytes table;
    table.text = {3, 95, 7, 26};
    table.little(std::uint32_t{1});
    table.little(std::uint16_t{32 + 32 + 1});
    table.little(std::uint16_t{1 + width});
    table.text.append(20, '\0');
    table.text += "d0";
    table.text.append(9, '\0');
    table.text += 'N';
    table.text.append(4, '\0');
    table.little(width);
    table.little(std::uint8_t{6});
    table.text.append(14, '\0');
    table.text += fmt::format("\r {:{}.6f}\x1a", d0, int{width});
    write(file, ".dbf", table.text);
    if (!reference.empty()) write(file, ".prj", reference);
}

}  // namespace talus::testing
