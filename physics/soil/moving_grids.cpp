#include "physics/soil/moving_grids.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "domain/partners.hpp"
#include "domain/soil_fields.hpp"
#include "physics/soil/hencky.hpp"
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

template <int D>
using Vector = Eigen::Matrix<double, D, 1>;
template <int D>
using Matrix = Eigen::Matrix<double, D, D>;

template <int D, class T>
Vector<D> vector_at(const std::array<T*, D>& columns, std::size_t i) {
    Vector<D> found;
    for (int a = 0; a < D; ++a) found[a] = columns[static_cast<std::size_t>(a)][i];
    return found;
}

template <int D>
Matrix<D> symmetric_at(const std::array<const double*, sph::symmetric_count<D>>& columns, std::size_t i) {
    Matrix<D> found;
    for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b)
            found(a, b) = columns[static_cast<std::size_t>(sph::symmetric_index<D>(a, b))][i];
    return found;
}

template <int D>
Matrix<D> tensor_at(const std::array<const double*, D * D>& columns, std::size_t i) {
    Matrix<D> found;
    for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) found(a, b) = columns[static_cast<std::size_t>(a * D + b)][i];
    return found;
}

template <int D>
void put_tensor(ParticleSet& particles, const Field<double>& field, std::size_t i, const Matrix<D>& value) {
    for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) particles.data(field, a * D + b)[i] = value(a, b);
}

/// Columns of a stress in StateColumns, the lateral one among them.
template <int D>
constexpr int stress_count = sph::symmetric_count<D> + (D < 3 ? 1 : 0);

template <int D>
std::array<double*, stress_count<D>> stress_columns_of(const StateColumns<D>& columns) {
    std::array<double*, stress_count<D>> all{};
    std::copy(columns.stress.begin(), columns.stress.end(), all.begin());
    if (D < 3) all.back() = columns.lateral;
    return all;
}

/// Linear fits of the stress, value and slopes, in elements; empty unless it is smoothed.
template <int D>
std::vector<double*> stress_fits(ParticleSet& particles) {
    std::vector<double*> fits;
    if (!particles.has(soil_field::stress_fit)) return fits;
    for (int c = 0; c < (1 + D) * stress_count<D>; ++c)
        fits.push_back(particles.data(soil_field::stress_fit, c));
    return fits;
}

/// The increment of the deformation gradient that a velocity gradient makes in a time.
template <int D>
Eigen::Matrix3d deformation(const Matrix<D>& gradient, double time) {
    Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
    f.template topLeftCorner<D, D>() += time * gradient;
    return f;
}

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

/// What elements hold for nodes.
template <int D>
struct ElementColumns {
    explicit ElementColumns(const ParticleSet& particles)
        : position(sph::components<D>(particles, field::position)),
          velocity(sph::components<D>(particles, soil_field::velocity)),
          stress(sph::components<D * D>(particles, soil_field::nominal_stress)),
          slope(sph::components<D * D>(particles, soil_field::velocity_slope)),
          centre(sph::components<D>(particles, soil_field::fit_centre)),
          inverse(sph::components<sph::symmetric_count<D>>(particles, soil_field::fit_inverse)),
          weight(particles.data(soil_field::fit_weight)),
          volume(particles.data(soil_field::volume)),
          mass(particles.data(field::mass)),
          h(particles.data(field::smoothing_length)),
          grid(particles.data(soil_field::grid)) {}

    std::array<const double*, D> position, velocity;
    std::array<const double*, D * D> stress, slope;
    std::array<const double*, D> centre;
    std::array<const double*, sph::symmetric_count<D>> inverse;
    const double *weight, *volume, *mass, *h;
    const std::uint8_t* grid;
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

template <int D>
void measure_elements_in(ParticleSet& particles, Cells which, const StencilRows& rows) {
    const auto middle = sph::components<D>(particles, soil_field::middle_velocity);
    const auto velocity = sph::components_to_write<D>(particles, soil_field::velocity);
    for (std::uint32_t row = rows.begin(which); row < rows.end(which); ++row) {
        const std::uint32_t i = rows.targets[row];
        Vector<D> mean = Vector<D>::Zero();
        Matrix<D> slope = Matrix<D>::Zero();
        for (std::uint32_t k = rows.first[row]; k < rows.first[row + 1]; ++k) {
            const double* weight = rows.weights.data() + std::size_t{k} * (D + 1);
            for (int a = 0; a < D; ++a) {
                const double v = middle[a][rows.partners[k]];
                mean[a] += weight[0] * v;
                for (int b = 0; b < D; ++b) slope(a, b) += weight[1 + b] * v;
            }
        }
        // Without a gradient an element moves on as it did.
        if (rows.first[row] != rows.first[row + 1])
            for (int a = 0; a < D; ++a) velocity[a][i] = mean[a];
        put_tensor<D>(particles, soil_field::velocity_slope, i, slope);
    }
}

/// Axes along which a node's velocity is imposed.
std::array<bool, 3> held_axes(std::uint32_t held, std::span<const BoundaryCondition> conditions) {
    std::array<bool, 3> axes{};
    for (std::size_t c = 0; c < conditions.size() && held != 0; ++c)
        for (std::size_t a = 0; a < 3 && (held >> c & 1); ++a) axes[a] = axes[a] || conditions[c].held[a];
    return axes;
}

template <int D>
void deform_nodes_in(ParticleSet& particles, Cells which, const StepSettings& settings,
                     std::span<const BoundaryCondition> conditions, const StencilRows& rows,
                     const MovingMemory& memory) {
    const ElementColumns<D> of(particles);
    const StateColumns<D> columns(particles);
    const auto middle = sph::components<D>(particles, soil_field::middle_velocity);
    const auto position = sph::components_to_write<D>(particles, field::position);
    const auto displacement = sph::components_to_write<D>(particles, soil_field::displacement);
    const auto surface = sph::components_to_write<D>(particles, soil_field::surface);
    const std::uint8_t* body = particles.data(field::body);
    const double dt = settings.time_step;
    for (std::uint32_t row = rows.begin(which); row < rows.end(which); ++row) {
        const std::uint32_t i = rows.targets[row];
        Vector<D> seen = Vector<D>::Zero();
        Matrix<D> slope = Matrix<D>::Zero();
        const double volume = memory.volume[row];
        for (std::uint32_t k = rows.first[row]; k < rows.first[row + 1]; ++k) {
            const double* weight = rows.weights.data() + std::size_t{k} * (D + 1);
            const std::uint32_t e = rows.partners[k];
            const double share = weight[0] * of.volume[e] / volume;
            const Matrix<D> of_element = tensor_at<D>(of.slope, e);
            slope += share * of_element;
            seen +=
                share * (vector_at<D>(of.velocity, e) + of_element * Eigen::Map<const Vector<D>>(weight + 1));
        }
        const bool alone = !(volume > 0);
        const std::array<bool, 3> held = held_axes(particles.data(soil_field::conditions)[i], conditions);
        for (int a = 0; a < D; ++a) {
            const bool as_it_is = alone || held[static_cast<std::size_t>(a)];
            const double way = dt * (as_it_is ? middle[a][i] : seen[a]);
            position[a][i] += way;
            displacement[a][i] += way;
        }
        const Elasticity& elasticity = settings.materials[body[i]].elasticity;
        if (alone) {  // nothing is left to press on it
            columns.put_stress(i, {});
            continue;
        }
        if constexpr (D == 1) {
            const double gradient[1][1] = {{slope(0, 0)}};
            columns.add_elastic(i, elasticity, gradient, dt);
        } else {
            const Eigen::Matrix3d f = deformation<D>(slope, dt);
            columns.put_stress(i, hencky_stress(elasticity, columns.stress_at(i), f));
            const Vector<D> before = vector_at<D>(surface, i);
            if (before.isZero(0)) continue;
            const Matrix<D> plane = f.template topLeftCorner<D, D>();
            const Vector<D> after = plane.determinant() * (plane.inverse().transpose() * before);
            for (int a = 0; a < D; ++a) surface[a][i] = after[a];
        }
    }
}

template <int D>
void move_elements_in(ParticleSet& particles, const StencilRows& rows, double time_step) {
    const ElementColumns<D> of(particles);
    const auto position = sph::components_to_write<D>(particles, field::position);
    double* volume = particles.data(soil_field::volume);
    for (const std::uint32_t i : rows.targets) {
        const Matrix<D> slope = tensor_at<D>(of.slope, i);
        const Vector<D> way = time_step * (vector_at<D>(of.velocity, i) - slope * vector_at<D>(of.centre, i));
        for (int a = 0; a < D; ++a) position[a][i] += way[a];
        volume[i] *= deformation<D>(slope, time_step).determinant();
    }
}

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

void list_targets(const ParticleSet& particles, const CellTable& table, Stencils& stencils) {
    const std::uint8_t* grid = particles.data(soil_field::grid);
    stencils.to_nodes.clear();
    stencils.to_elements.clear();
    for (const Cells which : {Cells::interior, Cells::boundary}) {
        table.for_each_own(which, [&](const CellEntry& cell, std::span<const Run>, std::size_t) {
            for (std::uint32_t i = cell.begin; i < cell.end; ++i)
                (grid[i] == node_grid ? stencils.to_nodes : stencils.to_elements).targets.push_back(i);
        });
        if (which == Cells::interior)
            for (StencilRows* rows : {&stencils.to_nodes, &stencils.to_elements})
                rows->interior = rows->targets.size();
    }
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

void centre_velocities(ParticleSet& particles, const Stencils& stencils) {
    for (int a = 0; a < particles.dimension(); ++a) {
        const double* after = particles.data(soil_field::velocity, a);
        double* middle = particles.data(soil_field::middle_velocity, a);
        stencils.for_each_node([&](std::uint32_t i) { middle[i] = 0.5 * (middle[i] + after[i]); });
    }
}

void measure_elements(ParticleSet& particles, Cells which, const StencilRows& rows) {
    sph::with_dimension(particles,
                        [&](auto dimension) { measure_elements_in<dimension()>(particles, which, rows); });
}

void deform_nodes(ParticleSet& particles, Cells which, const StepSettings& settings,
                  std::span<const BoundaryCondition> conditions, const StencilRows& rows,
                  const MovingMemory& memory) {
    sph::with_dimension(particles, [&](auto dimension) {
        deform_nodes_in<dimension()>(particles, which, settings, conditions, rows, memory);
    });
}

void move_elements(ParticleSet& particles, const StencilRows& rows, double time_step) {
    sph::with_dimension(particles,
                        [&](auto dimension) { move_elements_in<dimension()>(particles, rows, time_step); });
}

}  // namespace talus::soil
