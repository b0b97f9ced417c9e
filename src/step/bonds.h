// bonds.h -- sets of bonds of a world: made, stepped, asked.
#ifndef PLS_STEP_BONDS_H
#define PLS_STEP_BONDS_H

#include "step/world.h"

/// The three parts of a step of length dt (0: the start), for blocks of points shared by threads: positions taken; what families are asked, dilatations or tensions; forces. Between them all threads have to wait, and one looks after the whole.
pls_status pls_bonds_place(pls_world *world, double dt, int thread, int threads);
void pls_bonds_placed(pls_world *world);
pls_status pls_bonds_dilate(pls_world *world, double dt, int thread, int threads);
void pls_bonds_dilated(pls_world *world);
void pls_bonds_act(pls_world *world, int thread, int threads);
/// Bonds stretched too far break, and the contacts of their bodies are free to touch.
void pls_bonds_acted(pls_world *world);
/// Whether some set asks families or conducts heat.
bool pls_bonds_dilate_at_all(const pls_world *world);

/// Whether a bond between two bodies, by their numbers, holds.
bool pls_bonds_hold(const pls_world *world, uint32_t a, uint32_t b);
/// What bonds add to the stiffness of a body, by its number, against translation or rotation: a bound of the largest eigenvalue of M^-1 K of the sets it is in, as they were made [1/s^2].
double pls_bonds_rate(const pls_world *world, uint32_t number, bool of_rotation);
/// The longest step that is stable for heat in bonds, and the set that sets it (`name` stays where there is no heat); infinite: none [s].
double pls_bonds_heat_step(const pls_world *world, const char **name);
/// Add, by numbers of bodies, the energies that their families store and that bonds held when they broke [J].
void pls_bonds_energies(const pls_world *world, double *stored, double *broken);
/// Damage of a body as its sets have it now.
void pls_bonds_note_damage(pls_world *world, uint32_t number);
/// By numbers of bodies, `numbers` of them: the lowest number of those that bonds hold together with it, its own where nothing holds it; PLS_NO_FRAGMENT for bodies without families.
#define PLS_NO_FRAGMENT UINT32_MAX
void pls_bonds_fragments(const pls_world *world, uint32_t *fragment);
/// Bonds of either direction of all sets, and their points.
size_t pls_bonds_count(const pls_world *world);
size_t pls_bonds_points(const pls_world *world);
/// Numbers that laws of bonds remember.
size_t pls_bonds_remembered(const pls_world *world);
/// What was restored is brought into what follows from it.
pls_status pls_bonds_restored(pls_world *world);
/// Break all bonds of a body that is about to leave the world.
void pls_bonds_leave(pls_world *world, uint32_t number);
void pls_bonds_free(pls_world *world);

#endif
