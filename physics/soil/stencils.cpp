#include "physics/soil/stencils.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "domain/partners.hpp"
#include "domain/soil_fields.hpp"
#include "physics/sph/pass_support.hpp"

namespace talus::soil {

void StencilRows::clear() {
    targets.clear();
    partners.clear();
    weights.clear();
    first.assign(1, 0);
    interior = 0;
}

namespace {

constexpr double nearest_share = 2e-3;  // of the largest weight: less is not the nearest layer
constexpr double round_enough = 0.01;   // least det(second moments / h^2), 1 within lattices

template <int D>
struct Fit {
    using Vector = Eigen::Matrix<double, D, 1>;
    using Matrix = Eigen::Matrix<double, D, D>;

    std::vector<std::uint32_t> partners{};
    std::vector<Vector> arms{};     ///< from the target
    std::vector<double> weights{};  ///< they add up to 1 once the nearest layer is chosen
    Vector middle = Vector::Zero();
    Matrix moments = Matrix::Zero();

    void clear() {
        partners.clear();
        arms.clear();
        weights.clear();
    }
    void add(std::uint32_t partner, const Vector& arm, double weight) {
        partners.push_back(partner);
        arms.push_back(arm);
        weights.push_back(weight);
    }
    /// Leaves the partners with a good share of the largest weight.
    void keep_nearest() {
        const double least =
            weights.empty() ? 0 : nearest_share * *std::max_element(weights.begin(), weights.end());
        std::size_t kept = 0;
        for (std::size_t k = 0; k < weights.size(); ++k) {
            if (weights[k] < least) continue;
            partners[kept] = partners[k];
            arms[kept] = arms[k];
            weights[kept++] = weights[k];
        }
        partners.resize(kept);
        arms.resize(kept);
        weights.resize(kept);
    }
    /// Moments about the middle. Whether they define a gradient at this smoothing length.
    bool gather(double h) {
        double total = 0;
        middle.setZero();
        moments.setZero();
        for (const double weight : weights) total += weight;
        if (!(total > 0)) return false;
        for (std::size_t k = 0; k < weights.size(); ++k) {
            weights[k] /= total;
            middle += weights[k] * arms[k];
        }
        for (std::size_t k = 0; k < weights.size(); ++k) {
            const Vector arm = arms[k] - middle;
            moments += weights[k] * arm * arm.transpose();
        }
        return (moments / (h * h)).determinant() > round_enough;
    }
    /// Weight of each partner in the gradient, once gather() was true.
    std::vector<Vector> gradients() const {
        const Matrix inverse = moments.inverse();
        std::vector<Vector> found;
        for (std::size_t k = 0; k < weights.size(); ++k)
            found.push_back(inverse * (weights[k] * (arms[k] - middle)));
        return found;
    }
};

template <int D>
class Builder {
  public:
    using Vector = typename Fit<D>::Vector;

    Builder(const ParticleSet& particles, Stencils& stencils)
        : stencils_(stencils),
          position_(sph::components<D>(particles, field::position)),
          h_(particles.data(field::smoothing_length)),
          grid_(particles.data(soil_field::grid)),
          faces_(particles.data(soil_field::faces)) {}

    /// Appends the rows of an own particle. False: its partners define no gradient.
    bool append(std::uint32_t i, std::span<const std::uint32_t> near, bool with_unseen) {
        if (grid_[i] == element_grid) return append_element(i, near);
        const bool good = faces_[i] == 0 ? append_inner(i, near) : append_face(i, near);
        if (with_unseen) append_unseen(i, near, faces_[i] == 0 ? unseen_inner : unseen_faces);
        return good;
    }

    StencilRows unseen_inner{}, unseen_faces{};

  private:
    Vector arm(std::uint32_t from, std::uint32_t to) const {
        Vector found;
        for (int d = 0; d < D; ++d) found[d] = position_[d][to] - position_[d][from];
        return found;
    }

    /// Nearest partners of the other grid among those that are near.
    void fit_nearest(std::uint32_t i, std::span<const std::uint32_t> near, Fit<D>& fit) const {
        fit.clear();
        const double reach = weight_cutoff * h_[i];
        for (const std::uint32_t j : near) {
            if (grid_[j] == grid_[i]) continue;
            const Vector to = arm(i, j);
            const double r2 = to.squaredNorm();
            if (r2 < reach * reach) fit.add(j, to, std::exp(-r2 / (h_[i] * h_[i])));
        }
        fit.keep_nearest();
    }

    bool append_element(std::uint32_t i, std::span<const std::uint32_t> near) {
        fit_nearest(i, near, fit_);
        const bool good = fit_.gather(h_[i]);
        StencilRows& rows = stencils_.to_elements;
        rows.targets.push_back(i);
        if (good) {
            const std::vector<Vector> gradients = fit_.gradients();
            for (std::size_t k = 0; k < gradients.size(); ++k) {
                rows.partners.push_back(fit_.partners[k]);
                rows.weights.push_back(fit_.weights[k] - gradients[k].dot(fit_.middle));
                rows.weights.insert(rows.weights.end(), gradients[k].data(), gradients[k].data() + D);
            }
        }
        rows.end_row();
        return good;
    }

    bool append_inner(std::uint32_t i, std::span<const std::uint32_t> near) {
        fit_nearest(i, near, fit_);
        const bool good = fit_.gather(h_[i]);
        StencilRows& rows = stencils_.to_nodes;
        rows.targets.push_back(i);
        if (good) put_gradients(rows, fit_, fit_.gradients());
        rows.end_row();
        return good;
    }

    static void put_gradients(StencilRows& rows, const Fit<D>& fit, const std::vector<Vector>& gradients) {
        for (std::size_t k = 0; k < gradients.size(); ++k) {
            rows.partners.push_back(fit.partners[k]);
            rows.weights.insert(rows.weights.end(), gradients[k].data(), gradients[k].data() + D);
        }
    }

    /// On faces the node itself is a partner, and derivatives are sums over the arms from the node: on a
    /// lattice the adjoint of the elements' gradient, which no other choice would leave stable there.
    bool append_face(std::uint32_t i, std::span<const std::uint32_t> near) {
        fit_nearest(i, near, around_);
        StencilRows& rows = stencils_.to_faces;
        rows.targets.push_back(i);
        Vector own = Vector::Zero();
        around_.gather(h_[i]);
        const Vector scale =
            (around_.moments.diagonal() + around_.middle.cwiseProduct(around_.middle)).eval();
        const bool good = !around_.partners.empty() && scale.minCoeff() > round_enough * h_[i] * h_[i];
        std::vector<Vector> gradients;
        if (good) {
            for (std::size_t k = 0; k < around_.weights.size(); ++k) {
                gradients.push_back((around_.weights[k] * around_.arms[k]).cwiseQuotient(scale));
                own -= gradients.back();
            }
            put_gradients(rows, around_, gradients);
        }
        rows.end_row();
        stencils_.own_weights.insert(stencils_.own_weights.end(), own.data(), own.data() + D);
        if (good) append_face_gradient(i, near, gradients, own);
        return good;
    }

    /// Mean of the elements' gradients, less what to_faces makes of the elements' values and of the node's.
    void append_face_gradient(std::uint32_t i, std::span<const std::uint32_t> near,
                              const std::vector<Vector>& to_face, const Vector& own) {
        list_nodes(i, near);
        std::vector<Vector> totals(nodes_.size(), Vector::Zero());
        totals[0] = -own;
        for_each_element_weight([&](std::size_t k, std::size_t place, double value, const Vector& gradient) {
            totals[place] += around_.weights[k] * gradient - value * to_face[k];
        });
        StencilRows& rows = stencils_.face_gradients;
        rows.targets.push_back(i);
        for (std::size_t n = 0; n < nodes_.size(); ++n) {
            if (totals[n].isZero(0)) continue;
            rows.partners.push_back(nodes_[n]);
            rows.weights.insert(rows.weights.end(), totals[n].data(), totals[n].data() + D);
        }
        rows.end_row();
    }

    /// The node i, then the others that are near, in order.
    void list_nodes(std::uint32_t i, std::span<const std::uint32_t> near) {
        nodes_.assign(1, i);
        for (const std::uint32_t j : near)
            if (grid_[j] == node_grid) nodes_.push_back(j);
    }

    /// Calls visit(k, place, value, gradient) for the weights of the nodes_ at `place` in the k-th element of
    /// around_.
    template <class Visit>
    void for_each_element_weight(Visit&& visit) {
        for (std::size_t k = 0; k < around_.partners.size(); ++k) {
            const std::uint32_t e = around_.partners[k];
            fit_nearest(e, nodes_, fit_);
            if (!fit_.gather(h_[e])) continue;
            const std::vector<Vector> gradients = fit_.gradients();
            std::size_t place = 0;
            for (std::size_t n = 0; n < gradients.size(); ++n) {
                while (nodes_[place] != fit_.partners[n]) ++place;
                visit(k, place, fit_.weights[n] - gradients[n].dot(fit_.middle), gradients[n]);
            }
        }
    }

    /// 1 at the node itself, less the mean over the nearest elements of their fits at the node.
    void append_unseen(std::uint32_t i, std::span<const std::uint32_t> near, StencilRows& rows) {
        list_nodes(i, near);
        totals_.assign(nodes_.size(), 0);
        totals_[0] = 1;
        fit_nearest(i, near, around_);
        around_.gather(h_[i]);
        for_each_element_weight([&](std::size_t k, std::size_t place, double value, const Vector& gradient) {
            totals_[place] -= around_.weights[k] * (value - gradient.dot(around_.arms[k]));
        });
        rows.targets.push_back(i);
        for (std::size_t n = 0; n < nodes_.size(); ++n) {
            if (totals_[n] == 0) continue;
            rows.partners.push_back(nodes_[n]);
            rows.weights.push_back(totals_[n]);
        }
        rows.end_row();
    }

    Stencils& stencils_;
    std::array<const double*, D> position_;
    const double* h_;
    const std::uint8_t *grid_, *faces_;
    Fit<D> fit_, around_;
    std::vector<std::uint32_t> nodes_;
    std::vector<double> totals_;
};

void append_rows(const StencilRows& from, StencilRows& to) {
    for (std::size_t row = 0; row < from.targets.size(); ++row) {
        to.targets.push_back(from.targets[row]);
        to.partners.insert(to.partners.end(), from.partners.begin() + from.first[row],
                           from.partners.begin() + from.first[row + 1]);
        to.end_row();
    }
    to.weights.insert(to.weights.end(), from.weights.begin(), from.weights.end());
}

template <int D>
void build(const ParticleSet& particles, const CellTable& table, bool with_unseen, Stencils& stencils) {
    Partners<D> found(sph::components<D>(particles, field::position), particles.data(field::smoothing_length),
                      search_range);
    Builder<D> builder(particles, stencils);
    builder.unseen_inner.clear();
    builder.unseen_faces.clear();
    for (const Cells which : {Cells::interior, Cells::boundary}) {
        table.for_each_own(which, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
            found.enter(cell, runs);
            for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
                found.find(i, search_range);
                if (builder.append(i, found.index(), with_unseen)) continue;
                const std::uint64_t id = particles.data(field::id)[i];
                stencils.first_poor = stencils.poor == 0 ? id : std::min(stencils.first_poor, id);
                ++stencils.poor;
            }
        });
        if (which == Cells::interior)
            for (StencilRows* rows : {&stencils.to_nodes, &stencils.to_faces, &stencils.to_elements})
                rows->interior = rows->targets.size();
    }
    append_rows(builder.unseen_inner, stencils.unseen);
    append_rows(builder.unseen_faces, stencils.unseen);
}

}  // namespace

void build_stencils(const ParticleSet& particles, const CellTable& table, bool with_unseen,
                    Stencils& stencils) {
    for (StencilRows* rows : {&stencils.to_nodes, &stencils.to_faces, &stencils.to_elements,
                              &stencils.face_gradients, &stencils.unseen})
        rows->clear();
    stencils.own_weights.clear();
    stencils.first_poor = stencils.poor = 0;
    sph::with_dimension(particles,
                        [&](auto dimension) { build<dimension()>(particles, table, with_unseen, stencils); });
}

}  // namespace talus::soil
