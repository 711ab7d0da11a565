#pragma once
#include <array>
#include <map>
#include <string>
#include <vector>

namespace talus {

/// An area of the map: closed rings of corners [m], the last joined to the first. A place is inside if a ray
/// from it crosses an odd number of edges, so that a ring within another is a hole.
struct Polygon {
    using Ring = std::vector<std::array<double, 2>>;
    std::vector<Ring> rings;
    std::map<std::string, double> numbers;     ///< attributes of the file
    std::map<std::string, std::string> texts;  ///< attributes of the file

    bool contains(double x, double y) const;
    double area() const;  ///< [m2]; rings within others are taken off
    /// Corners of the smallest rectangle around it.
    std::array<double, 2> lower() const, upper() const;
};

}  // namespace talus
