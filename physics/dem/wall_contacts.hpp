#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "domain/particles.hpp"
#include "physics/dem/contact_list.hpp"
#include "physics/dem/contact_loads.hpp"
#include "physics/dem/contact_pass.hpp"
#include "physics/dem/contact_record.hpp"
#include "physics/dem/walls/wall.hpp"

namespace talus::dem {

/// A grain at a wall; a grain may touch a wall in several places, each a contact of its own.
struct WallTouch {
    std::uint32_t grain, wall, place;
    double overlap;              ///< [m]
    Vector3<> point{};           ///< where they touch [m]
    ContactLoad<double> load{};  ///< on the grain
    std::array<double, most_history> history{};
};

/// The contacts of this rank's grains with walls, and what they remember.
class WallContacts {
  public:
    /// Lists the grains with a gap below the rule's margin to a wall where it is; nothing touches yet.
    void list(const ParticleSet& grains, std::span<const Wall> walls, std::span<const WallPose> poses,
              const PairRule& rule);
    /// Gives the list the memory of `records`, as of the last evaluation.
    void restore(std::span<const ContactRecord> records, const ParticleSet& grains);
    /// The records of all contacts, appended.
    void append_records(const ParticleSet& grains, std::vector<ContactRecord>& records) const;

    /// Adds the forces of all contacts; `poses` of the time of evaluation.
    Overload evaluate(const Evaluation& evaluation, const AnyLawTable& laws, std::span<const Wall> walls,
                      std::span<const WallPose> poses);

    /// The walls' greatest displacement since list(), wherever a grain may be, is not greater than this once
    /// they are at `poses` [m].
    double displacement(std::span<const WallPose> poses) const;

    /// Appends all contacts as they are, walls at `poses`.
    void append_loads(const GrainRows& rows, const AnyLawTable& laws, std::span<const Wall> walls,
                      std::span<const WallPose> poses, std::vector<LoadedContact>& contacts) const;

    /// Contacts of the last evaluation.
    std::span<const WallTouch> touches() const { return touches_; }
    std::size_t bytes() const {
        return near_.capacity() * sizeof(Near) +
               (touches_.capacity() + before_.capacity()) * sizeof(WallTouch);
    }

  private:
    struct Near {
        std::uint32_t grain, wall, law;
        std::uint32_t begin = 0, end = 0;  ///< among touches_
    };
    std::vector<Near> near_;
    std::vector<WallTouch> touches_, before_;
    std::vector<WallPose> listed_poses_;
    std::vector<double>
        farthest_;  ///< grain from the centre of each wall's rotation, with its surroundings [m]
};

}  // namespace talus::dem
