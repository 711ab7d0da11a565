#pragma once
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <random>
#include <string>

#include "comm/communicator.hpp"
#include "domain/particles.hpp"
#include "domain/pore_pressure_field.hpp"
#include "io/run_state.hpp"

namespace talus::testing {

/// Fields of every type and shape.
inline void add_fields(ParticleSet& set) {
    for (const FieldInfo* info :
         {static_cast<const FieldInfo*>(&field::velocity), static_cast<const FieldInfo*>(&field::mass),
          static_cast<const FieldInfo*>(&field::density),
          static_cast<const FieldInfo*>(&field::deviatoric_stress),
          static_cast<const FieldInfo*>(&field::body), static_cast<const FieldInfo*>(&field::flaw_threshold),
          static_cast<const FieldInfo*>(&field::flaw_count),
          static_cast<const FieldInfo*>(&field::velocity_gradient),
          static_cast<const FieldInfo*>(&field::pressure)})
        set.add(*info);
    set.add(field::excess_pore_pressure, 5);
}

/// Any bits, those of a particle depending on its id only.
inline void fill(ParticleSet& set) {
    for (std::size_t k = 0; k < set.size(); ++k) {
        const std::uint64_t id = set.own(field::id)[k];
        std::mt19937_64 random(id);
        for (Column& column : set.columns()) {
            if (column.info == &field::id) continue;
            if (column.info->role != Role::state) continue;
            for (auto& component : column.components) {
                const std::uint64_t bits = random();
                std::memcpy(component.data() + k * column.value_size(), &bits, column.value_size());
            }
        }
    }
}

/// `total` particles with gaps between ids (and one id far off), scattered unevenly in no order: rank 1 has
/// none. Another `salt` is another scattering of the same particles.
inline ParticleSet random_set(const Communicator& comm, std::uint64_t total, std::uint64_t salt,
                              int dimension = 3, const std::string& name = "rock") {
    ParticleSet set(name, dimension);
    add_fields(set);
    std::vector<std::uint64_t> mine;
    std::mt19937_64 random(salt);
    for (std::uint64_t k = 0; k < total; ++k) {
        const std::uint64_t id =
            k + 1 == total ? std::uint64_t{1} << 60 : 5 + 3 * k + (k > total / 2 ? 100000 : 0);
        auto owner = static_cast<int>(random() % static_cast<std::uint64_t>(comm.size() + 2)) % comm.size();
        if (owner == 1 && comm.size() > 2) owner = 0;
        if (owner == comm.rank()) mine.push_back(id);
    }
    std::shuffle(mine.begin(), mine.end(), random);
    set.resize(mine.size());
    std::copy(mine.begin(), mine.end(), set.own(field::id).begin());
    fill(set);
    return set;
}

inline RunState some_state(std::uint64_t step) {
    RunState state;
    state.time = 1.0 / 3;
    state.time_step = 1e-9 / 7;
    state.step = step;
    state.scene_text = "[run]\nend_time = \"2 µs\"\n";
    state.resolved_scene = "# resolved\n";
    state.version = "0.1";
    state.numbers = {{"energy at start", -0.0}, {"work", 5e-324}, {"big", 1e300}};
    state.materials = {"rock", "rock", "dust"};
    return state;
}

/// A new empty folder for all ranks; removed at the end.
class SharedFolder {
  public:
    explicit SharedFolder(const Communicator& comm) : comm_(comm) {
        std::string name;
        if (comm.is_root()) {
            name = (std::filesystem::temp_directory_path() / "talus_test_XXXXXX").string();
            if (::mkdtemp(name.data()) == nullptr) name.clear();
        }
        path = comm.all_broadcast(name);
    }
    ~SharedFolder() {
        comm_.all_barrier();
        if (comm_.is_root()) std::filesystem::remove_all(path);
    }
    SharedFolder(const SharedFolder&) = delete;
    SharedFolder& operator=(const SharedFolder&) = delete;
    std::filesystem::path path;

  private:
    const Communicator& comm_;
};

}  // namespace talus::testing
