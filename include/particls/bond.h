/// @file bond.h
/// Bonds between bodies: material points of a continuum that act on all points within a horizon (peridynamics), and beams that join bodies and turn with them. See docs/theory.md.
#ifndef PARTICLS_BOND_H
#define PARTICLS_BOND_H

#include <particls/law.h>

#ifdef __cplusplus
extern "C" {
#endif

struct pls_world;

/// A set of bonds in a world. 0: none.
typedef struct pls_bonds_id
{
    uint16_t index1;
} pls_bonds_id;

/// What a plane stands for in 2D.
typedef enum pls_plane { PLS_PLANE_STRAIN, PLS_PLANE_STRESS } pls_plane;

/// How bonds of a family count, as a function of their reference length xi (of the horizon delta).
typedef enum pls_influence {
    PLS_INFLUENCE_ONE,      ///< 1
    PLS_INFLUENCE_INVERSE,  ///< delta / xi
    PLS_INFLUENCE_CONICAL,  ///< 1 - xi / delta
    PLS_INFLUENCE_GAUSSIAN, ///< exp(-xi^2 / delta^2), P1 eq. 33
    PLS_INFLUENCE_FUNCTION  ///< the user's own
} pls_influence;

/// Families near a surface lack bonds; what makes up for it.
typedef enum pls_correction {
    PLS_CORRECTION_NONE,
    PLS_CORRECTION_VOLUME, ///< the stiffness of each bond times 2 V0 / (V_i + V_j), V the volume of a family and V0 that of the fullest one (Le and Bobaru 2018)
    PLS_CORRECTION_ENERGY ///< each bond by what its two families make of stretches along the axes, compared with the fullest one (Madenci and Oterkus 2014)
} pls_correction;

/// Where a law is asked: what its constants may depend on.
typedef struct pls_bond_setting
{
    int dimension;                ///< 2 or 3
    pls_plane plane;              ///< in 2D
    pls_material_values material; ///< of the points; E and nu are NaN where not given
} pls_bond_setting;

/// Coefficients of a linear law: a bond of reference length xi and extension e in a family of weighted volume m and dilatation theta carries the force density per volume
///     t = (w / m) (dilation theta xi + extension e)        (Silling et al. 2007, THEORY 5)
/// with theta = (d / m) sum w xi e V, d = 3 (2 in 2D).
typedef struct pls_bond_coefficients
{
    double dilation;  ///< [Pa]
    double extension; ///< [Pa]
} pls_bond_coefficients;

/// A batch of bonds that turn with the two bodies they join, each seen from one of them, its own body; the same bond is seen from the other one elsewhere. All arrays hold `count` values, a
/// multiple of 8, at most PLS_LAW_BATCH, are 64-byte aligned and do not overlap; lanes that fill up hold harmless values, so that one plain loop without branches is right. A law that gives opposite forces
/// and torques that balance for the two views of a bond keeps both momenta.
typedef struct pls_pair_batch
{
    size_t count;
    const double *constants; ///< what `prepare` left
    const double *reference; ///< length of the bond when it was made [m]
    const double *length;    ///< now [m]
    const double *unit[3];   ///< from the own body to the other
    const double
        *along[2][3]; ///< of the own and the other body: a unit vector fixed in it that pointed to its partner when the bond was made
    const double *across[2][3]; ///< likewise: a unit vector across the bond, which both bodies had alike
    double *force[3];           ///< out: on the own body [N]
    double *torque[3];          ///< out: on the own body, about its centre [N m]
    double *energy;             ///< out: stored in the bond [J]
    double *load;               ///< out: part of its strength that the bond carries; from 1 on it breaks. The same for both views
} pls_pair_batch;

/// Most constants a pair law may prepare.
#define PLS_BOND_MAX_CONSTANTS 16

/// Stiffness of a bond of one length against small motions, for the stable step: as of an Euler-Bernoulli beam.
typedef struct pls_pair_stiffness
{
    double axial;   ///< EA/l [N/m]
    double bending; ///< EI/l [N m]
    double torsion; ///< GJ/l [N m]
} pls_pair_stiffness;

/// Most numbers that a family law may remember per bond, and per point.
#define PLS_BOND_MAX_MEMORY 4

/// The family of one point, for a state-based law that linear coefficients cannot say: what remembers, what yields, what is not linear. The law gives the energy E of the family and its derivatives by
/// the extensions; the set adds up forces, those of a bond from both of its families. Arrays hold `count` values, a multiple of 8, are 64-byte aligned and do not overlap. Bonds that broke, and lanes that
/// fill up, weigh nothing and have extension 0. With the weights of a family that is whole and not corrected, m = sum weight reference / volume; the dilatation is
/// theta = dimension / (m volume) sum weight extension with the m of the family as it was made.
typedef struct pls_family_batch
{
    size_t count;
    int dimension;
    const double *constants;  ///< what `prepare` left for the point's material
    double volume;            ///< of the point, V_i [m^3]
    double weighted;          ///< m of the undamaged family, sum w beta V_j xi^2 [m^5]
    const double *reference;  ///< length of each bond when it was made, xi [m]
    const double *extension;  ///< length now less reference [m]
    const double *weight;     ///< w beta V_i V_j xi [m^7]
    const double *correction; ///< of surfaces: times the stiffness against extension; 1 without
    double *const *memory;    ///< in, and out of `advance`: numbers per bond, zero at first
    double *point_memory;     ///< likewise: of the point
    double
        stiffness; ///< what the set multiplies energy, tensions and `spent` by (pls_point_condition), for laws that know stresses of their own: a yield stress is to be taken by it
    double step;   ///< of `advance`: since the last time [s]
    double *tension; ///< out of `pull`: dE/d extension per bond [N]
    double *energy;  ///< out of `pull`: E [J]
    double *spent;   ///< out of `advance`: what the step took, in heat [J]
} pls_family_batch;

/// A bond law: `linear`, alone or with `pull`, or `pair`, and what goes with it.
typedef struct pls_bond_ops
{
    uint32_t api_version; ///< PLS_API_VERSION
    const char *name;     ///< the scene's `law:` value
    const char *meaning;  ///< one line for the docs
    const pls_parameter *parameters;
    bool pairwise; ///< a bond knows itself alone: m is that of the fullest family of the set, whatever bonds its points have
    /// Coefficients of a linear law; of a family law those of its first, stiffest response, for the stable step and the critical stretch. INVALID_ARGUMENT names a value the law cannot have (nu of
    /// bond-based laws).
    pls_status (*linear)(const double *values, const pls_bond_setting *setting, pls_bond_coefficients *out);

    /// Of a family law and a pair law: check what the table cannot and turn parameters and material into constants.
    pls_status (*prepare)(const double *values, const pls_bond_setting *setting, double constants[PLS_BOND_MAX_CONSTANTS]);

    /// Family laws: energy and tensions from extensions and memory. May be asked at any time, and says the same whenever these are the same.
    void (*pull)(const pls_family_batch *batch);
    /// Bring the memory to the extensions of now, once per step, before `pull`; null: there is none.
    void (*advance)(const pls_family_batch *batch);
    int memories;       ///< numbers per bond
    int point_memories; ///< numbers per point

    /// The law of a pair.
    void (*pair)(const pls_pair_batch *batch);
    /// Stiffness of a bond of this length [m].
    void (*stiffness)(const double *constants, double length, pls_pair_stiffness *out);
} pls_bond_ops;

/// Points of a set, about which its user is asked. All arrays hold `count` values.
typedef struct pls_point_batch
{
    size_t count;
    double time;               ///< [s]
    const double *place[3];    ///< where they were when the bonds were made [m]
    const double *chance;      ///< a number in (0, 1) that each body draws for itself, the same in every run with that seed
    const double *temperature; ///< of sets with heat [K], else 0
} pls_point_batch;

/// How stiff points are and what they withstand, by the moduli of their material and by what the set's bonds withstand: both are to be set, > 0. A bond of a linear law has the mean of its two points; of a family law each family its own point's stiffness. Called from several
/// threads at once.
typedef pls_status pls_point_condition(void *context, const pls_point_batch *points, double *stiffness, double *toughness);
/// A value per point: a temperature [K] or a source of heat [W/m^3]. Called from several threads at once.
typedef pls_status pls_point_value(void *context, const pls_point_batch *points, double *values);

/// Heat in a set of peridynamic bonds: conduction between points along bonds that hold, scaled so that k is the conductivity of a full family, and expansion by temperature. Temperatures are advanced with
/// the bodies, to second order (Adams-Bashforth).
typedef struct pls_heat_def
{
    double conductivity; ///< k >= 0 [W/(m K)]; NaN (default): the set has no temperatures
    double capacity;     ///< of mass, c > 0 [J/(kg K)]
    double expansion;    ///< linear [1/K]; default 0
    double reference;    ///< temperature at which bonds are as long as they were made [K]; NaN (default): that of each point at the start
    pls_point_value *initial; ///< temperature at the start; null: 0
    pls_point_value *source;  ///< heat put in; null: none
    pls_point_value *held;    ///< temperature that a point is kept at now, NaN: it is free; null: all are
} pls_heat_def;

/// What makes a bond break.
typedef enum pls_fracture {
    PLS_FRACTURE_STRETCH, ///< its stretch
    PLS_FRACTURE_ENERGY ///< the energy that stretching it has stored, by its two volumes: 4 G/S, in 2D pi G/S, S = sum beta V_j xi of a full family (Foster et al. 2011: 4 G/(pi delta^4))
} pls_fracture;

/// A set of bonds. Copy `pls_default_bonds_def()` and change what you need.
typedef struct pls_bonds_def
{
    char name[PLS_NAME_SIZE];
    const pls_bond_ops *ops;   ///< required; must outlive the world
    const double *values;      ///< its parameters in order of its table; null: all defaults
    const pls_group_id *group; ///< bodies of these groups are its points; null: all bodies that can move or are driven
    size_t group_count;
    double horizon; ///< [m], required: bonds join all points no further apart now
    double
        spacing; ///< of points [m], over which a bond's volume fades at the horizon; 0: from the volumes of its two points; < 0: volumes do not fade
    pls_influence influence;
    double (*weight)(void *context, double xi); ///< for PLS_INFLUENCE_FUNCTION: >= 0; called from several threads at once
    void *context;                              ///< of `weight`; used while the set is made
    pls_correction correction;
    pls_plane plane;
    double critical_stretch; ///< bonds longer by more than this part break and never heal; infinite (default): none do
    double fracture_energy;  ///< G [J/m^2]: a plane that is torn apart takes so much (Silling and Askari 2005); NaN (default): not given
    pls_fracture fracture;   ///< what `fracture_energy` sets; for energies linear laws only
    pls_point_condition *
        condition; ///< null: 1 and 1. Toughness counts times the critical stretch, or energy, or the strengths of a pair law; stiffness not for pair laws
    bool condition_changes;      ///< in time or with the temperature: it is asked in every step, else once
    uint64_t seed;               ///< of `chance`
    pls_heat_def heat;           ///< not of pair laws
    void *user;                  ///< context of `condition` and of `heat`
    void (*release)(void *user); ///< called once nobody needs it any more, also when the bonds cannot be made; may be null
    uint32_t cookie;
} pls_bonds_def;

pls_bonds_def pls_default_bonds_def(void);

/// Join bodies as they lie now. For laws of peridynamics each is a point of volume mass / density of its material. While a bond holds, its two bodies do not touch.
/// Moduli are those that materials have now; where these change later, bonds keep theirs.
/// INVALID_ARGUMENT: two points in one place, a point without bonds, moduli the law cannot have, a box with less than two horizons between periodic faces.
pls_status pls_world_add_bonds(struct pls_world *world, const pls_bonds_def *def, pls_bonds_id *id);
/// A null id when there is none of that name.
pls_bonds_id pls_world_find_bonds(const struct pls_world *world, const char *name);

bool pls_world_has_bonds(const struct pls_world *world);

/// Figures of a set.
typedef struct pls_bonds_figures
{
    size_t points;
    size_t bonds;         ///< of either direction: each joins two points and counts twice
    size_t broken;        ///< likewise
    size_t bytes;         ///< held
    double energy;        ///< stored now [J]
    double energy_broken; ///< that bonds held when they broke [J]
} pls_bonds_figures;
pls_status pls_world_bonds_figures(const struct pls_world *world, pls_bonds_id id, pls_bonds_figures *figures);
/// Numbers of all sets together; energies are left out (0).
pls_bonds_figures pls_world_all_bonds(const struct pls_world *world);
/// Part of its bonds that a body has lost in a set: 0 whole, 1 none left; NaN when the body is no point of it.
double pls_world_bonds_damage(const struct pls_world *world, pls_bonds_id id, pls_body_id body);
/// Temperature of a body in a set [K]; NaN when it is no point of it or the set has no heat.
double pls_world_bonds_temperature(const struct pls_world *world, pls_bonds_id id, pls_body_id body);
/// Break the bonds of a set that cross a triangle (2D: a segment a-b) now: a crack there from the start. Returns in `cut` how many, of either direction.
pls_status pls_world_cut_bonds(struct pls_world *world, pls_bonds_id id, pls_vec3 a, pls_vec3 b, pls_vec3 c, size_t *cut);

/// Built-in bond laws; the list ends with null.
const pls_bond_ops *const *pls_builtin_bonds(void);

#ifdef __cplusplus
}
#endif
#endif
