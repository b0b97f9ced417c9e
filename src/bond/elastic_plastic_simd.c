// elastic_plastic_simd.c -- the loops of the elastic-plastic solid (elastic_plastic.c has the formulas).

#include "bond/elastic_plastic.h"
#include "bond/family_sums.h"

void PLS_SIMD(pls_plastic_pull)(const pls_family_batch *batch)
{
    const double theta = pls_family_dilatation(batch), a = batch->constants[PLS_PLASTIC_DILATION],
                 b = batch->constants[PLS_PLASTIC_EXTENSION] / batch->weighted, whole = a * theta / batch->weighted;
    const double *plastic = batch->memory[0];
    pls_vd sum[PLS_FAMILY_PARTS] = {0};
    for (size_t k = 0; k < batch->count; k += PLS_BOND_VECTOR)
        for (size_t part = 0; part < PLS_FAMILY_PARTS; ++part)
        {
            const size_t at = k + part * PLS_W;
            const pls_vd elastic = pls_vd_load(batch->extension + at) - pls_vd_load(plastic + at);
            const pls_vd stiff = pls_family_stiffness(batch, at) * elastic;
            sum[part] = sum[part] + stiff * elastic;
            pls_vd_store(batch->tension + at, whole * pls_vd_load(batch->weight + at) + b * stiff);
        }
    *batch->energy = 0.5 * (batch->volume * a * theta * theta / (double)batch->dimension + b * pls_lanes_sum(sum));
}

void PLS_SIMD(pls_plastic_advance)(const pls_family_batch *batch)
{
    const double mu = batch->constants[PLS_PLASTIC_SHEAR], hardening = batch->constants[PLS_PLASTIC_HARDENING],
                 b = batch->constants[PLS_PLASTIC_EXTENSION] / batch->weighted,
                 third = pls_family_dilatation(batch) / (double)batch->dimension;
    double *plastic = batch->memory[0];
    pls_vd sum[PLS_FAMILY_PARTS] = {0};
    for (size_t k = 0; k < batch->count; k += PLS_BOND_VECTOR)
        for (size_t part = 0; part < PLS_FAMILY_PARTS; ++part)
        {
            const size_t at = k + part * PLS_W;
            const pls_vd trial = pls_family_deviator(batch, at, third) - pls_vd_load(plastic + at);
            sum[part] = sum[part] + pls_family_stiffness(batch, at) * trial * trial;
        }
    const double q = sqrt(3.0 * mu * b * pls_lanes_sum(sum) / batch->volume);
    const double yield = batch->constants[PLS_PLASTIC_YIELD] + hardening * batch->point_memory[0];
    if (!(q > yield)) return;
    const double grown = (q - yield) / (3.0 * mu + hardening), part_of = 3.0 * mu * grown / q;
    batch->point_memory[0] += grown;
    *batch->spent = batch->volume * (yield + 0.5 * hardening * grown) * grown;
    for (size_t at = 0; at < batch->count; at += PLS_W)
    {
        const pls_vd held = pls_vd_load(plastic + at);
        pls_vd_store(plastic + at, held + part_of * (pls_family_deviator(batch, at, third) - held));
    }
}
