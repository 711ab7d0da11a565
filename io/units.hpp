#pragma once
#include <stdexcept>
#include <string>
#include <string_view>

namespace talus {

/// A number with a unit that cannot be understood, or of another dimension than expected.
class UnitError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The number in `text` ("3.2 km/s", "30 deg", "2.7 g/cm^3") converted to `si_unit`, a UDUNITS string
/// ("m s-1", "rad", "kg m-3", "1"). A text without unit is accepted only where si_unit is "1". Radians are
/// pure numbers to UDUNITS: "30 deg" is accepted where "1" is expected, and gives 0.52.
/// Throws UnitError saying what was found and which dimension was expected.
double convert_to_si(std::string_view text, std::string_view si_unit);

/// What `si_unit` measures, in words: "length" for "m"; empty if it has no name here.
std::string dimension_name(std::string_view si_unit);

}  // namespace talus
