#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "domain/box.hpp"
#include "physics/dem/contact_record.hpp"
#include "physics/dem/law_table.hpp"
#include "physics/dem/walls/wall.hpp"
#include "physics/rigid/body.hpp"

namespace talus::rigid {

/// Force and torque about the centre of mass on a body.
struct Load {
    Vector3<> force, torque;  ///< [N], [N m]
};

/// Contacts of bodies with each other and with walls, by the laws of grains: their contact spheres touch as
/// grains with the mass of the body (R. B. Canelas, A. J. C. Crespo, J. M. Dominguez, R. M. L. Ferreira, M.
/// Gomez-Gesteira, Comput. Phys. Commun. 202 (2016) 131), of which each of N contacts of the same two bodies
/// at one time bears the N-th part, so that flat faces that meet are damped as one contact of N springs. Few
/// bodies, known on every rank: each finds all contacts, with the same bits.
class Contacts {
  public:
    Contacts(std::span<const Body> bodies, const dem::AnyLawTable& laws, std::span<const dem::Wall> walls,
             const Box& box)
        : bodies_(bodies), laws_(laws), walls_(walls), box_(box) {}

    /// Finds what may touch while nothing comes nearer by more than `reach` [m].
    void list(std::span<const State> states, double time, double reach);
    bool any_near() const { return !groups_.empty(); }
    /// Greatest angular frequency of a body in its listed contacts, all of them closed, is not greater [1/s].
    double greatest_frequency() const;

    /// Loads on all bodies; what contacts remember advances by `time_step` [s], 0: it is read only.
    std::vector<Load> loads(std::span<const State> states, double time, double time_step);

    /// Greatest overlap over the smaller radius of the two, and whose it is.
    struct Overlap {
        double share = 0;
        std::size_t body = 0;
        std::string with;
    };
    Overlap greatest_overlap(std::span<const State> states, double time) const;

    std::vector<dem::ContactRecord>& records() { return records_; }
    const std::vector<dem::ContactRecord>& records() const { return records_; }

  private:
    /// Two bodies, or a body and a wall, and which of their spheres may touch.
    struct Group {
        std::uint32_t body, other;  ///< `other`: a body, or a wall
        bool at_wall;
        Vector3<> image;                                    ///< added to the centre of the second body
        std::vector<std::array<std::uint32_t, 2>> spheres;  ///< of the first, of the second
    };
    struct Touch;

    void list_pair(std::span<const State> states, std::uint32_t a, std::uint32_t b, double reach);
    void list_wall(const State& state, std::uint32_t body, std::uint32_t wall, const dem::WallPose& pose,
                   double reach);
    std::vector<dem::WallPose> poses_at(double time) const;
    template <class Table>
    std::vector<Touch> find_touches(const Table& table, const Group& group, std::span<const State> states,
                                    std::span<const dem::WallPose> poses) const;

    std::span<const Body> bodies_;
    const dem::AnyLawTable& laws_;
    std::span<const dem::Wall> walls_;
    const Box& box_;
    std::vector<Group> groups_;
    std::vector<dem::ContactRecord> records_;
};

}  // namespace talus::rigid
