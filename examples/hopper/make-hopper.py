#!/usr/bin/env python3
"""Make hopper.obj: a cylinder above a cone that ends in a round opening, open at both ends. Lengths in metres, z upwards, the opening at z = 0."""
import math

SIDES = 32
RADIUS = 0.095            # of the cylinder
OPENING = 0.035           # radius of the opening
HALF_ANGLE = math.pi / 4  # of the cone, from the vertical
TOP = 0.65                # upper rim of the cylinder

cone_top = (RADIUS - OPENING) / math.tan(HALF_ANGLE)
rings = [(OPENING, 0), (RADIUS, cone_top), (RADIUS, TOP)]

with open("hopper.obj", "w") as obj:
    obj.write("# made by make-hopper.py\n")
    for radius, z in rings:
        # corners outside the circle, so that the sides have its area
        outer = radius * math.sqrt(2 * math.pi / SIDES / math.sin(2 * math.pi / SIDES))
        for k in range(SIDES):
            angle = 2 * math.pi * k / SIDES
            obj.write(f"v {outer * math.cos(angle):.6f} {outer * math.sin(angle):.6f} {z:.6f}\n")
    for ring in range(len(rings) - 1):
        for k in range(SIDES):
            a, b = ring * SIDES + k + 1, ring * SIDES + (k + 1) % SIDES + 1
            obj.write(f"f {a} {b} {b + SIDES}\nf {a} {b + SIDES} {a + SIDES}\n")
