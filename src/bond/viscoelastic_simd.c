// viscoelastic_simd.c -- the loops of the viscoelastic solid (viscoelastic.c has the formulas).

#include "bond/family_sums.h"
#include "bond/viscoelastic.h"

void PLS_SIMD(pls_viscous_pull)(const pls_family_batch *batch)
{
    const double theta = pls_family_dilatation(batch), a = batch->constants[PLS_VISCOUS_DILATION],
                 b = batch->constants[PLS_VISCOUS_EXTENSION] / batch->weighted, whole = a * theta / batch->weighted,
                 relaxing = batch->constants[PLS_VISCOUS_PART];
    const double *dashpot = batch->memory[PLS_VISCOUS_DASHPOT];
    pls_vd sum[PLS_FAMILY_PARTS] = {0};
    for (size_t k = 0; k < batch->count; k += PLS_BOND_VECTOR)
        for (size_t part = 0; part < PLS_FAMILY_PARTS; ++part)
        {
            const size_t at = k + part * PLS_W;
            const pls_vd e = pls_vd_load(batch->extension + at), p = pls_vd_load(dashpot + at), spring = e - p;
            const pls_vd stiff = pls_family_stiffness(batch, at);
            sum[part] = sum[part] + stiff * ((1.0 - relaxing) * e * e + relaxing * spring * spring);
            pls_vd_store(batch->tension + at, whole * pls_vd_load(batch->weight + at) + b * stiff * (e - relaxing * p));
        }
    *batch->energy = 0.5 * (batch->volume * a * theta * theta / (double)batch->dimension + b * pls_lanes_sum(sum));
}

void PLS_SIMD(pls_viscous_advance)(const pls_family_batch *batch)
{
    const double b = batch->constants[PLS_VISCOUS_EXTENSION] / batch->weighted, relaxing = batch->constants[PLS_VISCOUS_PART],
                 mean = pls_family_mean(batch), even = 0.5 * (mean + batch->point_memory[0]);
    const double time = batch->step / batch->constants[PLS_VISCOUS_TIME], left = exp(-time), kept = time > 0.0 ? -expm1(-time) / time : 1.0;
    double *dashpot = batch->memory[PLS_VISCOUS_DASHPOT], *before = batch->memory[PLS_VISCOUS_DEVIATOR];
    pls_vd sum[PLS_FAMILY_PARTS] = {0};
    batch->point_memory[0] = mean;
    for (size_t k = 0; k < batch->count; k += PLS_BOND_VECTOR)
        for (size_t part = 0; part < PLS_FAMILY_PARTS; ++part)
        {
            const size_t at = k + part * PLS_W;
            const pls_vd now = pls_family_deviator(batch, at, mean), then = pls_vd_load(before + at), p = pls_vd_load(dashpot + at);
            const pls_vd spring = then - p, sprung = left * spring + kept * (now - then), moved = now - sprung - p;
            const pls_vd elastic = 0.5 * (spring + sprung) + even * pls_vd_load(batch->reference + at);
            sum[part] = sum[part] + pls_family_stiffness(batch, at) * elastic * moved;
            pls_vd_store(dashpot + at, now - sprung);
            pls_vd_store(before + at, now);
        }
    *batch->spent = relaxing * b * pls_lanes_sum(sum);
}
