// small_scene.h -- a scene with all that a checkpoint must carry (sliding contacts, a driven wall, a state, series, frames) that runs in a blink.
#ifndef PLS_TESTS_SUPPORT_SMALL_SCENE_H
#define PLS_TESTS_SUPPORT_SMALL_SCENE_H

#include "base/atomic_file.h"

#include <particls/scene.h>
#include <string.h>

static const char small_scene_text[] =
    "particls: 1\n"
    "title: a few \"falling\" spheres\n"
    "materials:\n"
    "  grain: {density: 1000}\n"
    "shapes:\n"
    "  ball: {sphere: {radius: 0.05}}\n"
    "  wall: {plane: {}}\n"
    "bodies:\n"
    "  - {name: pack, shape: ball, material: grain, velocity: [0.3, 0.1, -1], place: {hex_pack: {count: [3, 3, 3], corner: [0, 0, "
    "0.01]}}}\n"
    "  - {name: floor, shape: wall, material: grain, position: [0, 0, 0], normal: [0, 0, 1]}\n"
    "  - {name: pusher, shape: wall, material: grain, position: [-0.01, 0, 0], normal: [1, 0, 0], motion: {velocity: [0.5, 0, 0]}}\n"
    "contact:\n"
    "  - {between: [grain, grain], law: viscoelastic, kn: 20000, ks: 10000, cn: 4, cs: 2, friction: 0.4}\n"
    "forces:\n"
    "  - {gravity: [0, 0, -9.81]}\n"
    "states:\n"
    "  - {of: pack, index: 0, radius: {rate: \"0.01 * cos(5 * t)\"}}\n"
    "time: {end: 0.1, dt: 1.0e-4}\n"
    "observe:\n"
    "  - {collection: all, name: heap, quantities: [stress, coordination, energy], every: 0.002}\n"
    "  - {particle: pusher, name: pusher, quantities: [position, force], every_steps: 7}\n"
    "  - {frames: vtk, name: picture, every: 0.02, contacts: true}\n"
    "  - {checkpoint: {every: 0.025}}\n";

/// Write and read it; `override` may be null.
static inline pls_status small_scene_load(const char *override, pls_scene **scene)
{
    PLS_TRY(pls_write_file("small.yaml", small_scene_text, strlen(small_scene_text)));
    return pls_scene_load("small.yaml", &override, override ? 1 : 0, scene);
}

#endif
