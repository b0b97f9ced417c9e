// bodies.h -- the bodies' columns and the one table that describes them (DESIGN contract 2).
//
// What the contact loop reaches by index lies in two packed rows per body, `place` and `spin` (one cache line each); what passes once per step
// lies in further columns. PLS_BODY_COLUMNS lists the columns, PLS_BODY_FIELDS every value in them: allocation, growth, re-ordering, checkpoints,
// hashes, frames and the docs page of fields follow from these two lists.
//
// A body has a number, given once, and a row, its place in memory. Numbers order all sums and files; rows follow a space-filling curve and change at will.
#ifndef PLS_MODEL_BODIES_H
#define PLS_MODEL_BODIES_H

#include <particls/field.h>
#include <particls/types.h>

/// First cache line of the contact loop: where a body is and how it moves. Within a step velocities are those of its middle, which tangential springs integrate,
/// and `lead` + them those of its end, which dashpots see (velocity_verlet_simd.c). The lead is in three places because there is room.
typedef struct pls_body_place
{
    double x, y, z;    ///< [m]
    double radius;     ///< bounding radius [m], infinite for unbounded bodies
    double vx, vy, vz; ///< [m/s]
    double lead_z;     ///< only within a step [m/s]
} pls_body_place;

/// Second cache line: how it turns.
typedef struct pls_body_spin
{
    double wx, wy, wz;          ///< [rad/s]; within a step that of its middle
    double lead_x;              ///< only within a step [m/s]
    double end_x, end_y, end_z; ///< only within a step: angular velocity of its end [rad/s]
    double lead_y;              ///< only within a step [m/s]
} pls_body_spin;

/// Force and torque, and how the body answers them.
typedef struct pls_body_load
{
    double fx, fy, fz;  ///< [N]
    double inv_mass;    ///< [1/kg], 0 for bodies that no force moves
    double tx, ty, tz;  ///< [N m]
    double inv_inertia; ///< 1/I of bodies with three equal moments [1/(kg m^2)], 0 for others
} pls_body_load;

/// Force and torque one step earlier: they only help to predict the velocity that dashpots see, for which single precision is plenty.
typedef struct pls_body_before
{
    float fx, fy, fz; ///< [N]
    float growth;     ///< half the change of radius in this step [m]
    float tx, ty, tz; ///< [N m]
    float spare;      ///< keeps rows aligned
} pls_body_before;

typedef struct pls_body_mass
{
    double mass;       ///< [kg]
    double ix, iy, iz; ///< principal moments [kg m^2]
} pls_body_mass;

typedef struct pls_body_orientation
{
    double w, x, y, z;
} pls_body_orientation;

/// What a body is, rarely changed.
typedef struct pls_body_kind
{
    uint32_t number;     ///< persistent number
    uint32_t generation; ///< of the number
    uint32_t group;      ///< group id's index1, 0: none
    uint16_t shape;      ///< index of its shape
    uint16_t material;   ///< index of its material
    uint32_t flags;      ///< pls_body_flags
    uint32_t motion;     ///< 1 + index of its motion, 0: none
} pls_body_kind;

enum pls_body_flags {
    PLS_BODY_UNBOUNDED = 1,   ///< a half-space
    PLS_BODY_DRIVEN = 2,      ///< all axes prescribed: no force moves it
    PLS_BODY_SPECIAL = 4,     ///< some axes prescribed, or velocities by function: advanced one by one
    PLS_BODY_ANISOTROPIC = 8, ///< three different moments: rotation advanced one by one
    PLS_BODY_SOLID = 16,      ///< neither a ball nor a half-space: its contacts are those of solid_list.h
};

// X(row type, column)
#define PLS_BODY_COLUMNS(X)              \
    X(pls_body_place, place)             \
    X(pls_body_spin, spin)               \
    X(pls_body_orientation, orientation) \
    X(pls_body_load, load)               \
    X(pls_body_before, before)           \
    X(pls_body_mass, mass)               \
    X(double, damped)                    \
    X(double, damping_power)             \
    X(double, slid)                      \
    X(double, scale)                     \
    X(float, damage)                     \
    X(pls_body_kind, kind)

// X(name, type, components, flags, unit, column, row type, first member, meaning)
#define PLS_BODY_FIELDS(X)                                                                                                       \
    X("number", PLS_U32, 1, PERSISTS | FRAME | ID, "", kind, pls_body_kind, number, "persistent number of the body")             \
    X("generation", PLS_U32, 1, PERSISTS, "", kind, pls_body_kind, generation, "how often the number has been given")            \
    X("group", PLS_U32, 1, PERSISTS | FRAME, "", kind, pls_body_kind, group, "entry of the scene it belongs to")                 \
    X("shape", PLS_U16, 1, PERSISTS | FRAME, "", kind, pls_body_kind, shape, "its shape")                                        \
    X("material", PLS_U16, 1, PERSISTS | FRAME, "", kind, pls_body_kind, material, "its material")                               \
    X("flags", PLS_U32, 1, PERSISTS, "", kind, pls_body_kind, flags,                                                             \
      "how it moves: 1 unbounded, 2 driven, 4 partly driven, 8 anisotropic, 16 neither ball nor half-space")                     \
    X("motion", PLS_U32, 1, PERSISTS, "", kind, pls_body_kind, motion, "its prescribed motion")                                  \
    X("position", PLS_F64, 3, PERSISTS, "m", place, pls_body_place, x, "centre of mass")                                         \
    X("radius", PLS_F64, 1, PERSISTS | FRAME, "m", place, pls_body_place, radius, "bounding radius")                             \
    X("velocity", PLS_F64, 3, PERSISTS | FRAME, "m/s", place, pls_body_place, vx, "velocity of the centre of mass")              \
    X("inv_mass", PLS_F64, 1, PERSISTS, "1/kg", load, pls_body_load, inv_mass, "inverse mass, 0 where no force moves it")        \
    X("angular_velocity", PLS_F64, 3, PERSISTS | FRAME, "rad/s", spin, pls_body_spin, wx, "angular velocity, world frame")       \
    X("inv_inertia", PLS_F64, 1, PERSISTS, "1/(kg m^2)", load, pls_body_load, inv_inertia, "inverse moment of isotropic bodies") \
    X("orientation", PLS_F64, 4, PERSISTS | FRAME, "", orientation, pls_body_orientation, w,                                     \
      "unit quaternion w x y z, principal axes of the shape to world")                                                           \
    X("force", PLS_F64, 3, PERSISTS | FRAME, "N", load, pls_body_load, fx, "contact and body forces")                            \
    X("torque", PLS_F64, 3, PERSISTS | FRAME, "N m", load, pls_body_load, tx, "torque about the centre of mass")                 \
    X("energy_damped", PLS_F64, 1, PERSISTS, "J", damped, double, ,                                                              \
      "half of the energy taken by its contacts' dashpots; what its bonds and damping took")                                     \
    X("damping_power", PLS_F64, 1, PERSISTS, "W", damping_power, double, , "half of the power taken by its contacts' dashpots")  \
    X("force_before", PLS_F32, 3, PERSISTS, "N", before, pls_body_before, fx, "force one step earlier")                          \
    X("torque_before", PLS_F32, 3, PERSISTS, "N m", before, pls_body_before, tx, "torque one step earlier")                      \
    X("mass", PLS_F64, 1, PERSISTS, "kg", mass, pls_body_mass, mass, "mass")                                                     \
    X("inertia", PLS_F64, 3, PERSISTS, "kg m^2", mass, pls_body_mass, ix, "principal moments of inertia")                        \
    X("energy_slid", PLS_F64, 1, PERSISTS, "J", slid, double, , "half of the energy taken by sliding at its contacts")           \
    X("scale", PLS_F64, 1, PERSISTS | FRAME, "", scale, double, , "multiplies the lengths of its shape")                         \
    X("damage", PLS_F32, 1, BONDED, "", damage, float, , "part of its bonds that are broken")

/// Zero-initialise; `pls_bodies_free` releases.
typedef struct pls_bodies
{
    size_t count, capacity; ///< rows
#define PLS_COLUMN_MEMBER(type, name) type *name;
    PLS_BODY_COLUMNS(PLS_COLUMN_MEMBER)
#undef PLS_COLUMN_MEMBER

    // by number
    uint32_t *row_of;        ///< row, UINT32_MAX where there is none
    uint32_t *generation_of; ///< generation last given
    size_t numbers, number_capacity;
    size_t removed; ///< numbers without a row
} pls_bodies;

#define PLS_NO_ROW UINT32_MAX

/// A half-space that turns, or may: far points of it move quickly, so all bodies are in its list, and looks that count on small displacements leave it out.
static inline bool pls_wall_sweeps(const pls_bodies *bodies, size_t wall)
{
    const pls_body_spin *spin = &bodies->spin[wall];
    return spin->wx != 0.0 || spin->wy != 0.0 || spin->wz != 0.0 || (bodies->kind[wall].flags & PLS_BODY_SPECIAL);
}

pls_status pls_bodies_reserve(pls_bodies *bodies, size_t count);
/// A new zeroed row with the smallest free number; `*row` is its place.
pls_status pls_bodies_add(pls_bodies *bodies, uint32_t *row);
/// A new zeroed row with a given, free number and generation (restoring).
pls_status pls_bodies_add_numbered(pls_bodies *bodies, uint32_t number, uint32_t generation, uint32_t *row);
/// Take a row out; the last row takes its place.
void pls_bodies_remove(pls_bodies *bodies, uint32_t row);
/// Re-order memory: row k becomes what was row old_row[k].
pls_status pls_bodies_reorder(pls_bodies *bodies, const uint32_t *old_row);
void pls_bodies_clear(pls_bodies *bodies);
void pls_bodies_free(pls_bodies *bodies);
/// Start of the column a field lies in.
void *pls_bodies_column(const pls_bodies *bodies, int column);
size_t pls_bodies_row_size(int column);
/// Bytes held per row of capacity, all columns and maps.
size_t pls_bodies_bytes(const pls_bodies *bodies);

#endif
