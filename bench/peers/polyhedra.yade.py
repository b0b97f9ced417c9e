# A heap of polyhedra in Yade, as bench/polyhedra.c wrote it: STATE=file STEPS=20 yade -j1 -n -x polyhedra.yade.py
# Prints one line of JSON. The first step, which makes the list of pairs, is not timed.
import json
import os
import time

from yade import polyhedra_utils

with open(os.environ["STATE"]) as state:
    side, stiffness, friction, density, gravity, dt = map(float, state.readline().split())
    grains = [list(map(float, line.split())) for line in state]
steps = int(os.environ.get("STEPS", "20"))

# Yade takes E_a E_b / (E_a + E_b) for the stiffness of a contact.
rock = PolyhedraMat(density=density, young=2 * stiffness, poisson=0.5, frictionAngle=math.atan(friction))
O.materials.append(rock)
for numbers in grains:
    corners = [Vector3(*numbers[k:k + 3]) for k in range(0, len(numbers), 3)]
    O.bodies.append(polyhedra_utils.polyhedra(rock, v=corners))
for axis in (0, 1):
    O.bodies.append(utils.wall(0, axis=axis, sense=1, material=rock))
    O.bodies.append(utils.wall(side, axis=axis, sense=-1, material=rock))
O.bodies.append(utils.wall(0, axis=2, sense=1, material=rock))

O.dt = dt
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Polyhedra_Aabb(), Bo1_Wall_Aabb()], verletDist=0.02),
    InteractionLoop([Ig2_Polyhedra_Polyhedra_PolyhedraGeom(), Ig2_Wall_Polyhedra_PolyhedraGeom()],
                    [Ip2_PolyhedraMat_PolyhedraMat_PolyhedraPhys()], [Law2_PolyhedraGeom_PolyhedraPhys_Volumetric()]),
    NewtonIntegrator(damping=0, gravity=(0, 0, -gravity)),
]
O.run(1, True)
start = time.process_time()  # of the processor, as in polyhedra.c
O.run(steps, True)
spent = time.process_time() - start
real = [i for i in O.interactions if i.isReal and i.geom.penetrationVolume > 0]
print(json.dumps({
    "bodies": len(grains), "corners": len(O.bodies[0].shape.v), "steps": steps, "threads": 1, "cpu_s": round(spent, 6),
    "particle_steps_per_s": round(len(grains) * steps / spent, 3), "touching": len(real), "stiffness": real[0].phys.kn if real else None,
    "overlap_m3": sum(i.geom.penetrationVolume for i in real)}), flush=True)
os._exit(0)
