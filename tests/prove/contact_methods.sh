#!/usr/bin/env bash
# The two ways of finding contacts compared: writes docs/contact-detection.md and docs/figures/contact-energy.svg. Builds nothing.
#
#     tests/prove/contact_methods.sh [build folder]        build/release by default
#     PARTICLS_COLLISIONS                                  of each pair of shapes, 100 by default
#
# Exit status 1 when the penetration depth does not keep energy as it should; the page is written all the same.
set -euo pipefail

root=$(cd "$(dirname "$0")/../.." && pwd)
program=${1:-$root/build/release}/tests/prove/contact_methods
figures=$root/docs/figures
page=$root/docs/contact-detection.md

[ -x "$program" ] || { echo "contact_methods.sh: $program is missing: run make build first" >&2; exit 2; }
command -v gnuplot >/dev/null || { echo "contact_methods.sh: gnuplot is missing: apt-get install gnuplot-nox" >&2; exit 2; }

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$figures"

status=0
OMP_WAIT_POLICY=passive "$program" "$scratch" "${PARTICLS_COLLISIONS:-100}" || status=$?
[ "$status" -le 1 ] || { echo "contact_methods.sh: $program failed" >&2; exit "$status"; }
gnuplot -e "data='$scratch'; out='$figures'" "$root/tests/prove/contact_methods.gp"
. "$scratch/numbers"

{
    cat <<TEXT
# Contact detection: penetration depth and P1's eq. 14

When two grains overlap, a contact law needs to know how deep, in which direction and where. There are two answers, chosen per pair of materials
(\`contact: {solver: depth}\`, the default, or \`admm\`). This page says what they are, when they agree, and why the default is what it is. All numbers are measured by \`tests/prove/contact_methods.c\`;
\`make prove\` writes the page.

**Penetration depth.** The shortest way by which one grain has to be moved until both only touch. Its length is the overlap, its direction the normal. Each kind of shape has a solver of its own
(\`src/contact/narrow_phase.c\`).

**P1 eq. 14** (Davis et al., ParticLS, 2021, section 3). The point x1 of grain A that lies deepest in B, and the point x2 of B that lies deepest in A; the overlap is the length of xi = x2 - x1, and the force acts along it.
It asks nothing of a shape but its signed distance, through nearest points and the proximal map, and is solved by ADMM (\`src/contact/admm.c\`). Eq. 14 is two problems that know nothing of each other, one per point.

## In short

* **In a gap both are the same**: the distance and the closest points (\`tests/contact/test_admm.c\`).
* **Where the surfaces that overlap are smooth both are the same**: the foot of the deepest point of A is the deepest point of B. So for spheres, ellipsoids, superquadrics, capsules, and rounded edges that overlap by less than their rounding.
* **Where edges or corners overlap they are not.** There the deepest point is as far from two or three faces at once, and nothing ties x1 to x2. |xi| is more than the depth: box on box by a factor of $box_box_ratio
  in the median, and its direction is off by $box_box_angle degrees (95 % of poses: less than $box_box_angle_far).
* **So a force along xi does not conserve energy**, at any time step: there is no potential of which it is the gradient. A frictionless, undamped collision changes the kinetic energy by $box_box_median %
  box on box (median), $polyhedron_polyhedron_median % polyhedron on polyhedron, $rectangle_rectangle_median % in 2D rectangle on rectangle. The depth is the gradient of its own potential: pushing one grain along
  the normal by a small way changes the depth by just that way, and a small turn by what the torque at the contact's point says. It keeps energy to $box_box_depth_median (box on box, median), which is the second-order error of the time step.
* \`admm\` is for convex shapes and compounds of such: a scene in which others might touch under it is refused.
* Use \`admm\` to repeat P1's simulations, and for smooth shapes known by nothing but a proximal map. With enough damping its errors of energy may not matter; the error of the direction does.

## Depth and direction

$poses random poses of each pair, overlapping by 0.1 to 5 % of the size (of the smaller bounding radius). Angles in degrees. ADMM to a tolerance of 1e-8. *Not solved*: more than 1000 iterations.

TEXT
    cat "$scratch/depths.md"
    cat <<TEXT

## Energy

Every pair of built-in shapes of 3D, the main ones of 2D, and a cone of which nothing is known but its signed distance (*SDF only*). $collisions collisions of each pair (a fifth where queries take long) without friction and damping: a linear spring, 800 steps per contact (half a period of the spring with the mass that a push at the first touch moves), a stiffness at which a central impact overlaps by 2 % of the size, both grains spinning, random turns and offsets; velocity Verlet
(\`tests/support/two_bodies.c\`; the compound, two boxes and a ball, by the library's own step, where it is decided which contacts of parts act). The same collisions for all: *default*, the depth, and where faces or lines lie on each other the force by all of them (\`faces: manifold\`); the *deepest point* alone (\`faces: point\`);
*eq. 14*. Queries that ADMM does not solve in 1000 iterations are answered by the depth, as in simulations. Numbers are |energy after / energy before - 1|. By default at most 1e-5 (median) and 2e-3 (worst) are allowed; pairs outside of that: $outside of $pairs. *Not solved* counts queries of the depth and of eq. 14: ADMM then circles slowly where an edge of one grain is nearly parallel to a ridge of the other's
distance.

![Change of energy by pair of shapes](figures/contact-energy.svg)

*Blue: default, grey: the deepest point alone, red: eq. 14. Marks are medians, lines reach to the worst.*

TEXT
    cat "$scratch/energies.md"
    cat <<TEXT

The worst collisions with the deepest point are those where faces land nearly flat: it jumps from one end of the face to the other within a step, which is an error of first order in the time step, where all others are of second order. That is why by default the face counts as a whole. Box on plane:

TEXT
    cat "$scratch/steps.md"
    cat <<TEXT

## Iterations of ADMM

Median (95th percentile) of the slower of the two problems. *Cold*: nothing known. *Warm*: along paths on which a grain moves by 1e-4 of its size and turns by 1e-4 rad per step, evenly, as in a simulation with some hundred steps per contact.
What is remembered is each point with its multiplier, in its body's frame, and how both changed in the last step. Tolerances are parts of the size. The last column is of the collisions above, where contacts begin, end and jump.

P1 says that the last step's solution as a start "often leads to convergence in 1-2 iterations". *Warm, in 1-2* is the part of the queries of which that is so. For smooth shapes it is; with corners it depends on the path, as a point
that passes from an edge to the next starts anew.

TEXT
    cat "$scratch/iterations.md"
    cat <<TEXT

## Nearly parallel faces

Box on box, 1 % of the size deep, tilted: the deepest points are at corners, far along the faces from where the search for them starts. ADMM's points move there evenly, by some tilt times its step per iteration, and would take
about 1 / tilt iterations; as it doubles the step while they move evenly, it takes a number that grows as the logarithm. At a tolerance above the tilt it stops at once, somewhere on the face: the depth is good then, the points are not.

TEXT
    cat "$scratch/tilts.md"
} >"$page"
echo "$page"
exit "$status"
