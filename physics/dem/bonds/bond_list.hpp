#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "domain/particles.hpp"
#include "physics/dem/bonds/beam_bond.hpp"
#include "physics/dem/contact_list.hpp"
#include "physics/dem/contact_pass.hpp"
#include "physics/dem/contact_record.hpp"

namespace talus::dem {

/// Which grains are joined at the start, and how.
struct BondRule {
    std::array<std::uint8_t, 2> bodies;  ///< of the two grains, in order; may be the same
    double gap;                          ///< greatest at the start, over the smaller radius [1]
    double radius_factor;                ///< radius of the section over the smaller radius [1]
    BondMaterial material;
};

/// A bond that is longer than this times its length at rest stops the run: ranks would lose its other end.
inline constexpr double most_stretched = 1.1;

/// Greatest gap between the grains of a bond, of grains up to a radius [m].
double greatest_bond_reach(std::span<const BondRule> rules, double largest_radius);

/// Greatest force of a bond of a grain [N] that ForceSum must hold: strained by 1.
double greatest_bond_force(std::span<const BondRule> rules, double radius);

/// What an evaluation of bonds found.
struct BondFault {
    enum Kind : std::uint8_t { none, overload, stretched } kind = none;
    std::uint64_t first = 0, second = 0;  ///< ids
};

/// The bonds of this rank's grains: those across ranks are kept and computed by both, with the same bits. A
/// pair that is bonded has no contact: the beam bears what presses, shears and turns its ends. A bond beyond
/// its strength acts for the last time in the evaluation that finds it so; then the pair may touch as any
/// other.
class BondList {
  public:
    explicit BondList(std::vector<BondRule> rules) : rules_(std::move(rules)) {}

    bool in_use() const { return !rules_.empty(); }
    /// Joins pairs of a list that holds all with a gap up to that of the rules. For a new run.
    void join(const ParticleSet& grains, const ContactList& near);
    /// Takes the bonds of records in place of what there is; list() must follow.
    void adopt(const std::vector<BondRecord>& records);
    /// Finds both ends of the bonds among own grains and copies, where they are nearest to each other; drops
    /// those without an end among the own. Returns the ids of a bond whose other end is not known, if any.
    std::optional<std::array<std::uint64_t, 2>> list(const ParticleSet& grains);
    /// Which pairs, as stored, are bonded and thus have no contact; empty without bonds.
    std::function<bool(std::uint32_t, std::uint32_t)> pairs() const;
    /// Marks the copies that bonds end at, the first of them being `own`.
    void mark_copies(std::size_t own, std::span<std::uint8_t> copies) const;

    /// Adds forces and torques to the own ends; counts bonds that break in field::broken_bonds of them.
    BondFault evaluate(const Evaluation& evaluation, ParticleSet& grains);
    /// Whether any has broken in the last evaluation.
    bool broken() const { return broken_ > 0; }

    /// All that have not broken.
    std::vector<BondRecord> records() const;
    /// Those whose first grain is stored below `end`: each once over all ranks.
    std::vector<BondRecord> records_below(std::size_t end) const;
    std::uint64_t count_below(std::size_t end) const;
    /// Greatest stable step of the own grains under their bonds [s], infinite without any.
    double stable_step(const ParticleSet& grains) const;
    std::size_t bytes() const { return bonds_.capacity() * sizeof(Bond); }

    /// What a checkpoint holds of a bond.
    static std::vector<const FieldInfo*> fields();

  private:
    struct Bond {
        BondRecord record;
        BeamBond beam;
        std::uint32_t first = 0, second = 0;  ///< grains as stored
        bool broken = false;
    };
    const BondRule* rule_of(std::uint8_t a, std::uint8_t b, std::size_t& index) const;
    Bond bond_of(const BondRecord& record) const;

    std::vector<BondRule> rules_;
    std::vector<Bond> bonds_;
    std::size_t broken_ = 0;
};

}  // namespace talus::dem
