#include <algorithm>

#include "domain/coupling_fields.hpp"
#include "domain/grain_fields.hpp"
#include "physics/dem/vectors.hpp"
#include "src/grain_simulation.hpp"

namespace talus {

/// Accelerations become fields, which travel with their grains and can be saved.
void GrainSimulation::show_accelerations() {
    if (grains_.has(field::acceleration)) return;
    grains_.add(field::acceleration);
    grains_.add(field::angular_acceleration);
    auto& columns = grains_.columns();  // in the order of add_fields()
    const auto behind = std::ranges::find(columns, &field::radius, &Column::info);
    std::rotate(behind, columns.end() - 2, columns.end());
    dem::put_accelerations(sums_, grains_);
}

/// The reverse: most steps need no second place for them.
void GrainSimulation::hide_accelerations() {
    if (!grains_.has(field::acceleration)) return;
    sums_.resize(grains_.size() + 1);
    dem::put_rates(grains_, sums_);
    std::erase_if(grains_.columns(), [](const Column& column) {
        return column.info == &field::acceleration || column.info == &field::angular_acceleration;
    });
}

void GrainSimulation::set_fluid_accelerations(std::span<const dem::Vector3<>> accelerations) {
    const std::uint8_t* body = grains_.data(field::body);
    const dem::Vectors all(grains_, field::acceleration),
        of_fluid(grains_, coupling_field::fluid_acceleration), velocity(grains_, field::velocity),
        earlier(grains_, coupling_field::earlier_velocity);
    for (std::size_t i = 0; i < grains_.size(); ++i) {
        if (!setup_.held[body[i]]) all.put(i, all[i] + (accelerations[i] - of_fluid[i]));
        of_fluid.put(i, accelerations[i]);
        earlier.put(i, velocity[i]);
    }
}

void GrainSimulation::set_spins(std::span<const dem::Vector3<>> spins) {
    const std::uint8_t* body = grains_.data(field::body);
    const dem::Vectors spin(grains_, field::angular_velocity);
    for (std::size_t i = 0; i < grains_.size(); ++i)
        if (!setup_.held[body[i]]) spin.put(i, spins[i]);
}

void GrainSimulation::remember_slips(std::span<const dem::Vector3<>> slips,
                                     const coupling::HistoryKernel::Passage& passage) {
    namespace of = coupling_field;
    const dem::Vectors earlier(grains_, of::earlier_slip);
    std::vector<dem::Vector3<>> changes(slips.size());
    for (std::size_t i = 0; i < slips.size(); ++i) {
        changes[i] = slips[i] - earlier[i];
        earlier.put(i, slips[i]);
    }
    int component = 0;
    for (const auto& [kept, taken, felt] : passage.memories)
        for (const auto axis : {&dem::Vector3<>::x, &dem::Vector3<>::y, &dem::Vector3<>::z}) {
            double* memory = grains_.data(of::slip_memories, component++);
            for (std::size_t i = 0; i < slips.size(); ++i)
                memory[i] = kept * memory[i] + taken * changes[i].*axis;
        }
}

}  // namespace talus
