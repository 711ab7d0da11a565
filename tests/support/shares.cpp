#include "tests/support/shares.hpp"

#include <algorithm>
#include <random>

namespace talus::test {

ParticleSet share_of(const std::vector<Grain>& grains, int dimension, int rank, int ranks, unsigned salt) {
    ParticleSet set("rubble", dimension);
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{&field::velocity, &field::mass,
                                                                         &field::body, &field::damage})
        set.add(*info);
    std::mt19937 random(salt);
    std::vector<std::size_t> mine;
    for (std::size_t k = 0; k < grains.size(); ++k)
        if (static_cast<int>(random() % static_cast<unsigned>(ranks)) == rank) mine.push_back(k);
    std::shuffle(mine.begin(), mine.end(), random);
    set.resize(mine.size());
    for (std::size_t i = 0; i < mine.size(); ++i) {
        const Grain& grain = grains[mine[i]];
        set.data(field::id)[i] = grain.id;
        set.data(field::mass)[i] = grain.mass;
        set.data(field::damage)[i] = grain.damage;
        set.data(field::body)[i] = grain.body;
        for (int a = 0; a < dimension; ++a) {
            set.data(field::position, a)[i] = grain.position[static_cast<std::size_t>(a)];
            set.data(field::velocity, a)[i] = grain.velocity[static_cast<std::size_t>(a)];
        }
    }
    return set;
}

}  // namespace talus::test
