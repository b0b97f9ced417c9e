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
    const double mu = batch->constants[PLS_PLASTIC_SHEAR], hardening = batch->constants[PLS_PLASTIC_HARDENING] / batch->stiffness,
                 b = batch->constants[PLS_PLASTIC_EXTENSION] / batch->weighted, mean = pls_family_mean(batch),
                 before = batch->point_memory[PLS_PLASTIC_MEAN];
    double *plastic = batch->memory[0];
    pls_vd sum[PLS_FAMILY_PARTS] = {0};
    batch->point_memory[PLS_PLASTIC_MEAN] = mean;
    for (size_t k = 0; k < batch->count; k += PLS_BOND_VECTOR)
        for (size_t part = 0; part < PLS_FAMILY_PARTS; ++part)
        {
            const size_t at = k + part * PLS_W;
            const pls_vd trial = pls_family_deviator(batch, at, mean) - pls_vd_load(plastic + at);
            sum[part] = sum[part] + pls_family_stiffness(batch, at) * trial * trial;
        }
    const double q = sqrt(3.0 * mu * b * pls_lanes_sum(sum) / batch->volume);
    const double yield = batch->constants[PLS_PLASTIC_YIELD] / batch->stiffness + hardening * batch->point_memory[PLS_PLASTIC_STRAIN];
    if (!(q > yield)) return;
    const double grown = (q - yield) / (3.0 * mu + hardening), part_of = 3.0 * mu * grown / q;
    batch->point_memory[PLS_PLASTIC_STRAIN] += grown;
    // Mean tension of the step times the flow: of the deviator, which was shorter by the hardening, and of the even part, whose work vanishes where nothing is corrected.
    const double shorter = 0.5 * (1.0 + yield / (yield + hardening * grown)), even = 0.5 * (mean + before);
    pls_vd work[PLS_FAMILY_PARTS] = {0};
    for (size_t k = 0; k < batch->count; k += PLS_BOND_VECTOR)
        for (size_t part = 0; part < PLS_FAMILY_PARTS; ++part)
        {
            const size_t at = k + part * PLS_W;
            const pls_vd held = pls_vd_load(plastic + at), trial = pls_family_deviator(batch, at, mean) - held, flow = part_of * trial;
            const pls_vd elastic = shorter * (trial - flow) + even * pls_vd_load(batch->reference + at);
            work[part] = work[part] + pls_family_stiffness(batch, at) * elastic * flow;
            pls_vd_store(plastic + at, held + flow);
        }
    *batch->spent = b * pls_lanes_sum(work);
}
