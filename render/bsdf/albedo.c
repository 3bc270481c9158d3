#include "render/bsdf/albedo.h"

/* cos θ at a grazing coordinate: the inverse of albedo_grazing_coordinate. */
static double grazing_mu(double t, double alpha) {
    double s = t * t;
    return alpha * s / (1 + alpha - s);
}

/* 2 ∫ E(mu) mu dmu over one row of nodes, E linear in t: midpoints, fine enough to be exact in float. */
static float mean_of_row(const float *row, double alpha) {
    enum { STEPS = 32 };
    double sum = 0, before = 0;
    for (int i = 0; i + 1 < ALBEDO_GRAZING; i++)
        for (int k = 1; k <= STEPS; k++) {
            double mid = (i + (k - 0.5) / STEPS) / (ALBEDO_GRAZING - 1);
            double mu = grazing_mu((i + (double)k / STEPS) / (ALBEDO_GRAZING - 1), alpha);
            double value = row[i] + (mid * (ALBEDO_GRAZING - 1) - i) * (row[i + 1] - row[i]);
            sum += value * (mu * mu - before * before);
            before = mu;
        }
    return (float)sum;
}

void albedo_make_slice(float eta, float slice[ALBEDO_SLICE_FLOATS]) {
    float x = (eta - 1.0f) / (eta + 1.0f);
    float k = copysignf(sqrtf(fminf(fabsf(x) / ALBEDO_X_MAX, 1.0f)), x);
    albedo_node node = albedo_node_of(0.5f * (k + 1.0f), ALBEDO_IORS);
    const float *low = albedo_interface_table + (size_t)node.index * ALBEDO_SLICE, *high = low + ALBEDO_SLICE;
    for (int i = 0; i < ALBEDO_SLICE; i++) slice[i] = low[i] + node.fraction * (high[i] - low[i]);
    for (int j = 0; j < ALBEDO_ROUGHNESS; j++)
        slice[ALBEDO_SLICE + j] = mean_of_row(slice + j * ALBEDO_GRAZING, albedo_row_alpha(j));
}
