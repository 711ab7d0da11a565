#include "physics/soil/moving_grids.hpp"

#include <algorithm>
#include <cmath>

#include "domain/partners.hpp"
#include "domain/soil_fields.hpp"
#include "physics/soil/moving_columns.hpp"
#include "physics/soil/state_columns.hpp"
#include "physics/sph/kernels.hpp"

namespace talus::soil {

namespace {

/// Second moments over h^2, in their weakest direction, below which nodes define no gradient; 0.27 in
/// lattices.
constexpr double round_enough = 0.1;
/// sum V_e g over a spacing and a volume: 0 within lattices, 2 on faces. Surfaces begin at the first.
constexpr double surface_begins = 0.4, surface_is_full = 0.8;
/// Elements whose mass at a node exceeds its own this many times give it their inertia: where soil has come
/// apart few nodes have many elements, whose stiffness would be too much for the time step.
constexpr double most_elements = 1.5;

/// Least squares over the nodes around an element.
template <int D>
struct ElementFit {
    std::vector<double> weights{};  ///< they add up to 1
    std::vector<Vector<D>> arms{};  ///< of nodes from the centre
    double total = 0;               ///< of the kernel
    Vector<D> centre;               ///< of the nodes, from the element
    Matrix<D> inverse;              ///< of the second moments
    bool good = false;

    /// From kernels and arms from the element.
    void solve(double h) {
        total = 0;
        centre.setZero();
        Matrix<D> moments = Matrix<D>::Zero();
        for (const double weight : weights) total += weight;
        good = false;
        if (!(total > 0)) return;
        for (std::size_t k = 0; k < weights.size(); ++k) {
            weights[k] /= total;
            centre += weights[k] * arms[k];
        }
        for (std::size_t k = 0; k < weights.size(); ++k) {
            arms[k] -= centre;
            moments += weights[k] * arms[k] * arms[k].transpose();
        }
        const double scale = std::pow(moments.trace() / D, D - 1);
        good = moments.determinant() > round_enough * h * h * scale;
        if (good) inverse = moments.inverse();
    }
};

template <int D>
class ElementPass {
  public:
    ElementPass(ParticleSet& particles, const CellTable& table, const StepSettings& settings,
                StencilRows& rows)
        : particles_(particles),
          table_(table),
          settings_(settings),
          rows_(rows),
          columns_(particles),
          position_(sph::components<D>(particles, field::position)),
          stress_fits_(stress_fits<D>(particles)),
          h_(particles.data(field::smoothing_length)),
          grid_(particles.data(soil_field::grid)) {}

    void run(Cells which) {
        Partners<D> found(position_, h_, moving_search_range);
        table_.for_each_own(which, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
            found.enter(cell, runs);
            for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
                if (grid_[i] != element_grid) continue;
                found.find(i, moving_search_range);
                fit(i, found.index());
                predict(i);
            }
        });
    }

  private:
    void fit(std::uint32_t i, std::span<const std::uint32_t> near) {
        const sph::WendlandC2<D> kernel;
        fit_.weights.clear();
        fit_.arms.clear();
        const std::size_t before = rows_.partners.size();
        const Vector<D> at = vector_at<D>(position_, i);
        for (const std::uint32_t j : near) {
            if (grid_[j] == element_grid) continue;
            const Vector<D> arm = vector_at<D>(position_, j) - at;
            rows_.partners.push_back(j);
            fit_.weights.push_back(kernel.value(arm.squaredNorm(), 1 / h_[i]));
            fit_.arms.push_back(arm);
        }
        fit_.solve(h_[i]);
        particles_.data(soil_field::fit_weight)[i] = fit_.good ? fit_.total : 0;
        for (int a = 0; a < D; ++a)
            particles_.data(soil_field::fit_centre, a)[i] = fit_.good ? fit_.centre[a] : 0;
        for (int a = 0; a < D; ++a)
            for (int b = a; b < D; ++b)
                particles_.data(soil_field::fit_inverse, sph::symmetric_index<D>(a, b))[i] =
                    fit_.good ? fit_.inverse(a, b) : 0;
        if (!fit_.good) rows_.partners.resize(before);
        for (std::size_t k = 0; fit_.good && k < fit_.weights.size(); ++k) {
            const Vector<D> gradient = fit_.weights[k] * (fit_.inverse * fit_.arms[k]);
            rows_.weights.push_back(fit_.weights[k]);
            rows_.weights.insert(rows_.weights.end(), gradient.data(), gradient.data() + D);
        }
        rows_.end_row();
    }

    /// The stress turns with Jaumann's rate: nothing adds up, as it is forgotten after the step.
    void predict(std::uint32_t i) {
        if (!fit_.good) return fall(i);
        const std::size_t row = rows_.first.size() - 2;
        const double half = settings_.time_step / 2;
        double stress[StateColumns<D>::stresses] = {}, lateral = 0;
        Vector<D> velocity = Vector<D>::Zero();
        Matrix<D> slope = Matrix<D>::Zero();
        for (std::uint32_t k = rows_.first[row]; k < rows_.first[row + 1]; ++k) {
            const double* weight = rows_.weights.data() + std::size_t{k} * (D + 1);
            const std::uint32_t j = rows_.partners[k];
            for (int c = 0; c < StateColumns<D>::stresses; ++c)
                stress[c] += weight[0] * columns_.stress[c][j];
            if (D < 3) lateral += weight[0] * columns_.lateral[j];
            for (int a = 0; a < D; ++a) {
                const double v = columns_.velocity[a][j];
                velocity[a] += weight[0] * v;
                for (int b = 0; b < D; ++b) slope(a, b) += weight[1 + b] * v;
            }
        }
        fit_stress(i, row);
        const Matrix<D> spin = 0.5 * (slope - slope.transpose());
        Matrix<D> mean;
        for (int a = 0; a < D; ++a)
            for (int b = 0; b < D; ++b) mean(a, b) = stress[sph::symmetric_index<D>(a, b)];
        const Matrix<D> turned = mean + half * (spin * mean - mean * spin);
        for (int a = 0; a < D; ++a) {
            columns_.velocity[a][i] = velocity[a];
            for (int b = a; b < D; ++b) columns_.stress[sph::symmetric_index<D>(a, b)][i] = turned(a, b);
        }
        if (D < 3) columns_.lateral[i] = lateral;
        double gradient[D][D];
        for (int a = 0; a < D; ++a)
            for (int b = 0; b < D; ++b) gradient[a][b] = slope(a, b);
        columns_.add_elastic(i, settings_.materials[particles_.data(field::body)[i]].elasticity, gradient,
                             half);
        put_tensor<D>(particles_, soil_field::velocity_slope, i, slope);
        const Matrix<D> f = Matrix<D>::Identity() + half * slope;
        const Matrix<D> ahead =
            symmetric_at<D>(sph::components<sph::symmetric_count<D>>(particles_, soil_field::stress), i);
        put_tensor<D>(particles_, soil_field::nominal_stress, i,
                      f.determinant() * ahead * f.inverse().transpose());
    }

    /// Values and slopes of the stress.
    void fit_stress(std::uint32_t i, std::size_t row) {
        if (stress_fits_.empty()) return;
        const auto stress = stress_columns_of<D>(columns_);
        for (double* column : stress_fits_) column[i] = 0;
        for (std::uint32_t k = rows_.first[row]; k < rows_.first[row + 1]; ++k) {
            const double* weight = rows_.weights.data() + std::size_t{k} * (D + 1);
            for (std::size_t a = 0; a < D + 1; ++a)
                for (std::size_t c = 0; c < stress.size(); ++c)
                    stress_fits_[a * stress.size() + c][i] += weight[a] * stress[c][rows_.partners[k]];
        }
    }

    /// An element that fits nothing flies on.
    void fall(std::uint32_t i) {
        columns_.put_stress(i, {});
        for (std::size_t a = 0; a < D; ++a)
            columns_.velocity[a][i] += settings_.time_step * settings_.body_force[a];
        put_tensor<D>(particles_, soil_field::velocity_slope, i, Matrix<D>::Zero());
        put_tensor<D>(particles_, soil_field::nominal_stress, i, Matrix<D>::Zero());
    }

    ParticleSet& particles_;
    const CellTable& table_;
    const StepSettings& settings_;
    StencilRows& rows_;
    const StateColumns<D> columns_;
    std::array<const double*, D> position_;
    std::vector<double*> stress_fits_;
    const double* h_;
    const std::uint8_t* grid_;
    ElementFit<D> fit_{};
};

template <int D>
class NodePass {
  public:
    NodePass(ParticleSet& particles, const CellTable& table, const StepSettings& settings, StencilRows& rows,
             MovingMemory& memory)
        : particles_(particles),
          table_(table),
          settings_(settings),
          rows_(rows),
          memory_(memory),
          of_(particles),
          velocity_(sph::components_to_write<D>(particles, soil_field::velocity)),
          stress_(stress_columns_of<D>(StateColumns<D>(particles))),
          stress_fits_(stress_fits<D>(particles)) {}

    void run(Cells which) {
        Partners<D> found(of_.position, of_.h, moving_search_range);
        table_.for_each_own(which, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
            found.enter(cell, runs);
            for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
                if (of_.grid[i] != node_grid) continue;
                found.find(i, moving_search_range);
                accelerate(i, found.index());
            }
        });
    }

  private:
    void accelerate(std::uint32_t i, std::span<const std::uint32_t> near) {
        const sph::WendlandC2<D> kernel;
        const Vector<D> at = vector_at<D>(of_.position, i), own = vector_at<D>(of_.velocity, i);
        double volume = 0, around = 0;
        Vector<D> force = Vector<D>::Zero(), outward = Vector<D>::Zero(), unseen = Vector<D>::Zero();
        Matrix<D> mean = Matrix<D>::Zero();
        for (const std::uint32_t e : near) {
            if (of_.grid[e] != element_grid || of_.weight[e] == 0) continue;
            const Vector<D> to_node = at - vector_at<D>(of_.position, e);
            const double weight = kernel.value(to_node.squaredNorm(), 1 / of_.h[e]) / of_.weight[e];
            const Vector<D> arm = to_node - vector_at<D>(of_.centre, e);
            const Vector<D> gradient = weight * (symmetric_at<D>(of_.inverse, e) * arm);
            rows_.partners.push_back(e);
            rows_.weights.push_back(weight);
            rows_.weights.insert(rows_.weights.end(), arm.data(), arm.data() + D);
            const Matrix<D> stress = tensor_at<D>(of_.stress, e);
            const Vector<D> area = of_.volume[e] * gradient;
            volume += weight * of_.volume[e];
            around += weight * of_.mass[e];
            mean += weight * of_.volume[e] * stress;
            outward += area;
            force -= stress * area;
            unseen += weight * of_.mass[e] *
                      (own - vector_at<D>(of_.velocity, e) - tensor_at<D>(of_.slope, e) * arm);
        }
        rows_.end_row();
        memory_.volume.push_back(volume);
        if (volume > 0) force += mean / volume * without_traction(i, outward, volume);
        if (volume > 0) smooth_stress(i, volume);
        const double mass = std::max(of_.mass[i], around / most_elements);
        for (int a = 0; a < D; ++a) {
            particles_.data(soil_field::middle_velocity, a)[i] = own[a];
            velocity_[a][i] +=
                settings_.time_step * (force[a] / mass + settings_.body_force[static_cast<std::size_t>(a)]) -
                settings_.hourglass * unseen[a] / mass;
        }
    }

    /// Takes a share of what lies off the fits of the elements around away.
    void smooth_stress(std::uint32_t i, double volume) {
        if (stress_fits_.empty()) return;
        std::array<double, stress_count<D>> fits{};
        const std::size_t row = rows_.first.size() - 2;
        for (std::uint32_t k = rows_.first[row]; k < rows_.first[row + 1]; ++k) {
            const double* weight = rows_.weights.data() + std::size_t{k} * (D + 1);
            const std::uint32_t e = rows_.partners[k];
            const double share = weight[0] * of_.volume[e] / volume;
            for (std::size_t c = 0; c < fits.size(); ++c) {
                double fit = stress_fits_[c][e];
                for (std::size_t a = 1; a <= D; ++a) fit += weight[a] * stress_fits_[a * fits.size() + c][e];
                fits[c] += share * fit;
            }
        }
        for (std::size_t c = 0; c < fits.size(); ++c)
            stress_[c][i] -= settings_.stress_smoothing * (stress_[c][i] - fits[c]);
    }

    /// Of the area sum V_e g what is no surface: all of it within, what lies along a surface on that.
    Vector<D> without_traction(std::uint32_t i, const Vector<D>& outward, double volume) const {
        const double exposure = outward.norm() * settings_.spacing / volume;
        const double share =
            std::clamp((exposure - surface_begins) / (surface_is_full - surface_begins), 0.0, 1.0);
        if (share == 0) return outward;
        Vector<D> normal;
        for (int a = 0; a < D; ++a) normal[a] = particles_.data(soil_field::surface, a)[i];
        if (normal.isZero(0)) normal = outward;
        normal.normalize();
        return outward - share * normal.dot(outward) * normal;
    }

    ParticleSet& particles_;
    const CellTable& table_;
    const StepSettings& settings_;
    StencilRows& rows_;
    MovingMemory& memory_;
    const ElementColumns<D> of_;
    std::array<double*, D> velocity_;
    std::array<double*, stress_count<D>> stress_;
    std::vector<double*> stress_fits_;
};

}  // namespace

void add_moving_fields(ParticleSet& particles, bool smooth_stress) {
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &soil_field::volume, &soil_field::surface, &soil_field::middle_velocity,
             &soil_field::velocity_slope, &soil_field::nominal_stress, &soil_field::fit_weight,
             &soil_field::fit_centre, &soil_field::fit_inverse})
        particles.add(*info);
    if (smooth_stress)
        sph::with_dimension(particles, [&](auto dimension) {
            constexpr int D = dimension();
            particles.add(soil_field::stress_fit, (1 + D) * stress_count<D>);
        });
}

void predict_elements(ParticleSet& particles, const CellTable& table, Cells which,
                      const StepSettings& settings, StencilRows& rows) {
    sph::with_dimension(particles, [&](auto dimension) {
        ElementPass<dimension()>(particles, table, settings, rows).run(which);
    });
}

void accelerate_nodes(ParticleSet& particles, const CellTable& table, Cells which,
                      const StepSettings& settings, StencilRows& rows, MovingMemory& memory) {
    sph::with_dimension(particles, [&](auto dimension) {
        NodePass<dimension()>(particles, table, settings, rows, memory).run(which);
    });
}

}  // namespace talus::soil
