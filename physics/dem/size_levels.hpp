#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "domain/cell_grid.hpp"
#include "domain/cell_table.hpp"
#include "domain/particles.hpp"

namespace talus::dem {

/// Spheres side by side in memory, for lanes.
struct Spheres {
    std::array<const double*, 3> x;  ///< centres [m]
    const double* radius;            ///< [m]
};

Spheres spheres_of(const ParticleSet& grains);

/// Which spheres of the runs come nearer to a place than their radius and `reach` [m], found many at once.
class NearSpheres {
  public:
    /// Valid until the next call.
    std::span<const std::uint32_t> operator()(const Spheres& spheres, std::span<const Run> runs,
                                              const std::array<double, 3>& place, double reach);

  private:
    std::vector<std::uint32_t> near_;
};

/// Grains and copies sorted by size, a factor of two a level, each level in cells of its own size. A pair is
/// found from the smaller grain, which looks into its own level and those above, so that no grain meets many
/// in vain whatever the ratio of sizes: K. Iwai, C.-W. Hong, P. Greil, Int. J. Mod. Phys. C 10 (1999) 823; V.
/// Ogarko, S. Luding, Comput. Phys. Commun. 183 (2012) 931.
class SizeLevels {
  public:
    /// `margin`: greatest gap that is found [m].
    SizeLevels(const ParticleSet& grains, double margin);

    /// Whether all grains and copies are larger than half of `largest` [m].
    static bool one_is_enough(const ParticleSet& grains, double largest);

    /// Calls visit(i, j, one_level) for grains with a gap below the margin, j of the same level as i or of
    /// one above; pairs of one level are visited from both sides, but not from copies.
    template <class Visit>
    void for_each_pair(Visit&& visit) {
        for (std::size_t l = 0; l < levels_.size(); ++l)
            for (std::size_t above = 0; above <= l; ++above) {
                std::vector<Run> runs;
                std::vector<std::size_t> hints;  // of the rows of cells last looked into
                Range before{{1}, {0}};          // no cell's
                for (const CellEntry& cell : levels_[l].cells) {
                    const Range range = reached(levels_[l], cell, levels_[above]);
                    if (range != before) find_runs(levels_[above], range, hints, runs);
                    before = range;
                    if (runs.empty()) continue;
                    for (std::uint32_t k = cell.begin; k < cell.end; ++k)
                        visit_near(levels_[l], k, levels_[above], runs, above == l, visit);
                }
            }
    }

  private:
    struct Level {
        CellGrid grid;
        double largest_radius = 0;
        std::array<std::vector<double>, 3> x;  ///< in order of cells
        std::vector<double> radius;
        std::vector<std::uint32_t> grain;  ///< as stored
        std::vector<CellEntry> cells;      ///< in order of keys

        Spheres spheres() const { return {{x[0].data(), x[1].data(), x[2].data()}, radius.data()}; }
    };
    /// Cells from lowest to highest along each axis.
    struct Range {
        Cell lowest{}, highest{};
        bool operator==(const Range&) const = default;
    };

    static Level sorted_level(const ParticleSet& grains, std::vector<std::uint32_t> members, double margin);
    Range reached(const Level& from, const CellEntry& cell, const Level& into) const;
    static void find_runs(const Level& level, const Range& range, std::vector<std::size_t>& hints,
                          std::vector<Run>& runs);

    template <class Visit>
    void visit_near(const Level& from, std::uint32_t k, const Level& into, std::span<const Run> runs,
                    bool one_level, Visit&& visit) {
        const std::uint32_t i = from.grain[k];
        if (one_level && i >= own_) return;
        const std::array<double, 3> place{from.x[0][k], from.x[1][k], from.x[2][k]};
        for (const std::uint32_t found : near_(into.spheres(), runs, place, from.radius[k] + margin_))
            visit(i, into.grain[found], one_level);
    }

    double margin_;
    std::size_t own_;
    std::vector<Level> levels_;  ///< that have grains, the largest first
    NearSpheres near_;
};

}  // namespace talus::dem
