#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "comm/decomposition.hpp"
#include "comm/record_halo.hpp"
#include "domain/box.hpp"
#include "domain/cell_grid.hpp"
#include "domain/particles.hpp"
#include "domain/partition.hpp"
#include "physics/coupling/history.hpp"
#include "physics/dem/bonds/bond_list.hpp"
#include "physics/dem/clumps/clump_motion.hpp"
#include "physics/dem/contact_list.hpp"
#include "physics/dem/contact_pass.hpp"
#include "physics/dem/motion.hpp"
#include "physics/dem/pressed_contacts.hpp"
#include "physics/dem/shear.hpp"
#include "physics/dem/wall_contacts.hpp"
#include "src/flow/grain_flow.hpp"
#include "src/flow/grain_settling.hpp"
#include "src/grain_gravity.hpp"
#include "src/phases.hpp"

namespace talus {

/// Everything that defines a run of grains besides the grains: what a scene says, resolved.
struct GrainSetup {
    Box box;                             ///< three-dimensional; open or periodic along each axis; a sheared
                                         ///< one without walls and held grains
    dem::AnyLawTable laws;               ///< of all pairs of materials
    std::vector<std::uint8_t> material;  ///< of each body of grains, an index into `laws`
    std::vector<std::uint8_t> held;      ///< one a body: 1 if its grains never move
    std::vector<dem::ClumpBody> clumps = {};  ///< one a body, or none at all
    std::vector<dem::Wall> walls;
    std::vector<dem::BondRule> bonds{};  ///< which grains are joined at the start; most often none
    dem::Vector3<> gravity;              ///< [m s-2]
    std::optional<SelfGravity> self_gravity{};
    double time_step = 0;  ///< the same throughout [s]
    double skin = 0;       ///< gap up to which pairs are listed [m]; no result depends on it
    PartitionMethod partition = PartitionMethod::cheapest;
    int rebalance_interval = 10;  ///< steps between looks at the imbalance, at least
    GrainFlowPlan flow{};         ///< sinks not of scenes with bonds
    std::optional<GrainSettling> settling{};
    /// Cells of a fluid that the grains are in: ranks own grains as they own these
    /// (GrainSimulation::follow()).
    std::optional<CellGrid> fluid_cells{};
    int slip_memories = 0;  ///< of each grain, of how it has moved through the fluid
};

/// Totals over all grains, exact sums rounded once: the same bits on any number of ranks. In a sheared box
/// velocities are counted relative to the flow.
struct GrainTotals {
    double mass = 0, kinetic_energy = 0, rotational_energy = 0;
    double potential_energy = 0;  ///< of gravity, the scene's relative to the origin [J]
    std::array<double, 3> momentum{};
    std::array<double, 3> angular_momentum{};  ///< about the origin, spin included [kg m2/s]
    double greatest_speed = 0;
    double greatest_overlap = 0;  ///< over the smaller radius [1]
    /// That grains pressed between others bore at the looks of this run so far, the least, and the overlap
    /// of that one over its radius [s], [1].
    double stable_step = 0, overlap_of_stable_step = 0;
    std::uint64_t grains = 0;  ///< a clump is one, as in the coordination
    std::uint64_t contacts = 0, wall_contacts = 0;
    std::uint64_t bonds = 0, broken_bonds = 0;
    /// Of the grains on each wall at the last evaluation [N], and their torques about the centre of its
    /// motion, which is carried along with it [N m].
    std::vector<std::array<double, 3>> wall_forces, wall_torques;
    double coordination = 0;  ///< contacts with grains a grain that is not held [1]
};

/// Spherical grains under contact laws.
class GrainSimulation {
  public:
    /// `grains` hold their share of the initial state or of a checkpoint, on any ranks, with the fields of
    /// add_fields(). Collective.
    GrainSimulation(const Communicator& comm, GrainSetup setup, ParticleSet grains);

    static void add_fields(ParticleSet& grains);
    /// The same and what the setup asks for besides.
    static void add_fields(ParticleSet& grains, const GrainSetup& setup);
    /// What contacts of the setup's law remember.
    static std::vector<const FieldInfo*> history_fields(const GrainSetup& setup);

    /// Joins grains and makes the first evaluation of a new run, at time 0 or where settling begins.
    /// Collective.
    void start();
    /// Goes on from a checkpoint: the grains given to the constructor as they were read, what
    /// save_numbers() added to its state, their contacts, and their bonds if the setup has any. Collective.
    void resume(double time, std::uint64_t step, const std::map<std::string, double>& numbers,
                const ParticleSet& contacts, const ParticleSet* bonds = nullptr);

    /// One time step. Throws AgreedError (exit code 1) naming two grains if the force between them is beyond
    /// all bounds, or a grain that was lost, left through a wall or moves no finite way. Collective.
    void step();

    /// Whether velocities are of the time of the positions: always, but within a block of steps between two
    /// impulses of self-gravity. A run can go on only from such a state.
    bool is_synchronous() const { return !gravity_ || gravity_->is_synchronous(); }

    /// Who owns which of the fluid's cells, from the next list of pairs on.
    void follow(const Partition& partition) { leader_ = partition; }
    /// Forces of the fluid over the mass of each own grain, in order, until the next call [m/s2]; the
    /// velocity of now becomes earlier_velocity.
    void set_fluid_accelerations(std::span<const dem::Vector3<>> accelerations);

    /// Angular velocities of the own grains that are not held, in order [rad/s].
    void set_spins(std::span<const dem::Vector3<>> spins);

    /// What the own grains' slips in the fluid, in order, have become [m/s], for the next time that this is
    /// called.
    void remember_slips(std::span<const dem::Vector3<>> slips,
                        const coupling::HistoryKernel::Passage& passage);

    double time() const { return time_; }                  ///< [s]
    double time_step() const { return setup_.time_step; }  ///< [s]
    std::uint64_t step_count() const { return step_; }
    /// Accelerations are among the fields after save() only, and always if there is a fluid.
    const ParticleSet& grains() const { return grains_; }
    const GrainSetup& setup() const { return setup_; }
    const dem::ClumpMotion& clumps() const { return clumps_; }
    const Communicator& comm() const { return comm_; }
    const Decomposition& decomposition() const { return decomposition_; }
    /// What came and went.
    const GrainFlow& flow() const { return flow_; }
    std::uint64_t total_grains() const { return decomposition_.total_particles(); }
    /// Contacts evaluated by this rank since the counters were reset, those with walls included.
    std::uint64_t evaluated_contacts() const { return evaluated_; }
    /// Times the list of pairs was made since the counters were reset.
    std::uint64_t list_count() const { return lists_; }
    /// Work of self-gravity on this rank since the counters were reset, or nothing without.
    const gravity::Counts* gravity_counts() const { return gravity_ ? &gravity_->counts() : nullptr; }
    /// Memory of pairs, contacts and forces on this rank, besides the fields.
    std::uint64_t bytes_of_lists() const;
    Phases& phases() { return phases_; }
    void reset_counters();

    /// Brings the grains back into the box and to where they belong, as a checkpoint holds them, and returns
    /// the contacts of this rank's grains. Changes no result. Collective.
    ParticleSet save();
    void save_numbers(std::map<std::string, double>& numbers) const;
    /// What the last steps did that a user should know.
    std::vector<std::string> take_notes();
    /// The contacts of the state as it is, those with copies on each side. Collective.
    std::vector<dem::LoadedContact> loaded_contacts();
    /// The bonds of this rank's grains, after save().
    ParticleSet saved_bonds() const;
    /// Greatest stable step under the bonds that there are [s], infinite without any. Collective.
    double stable_step_of_bonds() const;
    /// Collective.
    GrainTotals totals() const;

  private:
    void arrange(std::vector<dem::ContactRecord> records, double time);
    std::optional<std::vector<dem::ContactRecord>> exchange_grains();
    void show_accelerations();
    void hide_accelerations();
    std::vector<dem::ContactRecord> records_of_contacts() const;
    std::vector<dem::ContactRecord> records_below(std::size_t end) const;
    void describe_grains();
    void list_contacts(const std::vector<dem::ContactRecord>& records, double time);
    int cells_within(double searched) const;
    void evaluate(double time_step);
    void finish(double kick_step, const dem::Impulse& impulse);
    void settle();
    void look_at_pressed_grains();
    double remaining_motion(double time_step) const;
    std::vector<dem::WallPose> poses_at(double time) const;
    bool walls_move() const;
    const dem::Shear* shear() const { return shear_ ? &*shear_ : nullptr; }
    void refuse_not_finite();
    void refuse_overload(const dem::Overload& overload, bool at_wall);
    void join_grains();
    void refuse_bond(const dem::BondFault& found);
    double listed_gap() const { return reach_ + setup_.skin; }
    /// More than rounding may add to a gap.
    double negligible_gap() const { return 0.001 * setup_.skin; }

    const Communicator& comm_;
    dem::PeriodicPlaces places_;
    GrainSetup setup_;
    ParticleSet grains_;
    Decomposition decomposition_;
    double largest_radius_, reach_;
    std::unique_ptr<CellGrid> grid_;
    std::optional<Partition> leader_;
    std::optional<GrainGravity> gravity_;
    std::optional<dem::Shear> shear_;
    GrainFlow flow_;
    dem::ContactList pairs_;
    dem::WallContacts at_walls_;
    dem::BondList bonds_;
    std::vector<dem::WallPose> poses_;  ///< of the last evaluation, or of the last list
    dem::GrainRows rows_;
    dem::ClumpMotion clumps_;
    RecordHalo rows_halo_;
    dem::Responses responses_;
    std::vector<double> units_;        ///< of force of each grain and copy, if there are clumps [N]
    std::vector<dem::ForceSum> sums_;  ///< between evaluations rates in their place, unless fields hold them
    double time_ = 0;
    std::uint64_t step_ = 0, last_balance_ = 0;
    bool outdated_ = false;
    double moved_ = 0;                     ///< no grain of any rank has moved farther since the last list [m]
    int quiet_looks_ = 0;                  ///< in a row, while grains settle
    dem::HardestPressed hardest_pressed_;  ///< of this rank
    std::vector<std::string> notes_;
    std::string fault_;
    std::uint64_t evaluated_ = 0, lists_ = 0;
    Phases phases_;
};

}  // namespace talus
