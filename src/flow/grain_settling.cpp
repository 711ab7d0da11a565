#include "src/flow/grain_settling.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "comm/exact_sum.hpp"
#include "domain/clump_fields.hpp"
#include "domain/grain_fields.hpp"

namespace talus {

double force_imbalance(const Communicator& comm, const ParticleSet& grains,
                       std::span<const std::uint8_t> held, const dem::ClumpMotion& clumps,
                       std::span<const dem::LoadedContact> contacts) {
    std::array<ExactSum, 2> squares;  // of net forces, of forces of contacts
    std::array<std::uint64_t, 2> counts{};
    const double* mass = grains.data(field::mass);
    const std::uint8_t* body = grains.data(field::body);
    for (std::size_t i = 0; i < grains.size(); ++i) {
        if (held[body[i]] || !clumps.counts(body[i], grains.data(field::id)[i])) continue;
        const Field<double>& rate = clumps.of_body(body[i]) ? field::clump_acceleration : field::acceleration;
        double acceleration2 = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double a = grains.data(rate, axis)[i];
            acceleration2 += a * a;
        }
        squares[0].add(mass[i] * mass[i] * acceleration2);
        ++counts[0];
    }
    for (const dem::LoadedContact& contact : contacts) {
        if (contact.first >= grains.size()) continue;  // another rank's
        squares[1].add(dot(contact.load.force, contact.load.force));
        ++counts[1];
    }
    ExactSum::all_reduce(comm, squares);
    comm.all_sum(std::span<std::uint64_t>(counts));
    const double net = squares[0].value(), contact = squares[1].value();
    if (!(contact > 0)) return std::numeric_limits<double>::infinity();
    return std::sqrt(net / static_cast<double>(counts[0]) / (contact / static_cast<double>(counts[1])));
}

}  // namespace talus
