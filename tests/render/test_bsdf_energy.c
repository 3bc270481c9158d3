/* What the BSDF gives back of what it gets: reciprocity, directional albedos, and finite numbers whatever is asked.
 *
 * The test prints a table of albedos, and the largest of all. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/fmath.h"
#include "tests/render/bsdf_chart.h"
#include "tests/render/statistics.h"

/* On rows of the albedo tables, and mostly between. */
static const float roughnesses[] = {0,     0.0101f, 0.02f, 0.035f, 0.05f, 0.07f, 0.1f, 0.13f, 0.18f,
                                    0.25f, 0.34f,   0.43f, 0.55f,  0.66f, 0.77f, 0.9f, 1};
static const float cosines[] = {1, 0.7f, 0.3f, 0.1f, 0.03f, 0.01f};
/* Azimuths, of anisotropic materials: along the grooves' width, across, and between. */
static const double turns[] = {0, 0.05, 0.125, 0.25};
enum { AZIMUTHS = sizeof turns / sizeof *turns };
enum { ROUGHNESSES = sizeof roughnesses / sizeof *roughnesses, COSINES = sizeof cosines / sizeof *cosines };

/* How far from 1 the albedo of a white material may be, and how far above 1 any. */
#define OFF_WHITE 5e-3
/* Of boundaries of solids: from inside a dip at the critical angle is narrower than the tables' columns, and tables run over
 * the index of refraction too. */
#define OFF_SOLID 7e-3
/* Tables know the exact Fresnel term, not what specular factor and colour make of it. */
#define OFF_SPECULAR 1e-2
/* Of anisotropic surfaces, whose tables are coarse, near the horizon; of films, which tables do not know. */
#define OFF_ANISOTROPIC 1e-2
#define OFF_FILM 1e-2
/* What goes straight on through a solid loses nothing; what is reflected beside it loses some, seen from near the horizon,
 * and gets none of it back. */
#define OFF_STRAIGHT 1.5e-2
#define OFF_MIRROR 5e-4 /* what tables of five digits and bilinear look-ups leave of a smooth interface */
#define OFF_AOV 0.22 /* of coloured rough glass, whose Fresnel term bsdf_albedo takes at one cosine, and of what
                       layers take from light that crosses */

/* Power that leaves for one that comes: what is smooth by quadrature, deltas by the lobe's number alone. Radiance that
 * crossed into the far side counts with what it was squeezed by. */
static dvec3 directional_albedo(const probe *p) {
    enum { LOBES = 4096 };
    chart c;
    chart_make(&c, p);
    chart_sums smooth = chart_integrate(&c);
    dvec3 sum = d3_add(smooth.value[0], d3_scale(smooth.value[1], probe_squeeze(p)));
    for (int n = 0; n < LOBES; n++) {
        bsdf_sampled r = probe_sample(p, ((float)n + 0.5f) / LOBES, (vec2){0.5f, 0.5f});
        double weight = r.delta ? (r.wi.z < 0 ? probe_squeeze(p) : 1) / LOBES : 0;
        vec3 m = r.multiplier;
        sum = d3_add(sum, d3_scale((dvec3){(double)m.x, (double)m.y, (double)m.z}, weight));
    }
    return sum;
}

/* What was found of all white materials, for the table. */
static double lowest[ROUGHNESSES][COSINES], highest[ROUGHNESSES][COSINES];

/* The largest albedo of all rows, white or not, and where it was. */
static struct { double albedo; const char *name; float roughness, cosine; } worst;

static void print_table(void) {
    print_message("albedo of white materials: lowest and highest of all kinds\nroughness");
    for (int k = 0; k < COSINES; k++) print_message("      cos %-4g", (double)cosines[k]);
    for (int r = 0; r < ROUGHNESSES; r++) {
        print_message("\n%-9g", (double)roughnesses[r]);
        for (int k = 0; k < COSINES; k++) print_message("  %.4f %.4f", lowest[r][k], highest[r][k]);
    }
    print_message("\nlargest of all %zu materials: %.5f (%s, roughness %g, cos %g)\n", bsdf_case_count, worst.albedo,
                  worst.name, (double)worst.roughness, (double)worst.cosine);
}

static double tolerance_of(const probe *p, const bsdf_case *row, int r) {
    if (r == 0 && !(row->mask & BSDF_LAYERED)) return OFF_MIRROR;
    if (r > 0 && row->transmission > 0 && bsdf_is_straight(&p->bsdf)) return OFF_STRAIGHT;
    if (row->anisotropy > 0) return OFF_ANISOTROPIC;
    if (row->film > 0) return OFF_FILM;
    if (row->transmission > 0 && row->specular < 1) return OFF_SPECULAR;
    return row->inside || (row->transmission > 0 && !row->thin) ? OFF_SOLID : OFF_WHITE;
}

static void check_albedo(const subject *s, int r, int k, double turn) {
    probe p = probe_make(s, roughnesses[r], direction_at((double)cosines[k], turn));
    dvec3 a = directional_albedo(&p);
    vec3 aov = probe_albedo(&p);
    double most = fmax(a.x, fmax(a.y, a.z)), least = fmin(a.x, fmin(a.y, a.z));
    if (most > worst.albedo) {
        worst.albedo = most;
        worst.name = s->row->name, worst.roughness = roughnesses[r], worst.cosine = cosines[k];
    }
    double tolerance = tolerance_of(&p, s->row, r), missed = tolerance + (double)s->row->off_white;
    double off_aov = tolerance == OFF_MIRROR || s->row->white ? missed : OFF_AOV;
    if (!(most <= 1 + tolerance) || !(least >= 0) || (s->row->white && !(least >= 1 - missed)))
        fail_msg("%s, roughness %g, cos %g: albedo %.5f %.5f %.5f", s->row->name, (double)roughnesses[r],
                 (double)cosines[k], a.x, a.y, a.z);
    if (fabs((double)aov.x - a.x) > off_aov || fabs((double)aov.y - a.y) > off_aov || fabs((double)aov.z - a.z) > off_aov)
        fail_msg("%s, roughness %g, cos %g: albedo %.5f %.5f %.5f, said to be %.5f %.5f %.5f", s->row->name,
                 (double)roughnesses[r], (double)cosines[k], a.x, a.y, a.z, (double)aov.x, (double)aov.y, (double)aov.z);
    if (!s->row->white) return;
    highest[r][k] = fmax(highest[r][k], most);
    lowest[r][k] = lowest[r][k] > 0 ? fmin(lowest[r][k], least) : least;
}

/* No more leaves than comes; of white materials as much. */
static void energy_is_conserved(void **state) {
    (void)state;
    subject *s = calloc(1, sizeof *s);
    for (size_t c = 0; c < bsdf_case_count; c++) {
        subject_make(s, &bsdf_cases[c]);
        for (int r = 0; r < ROUGHNESSES; r += SPARSE)
            for (int k = 0; k < COSINES; k += bsdf_cases[c].white ? 1 : COSINES - 1)
                for (int n = 0; n < (bsdf_cases[c].anisotropy > 0 ? AZIMUTHS : 1); n++)
                    check_albedo(s, r, k, bsdf_cases[c].anisotropy > 0 ? turns[n] : 0.1);
    }
    print_table();
    free(s);
}

/* Smooth surfaces of a constant colour reflect what their closed forms say. */
static void smooth_surfaces_are_known(void **state) {
    (void)state;
    for (int k = 0; k < COSINES; k++) {
        double c = (double)cosines[k], schlick = pow(1 - c, 5);
        const struct { const char *name; double reflected; } known[] = {
            {"lambert", 1}, {"gold", 0.71 + 0.29 * schlick}, {"black metal", schlick},
            {"glass 1.5", (double)fresnel_dielectric((float)c, 1.5f)},
            {"glass 1.5 in", (double)fresnel_dielectric((float)c, 1 / 1.5f)},
            {"thin wall", (double)fresnel_dielectric((float)c, 1.5f)},
        };
        for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
            subject s;
            for (size_t n = 0; n < bsdf_case_count; n++)
                if (!strcmp(bsdf_cases[n].name, known[i].name)) subject_make(&s, &bsdf_cases[n]);
            probe p = probe_make(&s, 0, direction_at(c, 0.3));
            double sum = 0;
            for (int n = 0; n < 4096; n++) {
                bsdf_sampled r = probe_sample(&p, ((float)n + 0.5f) / 4096, (vec2){0.3f, 0.6f});
                sum += r.wi.z > 0 ? (double)r.multiplier.y / 4096 : 0;
            }
            if (fabs(sum - known[i].reflected) > 1e-3)
                fail_msg("%s, cos %g: reflects %.5f instead of %.5f", known[i].name, c, sum, known[i].reflected);
        }
    }
}

/* What rounding leaves of f: the half vector is found from its sum, against the width of the lobe; where light leaves the
 * denser side near the critical angle, 1 − F from the square of a small cosine, and F from a difference near 0. */
static double rounding(const probe *p, float roughness, vec3 wi) {
    bool refracts = wi.z < 0 && p->surface.thin < 0.5f;
    vec3 sum = v3_madd(p->bsdf.wo, refracts ? p->surface.eta : 1, v3(wi.x, wi.y, refracts ? wi.z : fabsf(wi.z)));
    double length = (double)v3_length(sum), alpha = fmax((double)(roughness * roughness), (double)GGX_ALPHA_MIN);
    double c = fmin(fabs((double)v3_dot(sum, p->bsdf.wo)), fabs((double)v3_dot(sum, wi))) / length;
    double eta = (double)p->bsdf.eta, g2 = fabs(eta * eta - 1 + c * c);
    bool denser = !refracts && p->mask & BSDF_TRANSMISSIVE && eta < 1;
    return 1e-4 + 2e-6 / (alpha * length) + (refracts ? 5e-7 / (c * c) : 0) + (denser ? 2e-6 / sqrt(g2 + 1e-6) : 0);
}

/* f is the same in both directions; across a solid's boundary, f over the squared index of the side where light comes
 * from is. Directions are drawn, so that lobes are met. */
static void check_reciprocity(const subject *s, float roughness, stream *random) {
    vec3 wo = direction_at((double)stream_between(random, 0.01f, 1), (double)stream_next(random));
    probe p = probe_make(s, roughness, wo);
    float lobe = stream_next(random);
    bsdf_sampled r = probe_sample(&p, lobe, stream_pair(random));
    if (r.delta || !(v3_max(r.multiplier) > 0) || !(fabsf(r.wi.z) > 1e-3f)) return;
    bool crosses = r.wi.z < 0;
    probe back = probe_reverse(&p, r.wi);
    vec3 there = probe_evaluate(&p, r.wi).value, here = probe_evaluate(&back, crosses ? v3(wo.x, wo.y, -wo.z) : wo).value;
    /* A diffuse crossing is as likely from either side (docs/materials.md): its fluxes are alike, not its f. */
    bool diffuse = crosses && s->row->pass > 0 && !s->row->thin;
    if (diffuse && s->row->transmission > 0) return;
    double squeeze = crosses ? pow(probe_squeeze(&p), diffuse ? 2 : 1) : 1, tolerance = rounding(&p, roughness, r.wi);
    const float *a = &there.x, *b = &here.x;
    for (int k = 0; k < 3; k++) {
        double f = (double)a[k] / (double)fabsf(r.wi.z) * squeeze, g = (double)b[k] / (double)wo.z;
        if (fabs(f - g) > tolerance * fmax(f, g) + 1e-6)
            fail_msg("%s, roughness %g, cos %g and %g: f is %.7g, and %.7g back", s->row->name, (double)roughness,
                     (double)wo.z, (double)r.wi.z, f, g);
    }
}

static void light_goes_both_ways_alike(void **state) {
    (void)state;
    stream random = {11, 0};
    subject *s = calloc(1, sizeof *s);
    for (size_t c = 0; c < bsdf_case_count; c++) {
        subject_make(s, &bsdf_cases[c]);
        if (bsdf_cases[c].clearcoat_tilt > 0) continue; /* shading normals are not reciprocal */
        for (int r = 0; r < ROUGHNESSES; r += SPARSE)
            for (int n = 0; n < 500; n++) check_reciprocity(s, roughnesses[r], &random);
    }
    free(s);
}

static bool is_real(vec3 v) { return isfinite(v.x) && isfinite(v.y) && isfinite(v.z); }

static bool is_weight(vec3 v) { return is_real(v) && v.x >= 0 && v.y >= 0 && v.z >= 0; }

/* Whatever is asked of it, everything is finite, no weight negative, and probabilities sum to 1 or 0. */
static void check_sanity(const subject *s, float roughness, vec3 wo, stream *random) {
    probe p = probe_make(s, roughness, wo);
    const bsdf *b = &p.bsdf;
    float sum = b->p_diffuse + b->p_below + b->p_glossy;
    vec3 aov = probe_albedo(&p);
    bool good = (fabsf(sum - 1) < 1e-5f || sum == 0) && is_weight(aov) && v3_max(aov) < 1.1f && b->p_diffuse >= 0 &&
                b->p_below >= 0 && b->p_glossy >= 0;
    for (int n = 0; n < 4; n++) {
        const float last = 0x1.fffffep-1f;
        float lobe = n == 0 ? 0 : n == 1 ? last : stream_next(random);
        vec2 u = n == 0 ? (vec2){0, 0} : n == 1 ? (vec2){last, last} : stream_pair(random);
        bsdf_sampled r = probe_sample(&p, lobe, u);
        bsdf_value v = probe_evaluate(&p, stream_direction(random));
        double most = (double)v3_max(r.multiplier) * (r.wi.z < 0 ? probe_squeeze(&p) : 1);
        good = good && is_real(r.wi) && is_weight(r.multiplier) && isfinite(r.pdf) && is_weight(v.value) &&
               isfinite(v.pdf) && r.pdf >= 0 && v.pdf >= 0 && (r.delta || most < 1e6);
        if (!good)
            fail_msg("metallic %g specular %g ior %g transmission %g thin %d inside %d roughness %g wo.z %g: "
                     "wi %g %g %g, multiplier %g %g %g, pdf %g; value %g, pdf %g; sum %g, albedo %g %g %g",
                     (double)s->row->metallic, (double)s->row->specular, (double)s->row->ior,
                     (double)s->row->transmission, s->row->thin, s->row->inside, (double)roughness, (double)wo.z,
                     (double)r.wi.x, (double)r.wi.y, (double)r.wi.z, (double)r.multiplier.x, (double)r.multiplier.y,
                     (double)r.multiplier.z, (double)r.pdf, (double)v.value.x, (double)v.pdf, (double)sum,
                     (double)aov.x, (double)aov.y, (double)aov.z);
    }
}

/* The corners of the parameter box, and numbers between. */
static void everything_is_finite(void **state) {
    (void)state;
    static const float unit[] = {0, 1, 0.37f}, iors[] = {1, 1.0001f, 1.5f, 1000, 0};
    static const float rough[] = {0, 0.0099999f, 0.01f, 0.0101f, 0.3f, 1};
    static const double grazing[] = {1, 0.5, 0.01, 1e-4, 1e-7, 1e-20};
    stream random = {12, 0};
    subject *s = calloc(1, sizeof *s);
    for (uint32_t i = 0; i < 3 * 3 * 3 * 5 * 3 * 4; i++) {
        uint32_t n = i;
        bsdf_case row = {.name = "box", .mask = BSDF_GLOSSY | BSDF_TRANSMISSIVE};
        row.metallic = unit[n % 3], n /= 3;
        row.specular = unit[n % 3], n /= 3;
        row.transmission = unit[n % 3], n /= 3;
        row.ior = iors[n % 5], n /= 5;
        float color = unit[n % 3];
        n /= 3;
        row.thin = n & 1, row.inside = n >> 1 & 1;
        row.base = v3(color, 1, color);
        row.specular_color = v3(1, color, 0);
        if (!row.transmission) row.mask = row.metallic || row.specular ? BSDF_GLOSSY : 0;
        subject_make(s, &row);
        for (size_t r = 0; r < sizeof rough / sizeof *rough; r++)
            for (size_t k = 0; k < sizeof grazing / sizeof *grazing; k++)
                check_sanity(s, rough[r], direction_at(grazing[k], (double)stream_next(&random)), &random);
    }
    free(s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(energy_is_conserved),
        cmocka_unit_test(smooth_surfaces_are_known),
        cmocka_unit_test(light_goes_both_ways_alike),
        cmocka_unit_test(everything_is_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
