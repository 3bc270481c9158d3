#include "render/predict.h"

#include <math.h>

/* Samples a pixel with which the error is below a goal; it is looked at after powers of two alone. */
static double samples_for(const predict_pilot *p, double goal) {
    double needed = p->error > goal ? p->spp * pow(p->error / goal, 2) * p->gain : p->spp;
    return fmax(exp2(ceil(log2(needed))), p->spp);
}

static double error_at(const predict_pilot *p, double spp) {
    return spp > p->spp ? p->error * sqrt(p->spp / spp * p->gain) : p->error;
}

kiln_prediction predict(const predict_pilot *p, const kiln_render_options *o, uint32_t spp_limit) {
    double each = p->seconds / p->spp, most = o->spp ? (double)spp_limit : INFINITY;
    kiln_prediction r = {.spp = p->spp, .noise_seconds = -1};
    if (o->budget_seconds > 0) most = fmin(most, o->budget_seconds / each);
    double end = most;
    if (o->noise > 0) {
        double needed = samples_for(p, o->noise);
        r.noise_seconds = needed * each;
        end = fmin(end, needed);
    }
    r.seconds = end * each;
    r.error = error_at(p, end);
    return r;
}
