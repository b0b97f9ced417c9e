// schema.c -- the table.
//
// Rows of a section lie together, in the order in which scene.used.yaml and the reference page list them. Add a key: one row here, and one
// line where parse_*.c or build.c uses it.

#include "scene/schema.h"

#include "base/text.h"

#include <stdio.h>
#include <string.h>

static const pls_section sections[] = {
    {"scene", "top level", "The keys of a scene file."},
    {"material", "materials.NAME",
     "What bodies are made of. Which values are needed depends on the contact laws; bodies with mass need a density."},
    {"domain", "domain", "The periodic box. Without it space has no bounds."},
    {"body", "bodies[k]",
     "A body, or a group of bodies that are alike. Its name is also the name of the group, for observers, forces and states. "
     "An unbounded shape (a plane) without `motion` is fixed by itself."},
    {"place", "bodies[k].place", "Where the bodies of a group are: exactly one of these."},
    {"lattice", "bodies[k].place.lattice", "A rectangular lattice. Bodies are numbered with x fastest, then y, then z."},
    {"hex_pack", "bodies[k].place.hex_pack",
     "Hexagonal close packing; in 2D the triangular lattice. With R = spacing / 2 the body (i, j, k) lies at corner + R + R (2 i + (j + k) "
     "mod 2, "
     "sqrt(3) (j + (k mod 2) / 3), 2 sqrt(6) / 3 k); in 2D at corner + R + R (2 i + j mod 2, sqrt(3) j). Numbered with i fastest, then j, "
     "then k."},
    {"random", "bodies[k].place.random",
     "A loose random packing: bodies are put one after the other, the large ones first, at random places of the box where they touch "
     "nothing of this entry. "
     "The result depends on nothing but these values. Packings denser than about 0.35 by volume (2D: 0.5 by area) are out of reach."},
    {"radius", "bodies[k].place.random.radius",
     "Distribution of radii by number: exactly one of these. Radii are bounding radii of the scaled shape."},
    {"lognormal", "bodies[k].place.random.radius.lognormal", "A log-normal distribution, cut at both ends."},
    {"power", "bodies[k].place.random.radius.power", "Density proportional to r^exponent between two radii."},
    {"box", "... box", "A box with edges along the axes."},
    {"csv", "bodies[k].place.csv",
     "Bodies from a table. Its first line names the columns: x, y (z in 3D) are needed; radius or scale, vx, vy, vz, wx, wy, wz (2D: wz) "
     "and qw, qx, qy, qz may "
     "follow, in any order, and volume [m^3] of points of a continuum (2D: area [m^2]), which makes their mass by the material's density."},
    {"fill", "bodies[k].place.fill",
     "Points of a continuum: a lattice fills a region, and each point has the mass of its cell. The shape of the entry is what points "
     "touch with where no bond holds them: as a rule "
     "a sphere of half a spacing."},
    {"motion", "bodies[k].motion",
     "Prescribed motion. Axes not mentioned stand still; `free` in place of a number leaves that axis to the forces."},
    {"turn", "... orientation", "A rotation about an axis."},
    {"any_shape", "shapes.NAME",
     "What may stand beside the kind of a shape that has mass: `{sphere: {radius: 0.1}, density_factor: \"1 + 5*z\"}`. A compound may have "
     "it, its parts may not."},
    {"part", "shapes.NAME.compound.parts[k]",
     "A shape of the scene as a part of a compound. Shapes that are only parts stand under `shapes` like all others."},
    {"contact", "contact[k]",
     "The contact law between two materials. The parameters of the law stand beside `law`. A pair that is named wins over `all`."},
    {"bond", "bonds[k]",
     "Bonds between the bodies of some entries. With the laws of peridynamics each body is a point of a continuum and acts on all others "
     "within the horizon; volumes are masses by the densities of "
     "materials. Beams join bodies within the horizon and turn with them. Moduli are those of materials. Bodies do not touch while a bond "
     "holds them. What makes families of bonds (`influence`, "
     "`spacing`, `correction`, `plane`, `fracture_energy`, `criterion`), `stiffness` and `heat` have no place in entries of beams. The "
     "parameters of the law stand beside "
     "`law`."},
    {"crack", "bonds[k].cracks[k]", "A crack that is there from the start: bonds that cross it are broken."},
    {"heat", "bonds[k].heat",
     "Temperature of the points, in kelvin or from wherever is convenient: it flows along bonds that hold, not across cracks, and "
     "stretches them. What it does to `stiffness` and `toughness` is said there."},
    {"held", "bonds[k].heat.held[k]", "Points whose temperature is given. Of several that hold a point the last one counts."},
    {"gravity", "forces[k]", "Uniform gravity."},
    {"field_force", "forces[k]", "A field of forces given by expressions."},
    {"field", "forces[k].field",
     "Force as a function of place, time and the body's own motion. Exactly one of `force`, `acceleration` and `density`."},
    {"traction_force", "forces[k]", "A force per area on the bodies of a face."},
    {"traction", "forces[k].traction",
     "A force per area. The bodies that `where` chooses at the start share value times area by their masses: of a continuum a layer of its "
     "points."},
    {"pressure_force", "forces[k]", "A pressure on the bodies of a face."},
    {"pressure", "forces[k].pressure", "As a traction, against the outward normal of the face, which does not turn with it."},
    {"force_plugin", "forces[k]", "A body force of a plugin. What it takes is said by `particls info PLUGIN.so`."},
    {"plugin", "forces[k].NAME, observe[k].NAME", "What stands beside the parameters of a plugin's force or observer."},
    {"state", "states[k]",
     "A further ordinary differential equation, advanced with the bodies by the midpoint rule. Its name may be used in expressions of "
     "materials, contact laws and "
     "other states."},
    {"state_radius", "states[k].radius", "Short form for a radius that changes: target `radius`, starting from the body's own."},
    {"time", "time", "Duration and time step."},
    {"neighbours", "neighbours", "The neighbour search. Never changes results, only speed."},
    {"guard", "guard", "When to stop a run that has gone wrong."},
    {"observe_collection", "observe[k]", "Averages over a group of bodies, a line per look in series/NAME.csv."},
    {"observe_particle", "observe[k]", "Quantities of each body of an entry, a line per look in series/NAME.csv."},
    {"observe_frames", "observe[k]", "Pictures of all bodies for ParaView in frames/."},
    {"observe_checkpoint", "observe[k]", "Checkpoints from which a run goes on; the last two are kept."},
    {"observe_plugin", "observe[k]",
     "An observer of a plugin, a line per look in series/NAME.csv. What it takes and writes is said by `particls info PLUGIN.so`."},
    {"checkpoint", "observe[k].checkpoint", "When checkpoints are written: exactly one of these."},
    {"volume", "observe[k].volume", "The volume that averages refer to."},
};

#define TIMELY   (PLS_USES_TIME | PLS_USES_STATES)
#define FIELD    (PLS_USES_TIME | PLS_USES_PLACE | PLS_USES_VELOCITY | PLS_USES_RADIUS | PLS_USES_MASS)
#define RATE     (PLS_USES_TIME | PLS_USES_PLACE | PLS_USES_VELOCITY | PLS_USES_RADIUS | PLS_USES_OWN | PLS_USES_STATES)
#define OF_POINT (PLS_USES_TIME | PLS_USES_PLACE | PLS_USES_CHANCE | PLS_USES_TEMPERATURE)
#define ANY      -INFINITY, INFINITY
#define POSITIVE 0.0, INFINITY
#define REQUIRED PLS_KEY_REQUIRED
#define OPEN     PLS_KEY_OPEN_MINIMUM

#define FACE(section)                                                                                                                      \
    {section, "area", PLS_KEY_NUMBER, REQUIRED | OPEN, 0, NULL, NULL, "m^2", NULL, POSITIVE, "of the face, in 2D length times thickness"}, \
        {section,                                                                                                                          \
         "where",                                                                                                                          \
         PLS_KEY_CONDITION,                                                                                                                \
         0,                                                                                                                                \
         PLS_USES_PLACE,                                                                                                                   \
         NULL,                                                                                                                             \
         NULL,                                                                                                                             \
         "",                                                                                                                               \
         NULL,                                                                                                                             \
         ANY,                                                                                                                              \
         "the bodies whose centres lie where this is true at the start, for example \"x > 0.99\"; all without it"},                        \
    {                                                                                                                                      \
        section, "bodies", PLS_KEY_TEXT, 0, 0, NULL, NULL, "", "all", ANY, "name of a body entry, or all"                                  \
    }

#define SCHEDULE(section)                                                                                                                 \
    {section, "every", PLS_KEY_NUMBER, OPEN, 0, NULL, NULL, "s", NULL, POSITIVE, "time between looks; give this or `every_steps`"},       \
        {section, "every_steps", PLS_KEY_INTEGER, 0, 0, NULL, NULL, "", NULL, 1, 1e15, "steps between looks"},                            \
        {section, "start", PLS_KEY_NUMBER, 0, 0, NULL, NULL, "s", "0", POSITIVE, "first look"},                                           \
        {section, "end", PLS_KEY_NUMBER, PLS_KEY_INFINITE, 0, NULL, NULL, "s", "inf", POSITIVE, "no looks after this time"},              \
    {                                                                                                                                     \
        section, "name", PLS_KEY_NAME, 0, 0, NULL, NULL, "", NULL, ANY,                                                                   \
            "name of its file; by default the entry for a particle observer, else collection, frames or the plugin's name of it; with a " \
            "number if taken"                                                                                                             \
    }

static const pls_key keys[] = {
    // section, name, type, flags, uses, words, sub, unit, initial, minimum, maximum, meaning
    {"scene", "particls", PLS_KEY_INTEGER, REQUIRED, 0, NULL, NULL, "", NULL, 1, 1, "version of the scene language"},
    {"scene", "title", PLS_KEY_TEXT, 0, 0, NULL, NULL, "", "", ANY, "one line for people"},
    {"scene", "dimension", PLS_KEY_INTEGER, 0, 0, NULL, NULL, "", "3", 2, 3, "2: the x-y plane"},
    {"scene", "thickness", PLS_KEY_NUMBER, OPEN | PLS_KEY_ONLY_2D, 0, NULL, NULL, "m", "1", POSITIVE, "depth of bodies in z"},
    {"scene", "vars", PLS_KEY_VARIABLES, 0, 0, NULL, NULL, "", NULL, ANY,
     "names for numbers, usable in every expression; later ones may use earlier ones"},
    {"scene", "plugins", PLS_KEY_PATHS, PLS_KEY_MAY_BE_EMPTY, 0, NULL, NULL, "", NULL, ANY,
     "shared objects with further shapes, laws, forces and observers"},
    {"scene", "materials", PLS_KEY_NAMED, REQUIRED, 0, NULL, "material", "", NULL, ANY, "materials by name"},
    {"scene", "shapes", PLS_KEY_SHAPES, REQUIRED, 0, NULL, NULL, "", NULL, ANY, "shapes by name"},
    {"scene", "domain", PLS_KEY_SECTION, 0, 0, NULL, "domain", "", NULL, ANY, "periodic box"},
    {"scene", "bodies", PLS_KEY_LIST, REQUIRED, 0, NULL, "body", "", NULL, ANY, "bodies and groups of bodies"},
    {"scene", "contact", PLS_KEY_LIST, PLS_KEY_MAY_BE_EMPTY, 0, NULL, "contact", "", NULL, ANY, "contact laws"},
    {"scene", "bonds", PLS_KEY_LIST, PLS_KEY_MAY_BE_EMPTY, 0, NULL, "bond", "", NULL, ANY, "bonds between bodies"},
    {"scene", "forces", PLS_KEY_LIST, PLS_KEY_MAY_BE_EMPTY, 0, NULL, "gravity|field_force|traction_force|pressure_force|force_plugin", "",
     NULL, ANY, "body forces and loads on faces"},
    {"scene", "states", PLS_KEY_LIST, PLS_KEY_MAY_BE_EMPTY, 0, NULL, "state", "", NULL, ANY, "further differential equations"},
    {"scene", "time", PLS_KEY_SECTION, REQUIRED, 0, NULL, "time", "", NULL, ANY, "duration and time step"},
    {"scene", "neighbours", PLS_KEY_SECTION, 0, 0, NULL, "neighbours", "", "", ANY, "neighbour search"},
    {"scene", "guard", PLS_KEY_SECTION, 0, 0, NULL, "guard", "", "", ANY, "stops a run that has gone wrong"},
    {"scene", "observe", PLS_KEY_LIST, PLS_KEY_MAY_BE_EMPTY, 0, NULL,
     "observe_collection|observe_particle|observe_frames|observe_checkpoint|observe_plugin", "", NULL, ANY, "what is measured and when"},

    {"material", "density", PLS_KEY_NUMBER, OPEN, TIMELY, NULL, NULL, "kg/m^3", NULL, POSITIVE, "mass per volume, in 2D too"},
    {"material", "young_modulus", PLS_KEY_NUMBER, OPEN, TIMELY, NULL, NULL, "Pa", NULL, POSITIVE, "Young's modulus E"},
    {"material", "poisson_ratio", PLS_KEY_NUMBER, OPEN, TIMELY, NULL, NULL, "", NULL, -1, 0.5, "Poisson's ratio nu"},

    {"domain", "periodic", PLS_KEY_FLAGS, REQUIRED, 0, NULL, NULL, "", NULL, ANY, "whether space repeats along each axis"},
    {"domain", "lower", PLS_KEY_VECTOR, REQUIRED, 0, NULL, NULL, "m", NULL, ANY,
     "lower corner of the box at t = 0; only periodic axes matter"},
    {"domain", "upper", PLS_KEY_VECTOR, REQUIRED, 0, NULL, NULL, "m", NULL, ANY, "upper corner of the box at t = 0"},
    {"domain", "stretch_rate", PLS_KEY_VECTOR, 0, 0, NULL, NULL, "1/s", "0", ANY,
     "relative rate of change of each edge: L(t) = L(0) (1 + rate t)"},

    {"any_shape", "density_factor", PLS_KEY_NUMBER, OPEN, PLS_USES_PLACE, NULL, NULL, "", NULL, POSITIVE,
     "times the material's density: a field over x, y, z of the shape's own frame [m], before the body's scale. Mass, centre of mass (the "
     "body's position), inertia and principal axes follow by quadrature"},

    {"body", "name", PLS_KEY_NAME, 0, 0, NULL, NULL, "", NULL, ANY, "name of the entry and its group; body_1, body_2, ... by default"},
    {"body", "shape", PLS_KEY_MIX, REQUIRED | OPEN, 0, NULL, NULL, "", NULL, POSITIVE,
     "name of a shape; or a mix, drawn at random for each body: [ball, stone], or by number {ball: 3, stone: 1}"},
    {"body", "material", PLS_KEY_TEXT, REQUIRED, 0, NULL, NULL, "", NULL, ANY, "name of a material"},
    {"body", "place", PLS_KEY_CHOICE, 0, 0, NULL, "place", "", NULL, ANY, "places of many bodies; give this or `position`"},
    {"body", "position", PLS_KEY_VECTOR, 0, 0, NULL, NULL, "m", NULL, ANY,
     "centre of mass; of a plane, a point on it; of a mesh or polyline, the origin of its frame"},
    {"body", "orientation", PLS_KEY_ORIENTATION, 0, 0, "random", "turn", "", NULL, ANY,
     "the shape's own frame to the world: quaternion [w, x, y, z] or {axis, angle}; in 2D an angle [rad]; random: any, equally likely"},
    {"body", "seed", PLS_KEY_INTEGER, 0, 0, NULL, NULL, "", NULL, 0, 9007199254740992.0,
     "of shapes and orientations drawn at random; that of `random` by default, else 1"},
    {"body", "normal", PLS_KEY_VECTOR, 0, 0, NULL, NULL, "", NULL, ANY,
     "outward normal of a plane: the shape's z axis (2D: y axis) is turned onto it"},
    {"body", "velocity", PLS_KEY_VECTOR, 0, PLS_USES_PLACE, NULL, NULL, "m/s", NULL, ANY,
     "at the start; may depend on x, y, z of the body"},
    {"body", "angular_velocity", PLS_KEY_SPIN, 0, PLS_USES_PLACE, NULL, NULL, "rad/s", NULL, ANY,
     "at the start; may depend on x, y, z of the body"},
    {"body", "scale", PLS_KEY_NUMBER, OPEN, 0, NULL, NULL, "", "1", POSITIVE, "multiplies the lengths of the shape"},
    {"body", "mass", PLS_KEY_NUMBER, OPEN, 0, NULL, NULL, "kg", NULL, POSITIVE, "in place of density times volume"},
    {"body", "inertia", PLS_KEY_SPIN, OPEN, 0, NULL, NULL, "kg m^2", NULL, POSITIVE, "principal moments in place of the shape's"},
    {"body", "fixed", PLS_KEY_BOOLEAN, 0, 0, NULL, NULL, "", NULL, ANY, "never moves"},
    {"body", "lock", PLS_KEY_WORDS, 0, 0, "x|y|z|rx|ry|rz", NULL, "", NULL, ANY, "axes along and about which the body does not move"},
    {"body", "motion", PLS_KEY_SECTION, 0, 0, NULL, "motion", "", NULL, ANY, "prescribed motion"},

    {"place", "lattice", PLS_KEY_SECTION, 0, 0, NULL, "lattice", "", NULL, ANY, "rectangular lattice"},
    {"place", "hex_pack", PLS_KEY_SECTION, 0, 0, NULL, "hex_pack", "", NULL, ANY, "hexagonal packing"},
    {"place", "random", PLS_KEY_SECTION, 0, 0, NULL, "random", "", NULL, ANY, "loose random packing"},
    {"place", "csv", PLS_KEY_SECTION, 0, 0, NULL, "csv", "", NULL, ANY, "from a table"},
    {"place", "fill", PLS_KEY_SECTION, 0, 0, NULL, "fill", "", NULL, ANY, "points of a continuum in a region"},
    {"place", "points", PLS_KEY_POINTS, 0, 0, NULL, NULL, "m", NULL, ANY, "list of centres"},

    {"lattice", "count", PLS_KEY_COUNTS, REQUIRED, 0, NULL, NULL, "", NULL, 1, 1e9, "bodies along each axis"},
    {"lattice", "spacing", PLS_KEY_NUMBER, OPEN, 0, NULL, NULL, "m", NULL, POSITIVE,
     "distance of neighbours; twice the bounding radius by default"},
    {"lattice", "corner", PLS_KEY_VECTOR, 0, 0, NULL, NULL, "m", "0", ANY, "lower corner; the first centre lies half a spacing inside"},

    {"hex_pack", "count", PLS_KEY_COUNTS, REQUIRED, 0, NULL, NULL, "", NULL, 1, 1e9, "bodies in a row, rows in a layer, layers"},
    {"hex_pack", "corner", PLS_KEY_VECTOR, 0, 0, NULL, NULL, "m", "0", ANY, "lower corner of the packing"},
    {"hex_pack", "spacing", PLS_KEY_NUMBER, OPEN, 0, NULL, NULL, "m", NULL, POSITIVE,
     "distance of neighbours; twice the bounding radius by default"},

    {"random", "count", PLS_KEY_INTEGER, REQUIRED, 0, NULL, NULL, "", NULL, 1, 1e9, "bodies"},
    {"random", "box", PLS_KEY_SECTION, REQUIRED, 0, NULL, "box", "", NULL, ANY, "holds every body as a whole"},
    {"random", "radius", PLS_KEY_NUMBER, OPEN, 0, NULL, "radius", "m", NULL, POSITIVE,
     "one radius or a distribution; that of the shape by default"},
    {"random", "seed", PLS_KEY_INTEGER, 0, 0, NULL, NULL, "", "1", 0, 9007199254740992.0, "another seed, another packing"},
    {"random", "gap", PLS_KEY_NUMBER, 0, 0, NULL, NULL, "m", "0", POSITIVE, "least distance of surfaces"},
    {"random", "attempts", PLS_KEY_INTEGER, 0, 0, NULL, NULL, "", "10000", 1, 1e9, "places tried for a body before giving up"},

    {"radius", "uniform", PLS_KEY_RANGE, OPEN, 0, NULL, NULL, "m", NULL, POSITIVE, "[smallest, largest], equally likely between"},
    {"radius", "lognormal", PLS_KEY_SECTION, 0, 0, NULL, "lognormal", "", NULL, ANY, "log-normal"},
    {"radius", "power", PLS_KEY_SECTION, 0, 0, NULL, "power", "", NULL, ANY, "power law"},
    {"radius", "table", PLS_KEY_PAIRS, 0, 0, NULL, NULL, "m", NULL, POSITIVE, "list of [radius, fraction by number]"},
    {"lognormal", "median", PLS_KEY_NUMBER, REQUIRED | OPEN, 0, NULL, NULL, "m", NULL, POSITIVE, "half of the radii are smaller"},
    {"lognormal", "sigma", PLS_KEY_NUMBER, REQUIRED | OPEN, 0, NULL, NULL, "", NULL, 0, 10, "standard deviation of ln r"},
    {"lognormal", "min", PLS_KEY_NUMBER, REQUIRED | OPEN, 0, NULL, NULL, "m", NULL, POSITIVE, "smaller radii are drawn again"},
    {"lognormal", "max", PLS_KEY_NUMBER, REQUIRED | OPEN, 0, NULL, NULL, "m", NULL, POSITIVE, "larger radii are drawn again"},
    {"power", "min", PLS_KEY_NUMBER, REQUIRED | OPEN, 0, NULL, NULL, "m", NULL, POSITIVE, "smallest radius"},
    {"power", "max", PLS_KEY_NUMBER, REQUIRED | OPEN, 0, NULL, NULL, "m", NULL, POSITIVE, "largest radius"},
    {"power", "exponent", PLS_KEY_NUMBER, REQUIRED, 0, NULL, NULL, "", NULL, -20, 20, "of the density over r"},
    {"box", "lower", PLS_KEY_VECTOR, REQUIRED, 0, NULL, NULL, "m", NULL, ANY, "lower corner"},
    {"box", "upper", PLS_KEY_VECTOR, REQUIRED, 0, NULL, NULL, "m", NULL, ANY, "upper corner"},
    {"csv", "file", PLS_KEY_PATH, REQUIRED, 0, NULL, NULL, "", NULL, ANY, "the table"},
    {"fill", "region", PLS_KEY_TEXT, REQUIRED, 0, NULL, NULL, "", NULL, ANY, "name of a shape: points lie in it"},
    {"fill", "spacing", PLS_KEY_NUMBER, REQUIRED | OPEN, 0, NULL, NULL, "m", NULL, POSITIVE, "distance of neighbours"},
    {"fill", "lattice", PLS_KEY_WORD, 0, 0, "cubic|hexagonal", NULL, "", "cubic", ANY,
     "cubic (2D: square), its first points half a spacing within the box around the region; or hexagonal close packing (2D: triangles)"},
    {"fill", "position", PLS_KEY_VECTOR, 0, 0, NULL, NULL, "m", "0", ANY, "of the origin of the region's own frame"},
    {"fill", "orientation", PLS_KEY_ORIENTATION, 0, 0, NULL, "turn", "", NULL, ANY,
     "the region's own frame, and the lattice with it, to the world: quaternion [w, x, y, z] or {axis, angle}; in 2D an angle [rad]"},
    {"fill", "where", PLS_KEY_CONDITION, 0, PLS_USES_PLACE, NULL, NULL, "", NULL, ANY,
     "points lie only where this is true, for example outside of a hole: \"x^2 + y^2 > 0.01\"; places in the world"},

    {"motion", "velocity", PLS_KEY_VECTOR, 0, PLS_USES_TIME, "free", NULL, "m/s", NULL, ANY, "velocity of the centre"},
    {"motion", "angular_velocity", PLS_KEY_SPIN, 0, PLS_USES_TIME, "free", NULL, "rad/s", NULL, ANY, "angular velocity"},
    {"motion", "about", PLS_KEY_VECTOR, 0, 0, NULL, NULL, "m", NULL, ANY, "the rotation also carries the body about this point"},
    {"motion", "displacement", PLS_KEY_VECTOR, 0, PLS_USES_TIME, "free", NULL, "m", NULL, ANY,
     "path of the centre relative to the start, in place of `velocity`"},
    {"turn", "axis", PLS_KEY_VECTOR3, 0, 0, NULL, NULL, "", NULL, ANY, "axis of the rotation, of any length; z in 2D"},
    {"turn", "angle", PLS_KEY_NUMBER, REQUIRED, 0, NULL, NULL, "rad", NULL, ANY, "angle"},

    {"part", "shape", PLS_KEY_TEXT, REQUIRED, 0, NULL, NULL, "", NULL, ANY, "name of a shape"},
    {"part", "position", PLS_KEY_VECTOR, 0, 0, NULL, NULL, "m", "0", ANY, "of its frame's origin in the frame of the compound"},
    {"part", "orientation", PLS_KEY_ORIENTATION, 0, 0, NULL, "turn", "", NULL, ANY,
     "its frame to that of the compound: quaternion [w, x, y, z] or {axis, angle}; in 2D an angle [rad]"},
    {"part", "scale", PLS_KEY_NUMBER, OPEN, 0, NULL, NULL, "", "1", POSITIVE, "multiplies its lengths"},

    {"contact", "between", PLS_KEY_NAMES, REQUIRED, 0, "all", NULL, "", NULL, ANY, "[material, material], or `all` for every pair"},
    {"contact", "law", PLS_KEY_TEXT, REQUIRED, 0, NULL, NULL, "", NULL, ANY, "name of a contact law"},
    {"contact", "lever", PLS_KEY_WORD, 0, 0, "contact_point|surface", NULL, "", "contact_point", ANY,
     "where the velocities of touching grains are taken: at the one point where the force acts (energy is booked exactly), or at each "
     "grain's own surface (P1 eq. 15b, LAMMPS)"},
    {"contact", "solver", PLS_KEY_WORD, 0, 0, "depth|admm", NULL, "", "depth", ANY,
     "overlap of shapes that are not spheres: the penetration depth, or P1 eq. 14 by ADMM (not conservative where edges and corners "
     "overlap; only for convex shapes and compounds of such, others are refused)"},
    {"contact", "faces", PLS_KEY_WORD, 0, 0, "auto|point|manifold|volume", NULL, "", "auto", ANY,
     "where faces lie on each other: the force acts at the deepest point (quickest; faces rattle), follows a smooth maximum of the "
     "overlap's "
     "thickness, or is the volume of the overlap times k / face_area, at its centre. `auto`: `manifold`; with `solver: admm` `point`"},
    {"contact", "face_area", PLS_KEY_NUMBER, OPEN, 0, NULL, NULL, "m^2", NULL, POSITIVE,
     "area over which the stiffness of the law acts with `faces: volume` (2D: length [m])"},
    {"contact", "tolerance", PLS_KEY_NUMBER, OPEN, 0, NULL, NULL, "", "1e-6", 0, 0.1,
     "of `solver: admm`: change of its iterates, part of the bodies' size"},

    {"bond", "name", PLS_KEY_NAME, 0, 0, NULL, NULL, "", NULL, ANY, "bonds_1, bonds_2, ... by default"},
    {"bond", "of", PLS_KEY_NAMES, REQUIRED, 0, "all", NULL, "", NULL, ANY, "list of body entries that are one continuum, or `all`"},
    {"bond", "law", PLS_KEY_TEXT, REQUIRED, 0, NULL, NULL, "", NULL, ANY,
     "name of a bond law: linear_solid, bond_based, elastic_plastic, viscoelastic_solid, beam, or a plugin's"},
    {"bond", "horizon", PLS_KEY_NUMBER, REQUIRED | OPEN, 0, NULL, NULL, "m", NULL, POSITIVE,
     "bonds join points no further apart at the start; about three spacings is usual"},
    {"bond", "influence", PLS_KEY_NUMBER, 0, PLS_USES_RADIUS, "inverse|one|conical|gaussian", NULL, "", "inverse", POSITIVE,
     "weight of a bond of length r in its family: horizon/r, 1, 1 - r/horizon, exp(-(r/horizon)^2), or an expression over r"},
    {"bond", "spacing", PLS_KEY_NUMBER, OPEN, 0, "auto|none", NULL, "m", "auto", POSITIVE,
     "over which the volume of a partner fades at the horizon, as its cell is cut; auto: the size of the points' cells; none: it does not "
     "fade"},
    {"bond", "correction", PLS_KEY_WORD, 0, 0, "none|volume|energy", NULL, "", "none", ANY,
     "for bonds that are missing at surfaces: each bond times 2 V0/(V_i + V_j), V the volume of a family; or each point's moduli so that a "
     "dilation stores what it stores inside"},
    {"bond", "plane", PLS_KEY_WORD, PLS_KEY_ONLY_2D, 0, "strain|stress", NULL, "", "strain", ANY, "what the plane stands for"},
    {"bond", "critical_stretch", PLS_KEY_NUMBER, OPEN, 0, NULL, NULL, "", NULL, POSITIVE,
     "bonds longer by more than this part break for good; without it, and without `fracture_energy`, none do"},
    {"bond", "fracture_energy", PLS_KEY_NUMBER, OPEN, 0, NULL, NULL, "J/m^2", NULL, POSITIVE,
     "G, energy per area of a crack, in place of `critical_stretch`, which follows"},
    {"bond", "criterion", PLS_KEY_WORD, 0, 0, "stretch|energy", NULL, "", "stretch", ANY,
     "what `fracture_energy` sets: the critical stretch of bonds, or the critical energy that a bond stores by its two volumes, in a "
     "continuum 4 G/(pi delta^4), in 2D 3 G/(2 h delta^3)"},
    {"bond", "stiffness", PLS_KEY_NUMBER, OPEN, OF_POINT, NULL, NULL, "", "1", POSITIVE,
     "times the moduli: an expression over the place of a point when bonds were made, its `temperature` (see `heat`), t, and `chance`, a "
     "number in (0, 1) that each body draws; a bond takes the mean of its "
     "two points"},
    {"bond", "toughness", PLS_KEY_NUMBER, OPEN, OF_POINT, NULL, NULL, "", "1", POSITIVE,
     "likewise, times what bonds withstand: the critical stretch or energy (which `fracture_energy` sets for a toughness of 1), or the "
     "strengths of "
     "beams. Weibull's: \"(-log(chance))^(1/6)\""},
    {"bond", "seed", PLS_KEY_INTEGER, 0, 0, NULL, NULL, "", "1", 0, 9007199254740992.0, "of `chance`"},
    {"bond", "heat", PLS_KEY_SECTION, 0, 0, NULL, "heat", "", NULL, ANY, "temperature of the points"},
    {"bond", "cracks", PLS_KEY_LIST, PLS_KEY_MAY_BE_EMPTY, 0, NULL, "crack", "", NULL, ANY, "cracks that are there from the start"},
    {"crack", "points", PLS_KEY_POINTS, 0, 0, NULL, NULL, "m", NULL, ANY,
     "2D: a line through these points; 3D: the corners of a flat convex polygon"},
    {"crack", "centre", PLS_KEY_VECTOR, 0, 0, NULL, NULL, "m", NULL, ANY, "3D: of a disc, in place of `points`"},
    {"crack", "normal", PLS_KEY_VECTOR, 0, 0, NULL, NULL, "", NULL, ANY, "of the disc"},
    {"crack", "radius", PLS_KEY_NUMBER, OPEN, 0, NULL, NULL, "m", NULL, POSITIVE, "of the disc"},

    {"heat", "conductivity", PLS_KEY_NUMBER, REQUIRED, 0, NULL, NULL, "W/(m K)", NULL, POSITIVE, "of the material, inside it"},
    {"heat", "capacity", PLS_KEY_NUMBER, REQUIRED | OPEN, 0, NULL, NULL, "J/(kg K)", NULL, POSITIVE, "heat capacity by mass"},
    {"heat", "expansion", PLS_KEY_NUMBER, 0, 0, NULL, NULL, "1/K", "0", ANY,
     "linear thermal expansion: strain of a free body by temperature"},
    {"heat", "initial", PLS_KEY_NUMBER, 0, PLS_USES_PLACE | PLS_USES_CHANCE, NULL, NULL, "K", "0", ANY, "temperature at the start"},
    {"heat", "reference", PLS_KEY_NUMBER, 0, 0, "initial", NULL, "K", "initial", ANY,
     "temperature at which bonds are as long as they were made; that of each point at the start by default"},
    {"heat", "source", PLS_KEY_NUMBER, 0, PLS_USES_TIME | PLS_USES_PLACE | PLS_USES_TEMPERATURE, NULL, NULL, "W/m^3", "0", ANY,
     "heat put in, by volume; through a surface with coefficient h, where it lies: \"x < dx ? h/dx*(293 - temperature) : 0\""},
    {"heat", "held", PLS_KEY_LIST, PLS_KEY_MAY_BE_EMPTY, 0, NULL, "held", "", NULL, ANY, "points whose temperature is given"},
    {"held", "temperature", PLS_KEY_NUMBER, REQUIRED, PLS_USES_TIME | PLS_USES_PLACE, NULL, NULL, "K", NULL, ANY, "it is kept at this"},
    {"held", "where", PLS_KEY_CONDITION, 0, PLS_USES_TIME | PLS_USES_PLACE, NULL, NULL, "", NULL, ANY,
     "of these points, by the place when bonds were made; all without it"},
    {"gravity", "gravity", PLS_KEY_VECTOR, REQUIRED, 0, NULL, NULL, "m/s^2", NULL, ANY, "acceleration of every free body"},
    {"field_force", "field", PLS_KEY_SECTION, REQUIRED, 0, NULL, "field", "", NULL, ANY, "a field of forces"},
    {"field", "force", PLS_KEY_VECTOR, 0, FIELD, NULL, NULL, "N", NULL, ANY, "force on a body"},
    {"field", "acceleration", PLS_KEY_VECTOR, 0, FIELD, NULL, NULL, "m/s^2", NULL, ANY, "force per mass"},
    {"field", "density", PLS_KEY_VECTOR, 0, FIELD, NULL, NULL, "N/m^3", NULL, ANY,
     "force per volume, which is mass by the density of the material"},
    {"field", "where", PLS_KEY_CONDITION, 0, FIELD, NULL, NULL, "", NULL, ANY,
     "the field acts only where this is true, for example \"z > 0.5 && t < 1\""},
    {"field", "bodies", PLS_KEY_TEXT, 0, 0, NULL, NULL, "", "all", ANY, "name of a body entry, or all"},
    {"traction_force", "traction", PLS_KEY_SECTION, REQUIRED, 0, NULL, "traction", "", NULL, ANY, "a force per area"},
    {"traction", "value", PLS_KEY_VECTOR, REQUIRED, PLS_USES_TIME | PLS_USES_PLACE, NULL, NULL, "Pa", NULL, ANY, "force per area"},
    FACE("traction"),
    {"pressure_force", "pressure", PLS_KEY_SECTION, REQUIRED, 0, NULL, "pressure", "", NULL, ANY, "a pressure"},
    {"pressure", "value", PLS_KEY_NUMBER, REQUIRED, PLS_USES_TIME | PLS_USES_PLACE, NULL, NULL, "Pa", NULL, ANY, "pressure"},
    {"pressure", "normal", PLS_KEY_VECTOR, REQUIRED, 0, NULL, NULL, "", NULL, ANY, "outward normal of the face, of any length"},
    FACE("pressure"),

    {"force_plugin", "NAME", PLS_KEY_PLUGIN, REQUIRED, 0, NULL, "plugin", "", NULL, ANY,
     "the plugin's name of the force; numbers may be expressions over t and states"},
    {"plugin", "bodies", PLS_KEY_TEXT, 0, 0, NULL, NULL, "", "all", ANY, "name of a body entry, or all"},

    {"state", "name", PLS_KEY_NAME, 0, 0, NULL, NULL, "", NULL, ANY,
     "name for expressions; required unless `radius` is given (then ENTRY_radius)"},
    {"state", "of", PLS_KEY_TEXT, 0, 0, NULL, NULL, "", "world", ANY, "its body: name of an entry, one of many as \"pack[12]\"; or world"},
    {"state", "index", PLS_KEY_INTEGER, 0, 0, "middle", NULL, "", NULL, 0, 4e9, "which body of an entry that holds many"},
    {"state", "each", PLS_KEY_BOOLEAN, 0, 0, NULL, NULL, "", "false", ANY,
     "one state for every body of the entry, named NAME_0, NAME_1, ..."},
    {"state", "initial", PLS_KEY_NUMBER, 0, 0, NULL, NULL, "", NULL, ANY, "value at the start; the body's own for targets, else 0"},
    {"state", "rate", PLS_KEY_NUMBER, 0, RATE, NULL, NULL, "", NULL, ANY,
     "ds/dt; may use t, s, x y z, vx vy vz, r of its body and other states"},
    {"state", "target", PLS_KEY_WORD, 0, 0, "none|radius|scale", NULL, "", "none", ANY, "what of the body follows the state"},
    {"state", "keep", PLS_KEY_WORD, 0, 0, "mass|density", NULL, "", "mass", ANY, "what stays when the size changes"},
    {"state", "radius", PLS_KEY_SECTION, 0, 0, NULL, "state_radius", "", NULL, ANY, "short form for a changing radius"},
    {"state_radius", "rate", PLS_KEY_NUMBER, REQUIRED, RATE, NULL, NULL, "m/s", NULL, ANY, "dr/dt"},
    {"state_radius", "initial", PLS_KEY_NUMBER, OPEN, 0, NULL, NULL, "m", NULL, POSITIVE, "radius at the start"},

    {"time", "end", PLS_KEY_NUMBER, REQUIRED | OPEN, 0, NULL, NULL, "s", NULL, POSITIVE, "the run ends here"},
    {"time", "dt", PLS_KEY_NUMBER, OPEN, 0, "auto", NULL, "s", "auto", POSITIVE, "time step; auto takes the stable step times `safety`"},
    {"time", "safety", PLS_KEY_NUMBER, OPEN, 0, NULL, NULL, "", "0.5", 0, 1, "fraction of the stable step"},
    {"time", "allow_unstable", PLS_KEY_BOOLEAN, 0, 0, NULL, NULL, "", "false", ANY, "accept a step above the estimated stable one"},
    {"time", "local_damping", PLS_KEY_NUMBER, 0, 0, NULL, NULL, "", "0", 0, 0.99,
     "part of each force that works against the motion of its body (Cundall 1987), to bring a world to rest; 0.7 or 0.8 is usual"},
    {"time", "relaxation", PLS_KEY_WORD, 0, 0, "none|adaptive", NULL, "", "none", ANY,
     "adaptive: all velocities decay as is critical for the motion there is (adaptive dynamic relaxation), to find states of rest under "
     "slow loads"},
    {"time", "coordination", PLS_KEY_INTEGER, 0, 0, NULL, NULL, "", NULL, 1, 1000,
     "contacts per body assumed by the estimate before they exist; 12, in 2D 6 by default"},

    {"neighbours", "skin", PLS_KEY_NUMBER, 0, 0, "auto", NULL, "m", "auto", POSITIVE, "Verlet skin; auto tunes itself"},
    {"neighbours", "reorder", PLS_KEY_BOOLEAN, 0, 0, NULL, NULL, "", "true", ANY, "keep bodies in memory along a space-filling curve"},

    {"guard", "max_overlap", PLS_KEY_NUMBER, OPEN, 0, NULL, NULL, "", "1", POSITIVE,
     "stop when an overlap, of two bodies or with a wall, exceeds this fraction of the smaller radius (at a wall: the body's)"},

    {"observe_collection", "collection", PLS_KEY_TEXT, REQUIRED, 0, NULL, NULL, "", NULL, ANY, "name of a body entry, or all"},
    {"observe_collection", "quantities", PLS_KEY_WORDS, 0, 0, "stress|tangent|fabric|coordination|energy|momentum|porosity|mass|fragments",
     NULL, "", "stress coordination energy", ANY, "what is measured"},
    {"observe_collection", "volume", PLS_KEY_NUMBER, OPEN, 0, "bounding_box|periodic", "volume", "m^3", "bounding_box", POSITIVE,
     "volume of the average; {box: ...} also picks the bodies and contacts inside"},
    {"observe_collection", "walls", PLS_KEY_BOOLEAN, 0, 0, NULL, NULL, "", "true", ANY,
     "count contacts with unbounded bodies in stress, tangent and fabric"},
    SCHEDULE("observe_collection"),
    {"observe_particle", "particle", PLS_KEY_TEXT, REQUIRED, 0, NULL, NULL, "", NULL, ANY,
     "name of a body entry, or all; each of its bodies has its columns"},
    {"observe_particle", "quantities", PLS_KEY_NAMES, 0, 0, NULL, NULL, "", "position velocity force", ANY, "body fields"},
    SCHEDULE("observe_particle"),
    {"observe_frames", "frames", PLS_KEY_WORD, REQUIRED, 0, "vtk", NULL, "", NULL, ANY, "file format"},
    {"observe_frames", "fields", PLS_KEY_NAMES, PLS_KEY_MAY_BE_EMPTY, 0, NULL, NULL, "", NULL, ANY, "body fields besides the usual ones"},
    {"observe_frames", "contacts", PLS_KEY_BOOLEAN, 0, 0, NULL, NULL, "", "false", ANY, "write contacts as lines as well"},
    SCHEDULE("observe_frames"),
    {"observe_checkpoint", "checkpoint", PLS_KEY_SECTION, REQUIRED, 0, NULL, "checkpoint", "", NULL, ANY, "when"},
    {"observe_plugin", "NAME", PLS_KEY_PLUGIN, REQUIRED, 0, NULL, "plugin", "", NULL, ANY, "the plugin's name of the observer"},
    SCHEDULE("observe_plugin"),
    {"checkpoint", "every", PLS_KEY_NUMBER, OPEN, 0, NULL, NULL, "s", NULL, POSITIVE, "time between checkpoints"},
    {"checkpoint", "every_steps", PLS_KEY_INTEGER, 0, 0, NULL, NULL, "", NULL, 1, 1e15, "steps between checkpoints"},
    {"volume", "box", PLS_KEY_SECTION, REQUIRED, 0, NULL, "box", "", NULL, ANY, "a box"},
};

const pls_section *pls_schema_sections(size_t *count)
{
    *count = sizeof sections / sizeof *sections;
    return sections;
}

const pls_key *pls_schema_keys(const char *section, size_t *count)
{
    size_t all = sizeof keys / sizeof *keys, first = 0;
    while (first < all && strcmp(keys[first].section, section) != 0) ++first;
    size_t end = first;
    while (end < all && strcmp(keys[end].section, section) == 0) ++end;
    *count = end - first;
    return &keys[first];
}

pls_key pls_schema_parameter(const pls_parameter *parameter, unsigned uses, char initial[32])
{
    bool required = isnan(parameter->initial);
    return (pls_key){.section = "",
                     .name = parameter->name,
                     .type = parameter->components == 3 ? PLS_KEY_VECTOR3 : PLS_KEY_NUMBER,
                     .flags = (required ? PLS_KEY_REQUIRED : 0U) | (parameter->open_minimum ? PLS_KEY_OPEN_MINIMUM : 0U),
                     .uses = uses,
                     .unit = parameter->unit ? parameter->unit : "",
                     .initial = required ? NULL : pls_format_double(initial, parameter->initial),
                     .minimum = parameter->minimum,
                     .maximum = parameter->maximum,
                     .meaning = parameter->meaning ? parameter->meaning : ""};
}

/// What is no number has neither range nor default.
static pls_key other_parameter(const pls_parameter *parameter)
{
    static const pls_key_type types[] = {[PLS_PARAMETER_POINTS] = PLS_KEY_POINTS,
                                         [PLS_PARAMETER_FLAT_POINTS] = PLS_KEY_PAIRS,
                                         [PLS_PARAMETER_PATH] = PLS_KEY_PATH,
                                         [PLS_PARAMETER_SHAPES] = PLS_KEY_LIST};
    return (pls_key){.section = "",
                     .name = parameter->name,
                     .type = types[parameter->kind],
                     .flags = isnan(parameter->initial) ? PLS_KEY_REQUIRED : 0U,
                     .sub = parameter->kind == PLS_PARAMETER_SHAPES ? "part" : NULL,
                     .unit = parameter->unit ? parameter->unit : "",
                     .minimum = -INFINITY,
                     .maximum = INFINITY,
                     .meaning = parameter->meaning ? parameter->meaning : ""};
}

pls_key pls_schema_parameter_of(pls_table_owner owner, const pls_parameter *parameter, char initial[32])
{
    if (owner == PLS_OF_SHAPE && parameter->kind != PLS_PARAMETER_NUMBER) return other_parameter(parameter);
    bool timely = owner == PLS_OF_LAW || owner == PLS_OF_FORCE;
    pls_key key = pls_schema_parameter(parameter, timely ? PLS_USES_TIME | PLS_USES_STATES : 0, initial);
    if (owner != PLS_OF_LAW && key.type == PLS_KEY_VECTOR3) key.type = PLS_KEY_VECTOR;
    return key;
}

void pls_schema_range(const pls_key *key, char text[128])
{
    char lower[32], upper[32];
    pls_format_double(lower, key->minimum);
    pls_format_double(upper, key->maximum);
    const char *least = key->flags & PLS_KEY_OPEN_MINIMUM ? "greater than" : "at least";
    if (isfinite(key->minimum) && key->minimum == key->maximum)
        snprintf(text, 128, "%s", lower);
    else if (isfinite(key->minimum) && isfinite(key->maximum))
        snprintf(text, 128, "%s %s and at most %s", least, lower, upper);
    else if (isfinite(key->minimum))
        snprintf(text, 128, "%s %s", least, lower);
    else
        snprintf(text, 128, "at most %s", upper);
}

bool pls_schema_word(const char *words, size_t k, char word[64])
{
    const char *at = words;
    for (; at && k > 0; --k)
    {
        at = strchr(at, '|');
        if (at) ++at;
    }
    if (!at || !*at) return false;
    size_t size = strcspn(at, "|");
    if (size > 63) size = 63;
    memcpy(word, at, size);
    word[size] = '\0';
    return true;
}

bool pls_schema_has_word(const char *words, const char *text)
{
    char word[64];
    for (size_t k = 0; words && pls_schema_word(words, k, word); ++k)
    {
        if (strcmp(word, text) == 0) return true;
    }
    return false;
}
