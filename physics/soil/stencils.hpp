#pragma once
#include <cstdint>
#include <vector>

#include "domain/cell_table.hpp"
#include "domain/particles.hpp"

namespace talus::soil {

inline constexpr std::uint8_t node_grid = 0, element_grid = 1;

/// Gaussian weights exp(-r^2/h^2) end at this many smoothing lengths.
inline constexpr double weight_cutoff = 4.8;
/// Nodes see the nearest elements' nearest nodes: within this many smoothing lengths.
inline constexpr double search_range = 6;
/// Smoothing length over the spacing. Then the next layer but the nearest has 3e-4 of its weight.
inline constexpr double default_smoothing = 0.5;

/// For each target particle its partners and what each counts for.
struct StencilRows {
    std::vector<std::uint32_t> targets, first, partners;  ///< `first` has one more than `targets`
    std::vector<double> weights;                          ///< as many a partner as the rows' kind has
    std::size_t interior = 0;                             ///< the first so many targets need no copies

    std::uint32_t begin(Cells which) const {
        return which == Cells::boundary ? static_cast<std::uint32_t>(interior) : 0;
    }
    std::uint32_t end(Cells which) const {
        return static_cast<std::uint32_t>(which == Cells::interior ? interior : targets.size());
    }
    void clear();
    void end_row() { first.push_back(static_cast<std::uint32_t>(partners.size())); }
};

/// Interpolation from each grid to the other by moving least squares with a linear basis, which solves for
/// value and gradient together and is exact for linear fields (P. Lancaster, K. Salkauskas, Math. Comp. 37
/// (1981) 141), from the nearest layer of partners. Nodes on faces count themselves among the partners, for
/// what is imposed there. Decision 020 says why.
struct Stencils {
    /// Weights of a partner: of the value, then of the gradient's D components [1/m].
    StencilRows to_elements;
    /// Weights of a partner: of the gradient's components. Nodes within and nodes on faces.
    StencilRows to_nodes, to_faces;
    /// Of each row of to_faces the weights of the gradient that the node has itself, D of them.
    std::vector<double> own_weights;
    /// From nodes to nodes on faces, in order of to_faces: what the gradient there lacks to be the mean of
    /// the gradients of the elements around, the conjugate of the forces; D weights a partner.
    StencilRows face_gradients;
    /// From nodes to nodes, those within first, one weight a partner: what of the node's value no element
    /// sees, as it lies off the linear fits of the elements around. Empty unless asked for.
    StencilRows unseen;
    /// Id of a particle whose partners do not define a gradient, and how many there are.
    std::uint64_t first_poor = 0, poor = 0;

    /// Calls visit(i) for every own node.
    template <class Visit>
    void for_each_node(Visit&& visit) const {
        for (const std::uint32_t i : to_nodes.targets) visit(i);
        for (const std::uint32_t i : to_faces.targets) visit(i);
    }
    std::size_t partner_count() const {
        return to_elements.partners.size() + to_nodes.partners.size() + to_faces.partners.size() +
               face_gradients.partners.size() + unseen.partners.size();
    }
};

/// For all own particles. Needs soil_field::grid and faces, positions and smoothing lengths, those of the
/// copies too, within search_range.
void build_stencils(const ParticleSet& particles, const CellTable& table, bool with_unseen,
                    Stencils& stencils);

}  // namespace talus::soil
