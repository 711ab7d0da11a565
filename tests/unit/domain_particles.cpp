#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <set>
#include <stdexcept>

#include "domain/particles.hpp"

namespace talus {
namespace {

ParticleSet numbered(std::size_t count) {
    ParticleSet particles("set", 2);
    particles.add(field::velocity);
    particles.add(field::body);
    particles.add(field::flaw_count);
    particles.add(field::pressure);
    particles.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        particles.data(field::id)[i] = 100 + i;
        particles.data(field::velocity, 1)[i] = 0.5 * static_cast<double>(i);
        particles.data(field::body)[i] = static_cast<std::uint8_t>(i);
        particles.data(field::flaw_count)[i] = static_cast<std::uint32_t>(7 * i);
    }
    return particles;
}

TEST(ParticleSet, HasIdAndPositionFromTheStart) {
    const ParticleSet particles("set", 3);
    EXPECT_TRUE(particles.has(field::id));
    EXPECT_TRUE(particles.has(field::position));
    EXPECT_FALSE(particles.has(field::velocity));
    EXPECT_EQ(particles.size_with_halo(), 0u);
    EXPECT_EQ(particles.column(field::position).components.size(), 3u);
    EXPECT_THROW(particles.column(field::velocity), std::logic_error);
}

TEST(ParticleSet, AddedFieldsAreZeroAndAddedOnce) {
    ParticleSet particles = numbered(4);
    const std::size_t columns = particles.columns().size(), bytes = particles.bytes_per_particle();
    particles.add(field::velocity);
    EXPECT_EQ(particles.columns().size(), columns);
    EXPECT_EQ(particles.data(field::velocity, 1)[3], 1.5) << "adding again must not clear";
    particles.set_halo_size(3);
    particles.add(field::mass);     // known for copies
    particles.add(field::density);  // not
    EXPECT_EQ(particles.column(field::mass).components[0].size(), 7 * sizeof(double));
    EXPECT_EQ(particles.column(field::density).components[0].size(), 4 * sizeof(double));
    for (const double value : particles.own(field::mass)) EXPECT_EQ(value, 0);
    EXPECT_EQ(particles.bytes_per_particle(), bytes + 16);
}

TEST(ParticleSet, ComponentsFollowShapeAndDimension) {
    for (int dimension = 1; dimension <= 3; ++dimension) {
        ParticleSet particles("set", dimension);
        particles.add(field::deviatoric_stress);
        particles.add(field::velocity_gradient);
        const auto d = static_cast<std::size_t>(dimension);
        EXPECT_EQ(particles.column(field::deviatoric_stress).components.size(), d * (d + 1) / 2);
        EXPECT_EQ(particles.column(field::velocity_gradient).components.size(), d * d);
    }
}

TEST(ParticleSet, ResizeKeepsValuesAndZeroesNewOnes) {
    ParticleSet particles = numbered(3);
    particles.set_halo_size(2);
    particles.resize(5);
    EXPECT_EQ(particles.size(), 5u);
    EXPECT_EQ(particles.halo_size(), 0u);
    EXPECT_EQ(particles.data(field::id)[2], 102u);
    EXPECT_EQ(particles.data(field::body)[2], 2);
    EXPECT_EQ(particles.data(field::id)[4], 0u);
    particles.resize(0);
    particles.resize(2);
    EXPECT_EQ(particles.data(field::id)[1], 0u);
}

TEST(ParticleSet, HaloColumnsAloneGrowWithTheHalo) {
    ParticleSet particles = numbered(3);
    particles.set_halo_size(4);
    EXPECT_EQ(particles.size_with_halo(), 7u);
    for (const Column& column : particles.columns())
        for (const auto& component : column.components)
            EXPECT_EQ(component.size(), column.value_size() * (column.info->reach == Reach::halo ? 7 : 3))
                << column.info->name;
    EXPECT_EQ(particles.own(field::id).size(), 3u);
    EXPECT_EQ(particles.data(field::id)[2], 102u);
    particles.set_halo_size(0);
    EXPECT_EQ(particles.size_with_halo(), 3u);
}

TEST(ParticleSet, ReorderMovesEveryStateColumnAndDropsTheHalo) {
    ParticleSet particles = numbered(5);
    particles.set_halo_size(2);
    const std::uint32_t order[] = {4, 0, 2};
    particles.reorder(order);
    ASSERT_EQ(particles.size(), 3u);
    EXPECT_EQ(particles.halo_size(), 0u);
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(particles.data(field::id)[k], 100 + order[k]);
        EXPECT_EQ(particles.data(field::velocity, 0)[k], 0);
        EXPECT_EQ(particles.data(field::velocity, 1)[k], 0.5 * order[k]);
        EXPECT_EQ(particles.data(field::body)[k], order[k]);
        EXPECT_EQ(particles.data(field::flaw_count)[k], 7 * order[k]);
    }
    for (const Column& column : particles.columns())
        for (const auto& component : column.components)
            EXPECT_EQ(component.size(), 3 * column.value_size()) << column.info->name;
    const std::uint32_t again[] = {0, 0, 1, 2, 2};  // may also repeat
    particles.reorder(again);
    ASSERT_EQ(particles.size(), 5u);
    EXPECT_EQ(particles.data(field::id)[4], 102u);
}

TEST(ParticleSet, LargeColumnsBeginAtDifferentPlacesOfTheirPages) {
    ParticleSet particles = numbered(100000);
    std::set<std::uintptr_t> places;
    for (const Column& column : particles.columns())
        for (const auto& component : column.components) {
            const auto address = reinterpret_cast<std::uintptr_t>(component.data());
            EXPECT_EQ(address % 64, 0u) << column.info->name;
            places.insert(address % 4096);
        }
    EXPECT_GT(places.size(), 4u);  // of 8
}

}  // namespace
}  // namespace talus
