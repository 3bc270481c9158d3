#include "tests/render/bsdf_cases.h"

#include <math.h>

#include "base/fmath.h"
#include "render/path/shading.h"
#include "render/path/surface.h"

/* As render/world/materials.c sorts them into kinds. */
enum { D = SHADING_MASK_DIFFUSE, G = SHADING_MASK_GLOSSY, C = SHADING_MASK_COATED, T = SHADING_MASK_TRANSMISSIVE,
       L = SHADING_MASK_LAYERED, F = SHADING_MASK_FILMED };
#define WHITE {1, 1, 1}
#define BLACK {0, 0, 0}
#define GOLD {1.0f, 0.71f, 0.29f}
#define BROWN {0.5f, 0.3f, 0.1f}

#define NO_LAYERS .clearcoat = 0
/* Microfacets that reflect at grazing angles alone are not chosen by what they reflect; weak rough interfaces lose most of
 * what comes from near the horizon, and give it back there. */
#define UNEVEN(moment) .most_moment = moment
#define ALL_LAYERS                                                                                                     \
    .clearcoat = 0.7f, .clearcoat_roughness = 0.3f, .sheen = GOLD, .sheen_roughness = 0.4f, .anisotropy = 0.5f,        \
    .film = 0.5f, .film_ior = 1.4f, .film_thickness = 350, .pass = 0.5f, .pass_color = BROWN

/* name, mask, metallic, specular, ior, transmission, thin, inside, white, base, specular colour */
const bsdf_case bsdf_cases[] = {
    {"lambert", D, 0, 0, 1.5f, 0, 1, 0, 1, WHITE, WHITE, NO_LAYERS},
    {"brown lambert", D, 0, 0, 1.5f, 0, 1, 0, 0, BROWN, WHITE, NO_LAYERS},
    {"metal", G, 1, 1, 1.5f, 0, 1, 0, 1, WHITE, WHITE, .samples = 40000},
    {"gold", G, 1, 1, 1.5f, 0, 1, 0, 0, GOLD, WHITE, NO_LAYERS},
    {"black metal", G, 1, 1, 1.5f, 0, 1, 0, 0, BLACK, WHITE, UNEVEN(8)},
    {"coat 1.0", G, 0, 1, 1.0f, 0, 1, 0, 1, WHITE, WHITE, NO_LAYERS},
    {"coat 1.33", G, 0, 1, 1.33f, 0, 1, 0, 1, WHITE, WHITE, NO_LAYERS},
    {"coat 1.5", G, 0, 1, 1.5f, 0, 1, 0, 1, WHITE, WHITE, NO_LAYERS},
    {"coat 2.5", G, 0, 1, 2.5f, 0, 1, 0, 1, WHITE, WHITE, NO_LAYERS},
    {"coat infinite", G, 0, 1, 0, 0, 1, 0, 1, WHITE, WHITE, NO_LAYERS},
    {"brown coat 1.5", G, 0, 1, 1.5f, 0, 1, 0, 0, BROWN, WHITE, NO_LAYERS},
    {"tinted half coat", G, 0, 0.5f, 1.8f, 0, 1, 0, 1, WHITE, GOLD, NO_LAYERS},
    {"half metal", G, 0.5f, 1, 1.5f, 0, 1, 0, 1, WHITE, WHITE, NO_LAYERS},
    {"thin wall", T, 0, 1, 1.5f, 1, 1, 0, 1, WHITE, WHITE, NO_LAYERS},
    {"gold thin wall", T, 0, 1, 1.5f, 1, 1, 0, 0, GOLD, WHITE, NO_LAYERS},
    {"glass 1.0", T, 0, 1, 1.0f, 1, 0, 0, 1, WHITE, WHITE, NO_LAYERS},
    {"glass 1.05 in", T, 0, 1, 1.05f, 1, 0, 1, 1, WHITE, WHITE, UNEVEN(4)},
    {"glass 1.05", T, 0, 1, 1.05f, 1, 0, 0, 1, WHITE, WHITE, UNEVEN(4)},
    {"glass 1.33", T, 0, 1, 1.33f, 1, 0, 0, 1, WHITE, WHITE, NO_LAYERS},
    {"glass 1.33 in", T, 0, 1, 1.33f, 1, 0, 1, 1, WHITE, WHITE, NO_LAYERS},
    {"glass 1.5", T, 0, 1, 1.5f, 1, 0, 0, 1, WHITE, WHITE, NO_LAYERS},
    {"glass 1.5 in", T, 0, 1, 1.5f, 1, 0, 1, 1, WHITE, WHITE, NO_LAYERS},
    {"glass 2.4", T, 0, 1, 2.4f, 1, 0, 0, 1, WHITE, WHITE, NO_LAYERS},
    {"glass 2.4 in", T, 0, 1, 2.4f, 1, 0, 1, 1, WHITE, WHITE, NO_LAYERS},
    {"brown glass 1.5", T, 0, 1, 1.5f, 1, 0, 0, 0, BROWN, WHITE, NO_LAYERS},
    {"half glass 1.5", T, 0, 1, 1.5f, 0.5f, 0, 0, 1, WHITE, WHITE, NO_LAYERS},
    {"half thin wall", T, 0, 1, 1.5f, 0.5f, 1, 0, 1, WHITE, WHITE, NO_LAYERS},
    {"everything", T, 0.3f, 0.8f, 1.6f, 0.6f, 0, 0, 0, GOLD, GOLD, NO_LAYERS},
    {"everything in", T, 0.3f, 0.8f, 1.6f, 0.6f, 0, 1, 0, GOLD, GOLD, NO_LAYERS},
    {"no layer", L, 0, 1, 1.5f, 0, 1, 0, 1, WHITE, WHITE, NO_LAYERS},
    {"clearcoat on lambert", C, 0, 0, 1.5f, 0, 1, 0, 1, WHITE, WHITE, .clearcoat = 1},
    {"rough clearcoat on lambert", C, 0, 0, 1.5f, 0, 1, 0, 1, WHITE, WHITE, .clearcoat = 1, .clearcoat_roughness = 0.5f},
    {"clearcoat on plastic", C, 0, 1, 1.5f, 0, 1, 0, 1, WHITE, WHITE, .clearcoat = 1, .clearcoat_roughness = 0.1f,
     .off_white = 0.012f},
    {"half a clearcoat on metal", C, 1, 1, 1.5f, 0, 1, 0, 1, WHITE, WHITE, .clearcoat = 0.5f, .off_white = 0.02f},
    {"clearcoat on gold", C, 1, 1, 1.5f, 0, 1, 0, 0, GOLD, WHITE, .clearcoat = 1, .clearcoat_roughness = 0.3f},
    {"tilted clearcoat", C, 0, 1, 1.5f, 0, 1, 0, 0, BROWN, WHITE, .clearcoat = 1, .clearcoat_roughness = 0.6f,
     .clearcoat_tilt = 0.3f},
    {"clearcoat on glass", L, 0, 1, 1.5f, 1, 0, 0, 0, WHITE, WHITE, .clearcoat = 1, .clearcoat_roughness = 0.2f},
    {"clearcoat on glass, in", L, 0, 1, 1.5f, 1, 0, 1, 0, WHITE, WHITE, .clearcoat = 1, .clearcoat_roughness = 0.2f},
    {"clearcoat on black", C, 0, 0, 1.5f, 0, 1, 0, 0, BLACK, WHITE, .clearcoat = 1, .clearcoat_roughness = 0.02f},
    {"sheen on lambert", L, 0, 0, 1.5f, 0, 1, 0, 1, WHITE, WHITE, .sheen = WHITE, .sheen_roughness = 0.5f},
    {"narrow sheen on plastic", L, 0, 1, 1.5f, 0, 1, 0, 0, BROWN, WHITE, .sheen = GOLD, .sheen_roughness = 0.1f},
    {"sheen on black", L, 0, 0, 1.5f, 0, 1, 0, 0, BLACK, WHITE, .sheen = GOLD, .sheen_roughness = 1},
    {"sheen of no roughness", L, 0, 0, 1.5f, 0, 1, 0, 0, BLACK, WHITE, .sheen = WHITE, .sheen_roughness = 0, UNEVEN(5)},
    {"half anisotropic metal", C, 1, 1, 1.5f, 0, 1, 0, 1, WHITE, WHITE, .anisotropy = 0.5f},
    {"anisotropic metal", C, 1, 1, 1.5f, 0, 1, 0, 1, WHITE, WHITE, .anisotropy = 1},
    {"anisotropic plastic", C, 0, 1, 1.5f, 0, 1, 0, 0, BROWN, WHITE, .anisotropy = 0.7f},
    {"anisotropic glass", L, 0, 1, 1.5f, 1, 0, 0, 0, WHITE, WHITE, .anisotropy = 0.6f},
    {"anisotropic thin wall", L, 0, 1, 1.5f, 1, 1, 0, 1, WHITE, WHITE, .anisotropy = 0.6f},
    {"film on metal", F, 1, 1, 1.5f, 0, 1, 0, 0, GOLD, WHITE, .film = 1, .film_ior = 1.8f, .film_thickness = 400},
    {"film on plastic", F, 0, 1, 1.5f, 0, 1, 0, 1, WHITE, WHITE, .film = 1, .film_ior = 1.3f, .film_thickness = 300,
     .off_white = 0.015f},
    {"film of no thickness", F, 0, 1, 1.5f, 0, 1, 0, 1, WHITE, WHITE, .film = 1, .film_ior = 1.3f},
    {"film on glass", F, 0, 1, 1.5f, 1, 0, 0, 0, WHITE, WHITE, .film = 1, .film_ior = 1.3f, .film_thickness = 500},
    {"film on glass, in", F, 0, 1, 1.5f, 1, 0, 1, 0, WHITE, WHITE, .film = 1, .film_ior = 1.3f, .film_thickness = 500},
    {"soap film", F, 0, 1, 1.0f, 1, 1, 0, 0, WHITE, WHITE, .film = 0.7f, .film_ior = 1.33f, .film_thickness = 800},
    {"leaf", L, 0, 1, 1.5f, 0, 1, 0, 1, WHITE, WHITE, .pass = 0.5f, .pass_color = WHITE},
    {"red lampshade", L, 0, 0, 1.5f, 0, 1, 0, 0, BROWN, WHITE, .pass = 1, .pass_color = GOLD},
    {"wax", L, 0, 1, 1.4f, 0, 0, 0, 1, WHITE, WHITE, .pass = 0.8f, .pass_color = WHITE},
    {"wax, in, under clearcoat", L, 0, 1, 1.4f, 0, 0, 1, 0, WHITE, WHITE, .pass = 0.8f, .pass_color = WHITE, .clearcoat = 1},
    {"wax under clearcoat", L, 0, 1, 1.4f, 0, 0, 0, 0, WHITE, WHITE, .pass = 0.8f, .pass_color = WHITE, .clearcoat = 1},
    {"all layers", F, 0.3f, 0.8f, 1.6f, 0.3f, 0, 0, 0, GOLD, GOLD, ALL_LAYERS},
    {"all layers, in", F, 0.3f, 0.8f, 1.6f, 0.3f, 0, 1, 0, GOLD, GOLD, ALL_LAYERS},
};

const char *const bsdf_case_of_DIFFUSE = "lambert", *const bsdf_case_of_BELOW = "leaf",
                  *const bsdf_case_of_REFLECTION = "metal", *const bsdf_case_of_TRANSMISSION = "glass 1.5",
                  *const bsdf_case_of_CLEARCOAT = "clearcoat on black", *const bsdf_case_of_SHEEN = "sheen on black",
                  *const bsdf_case_of_GRAZING = "metal";
const size_t bsdf_case_count = sizeof bsdf_cases / sizeof *bsdf_cases;

/* As render/world/materials.c and the material stage do. */
void subject_make(subject *to, const bsdf_case *c) {
    float ior = c->ior > 0 ? c->ior : 1000.0f, root = (ior - 1) / (ior + 1), eta = c->inside ? 1 / ior : ior;
    to->row = c;
    to->surface = (surface){.base = c->base, .metallic = c->metallic, .specular = c->specular,
                            .specular_color = c->specular_color, .f0 = c->ior > 0 ? root * root : 1.0f,
                            .transmission = c->transmission, .through = c->base, .eta = eta, .thin = c->thin ? 1.0f : 0.0f,
                            .near = c->thin || !c->inside ? 1.0f : 0.0f, .far = c->thin || c->inside ? 1.0f : 0.0f,
                            .anisotropy = c->anisotropy, .film = c->film, .film_ior = fmaxf(c->film_ior, 1),
                            .film_thickness = c->film_thickness, .clearcoat = c->clearcoat,
                            .clearcoat_roughness = c->clearcoat_roughness,
                            .clearcoat_normal = v3(sinf(c->clearcoat_tilt), 0, cosf(c->clearcoat_tilt)),
                            .sheen = c->sheen, .sheen_roughness = c->sheen_roughness,
                            .diffuse_transmission = c->pass, .diffuse_transmission_color = c->pass_color};
}

/* The call with the mask as a constant. */
#define BY_MASK(mask, call)                                                                                            \
    ((mask) == D ? call(D) : (mask) == G ? call(G) : (mask) == C ? call(C) : (mask) == T ? call(T) : (mask) == L ? call(L) : call(F))

static bsdf make(unsigned mask, const surface *s, vec3 wo) {
#define MAKE(m) bsdf_make(m, s, wo)
    return BY_MASK(mask, MAKE);
}

probe probe_make(const subject *from, float roughness, vec3 wo) {
    probe p = {.mask = from->row->mask, .surface = from->surface};
    p.surface.roughness = roughness;
    p.surface.clearcoat_normal = surface_face(p.surface.clearcoat_normal, wo);
    p.bsdf = make(p.mask, &p.surface, wo);
    return p;
}

probe probe_reverse(const probe *from, vec3 wi) {
    probe p = *from;
    if (wi.z < 0 && p.surface.thin < 0.5f) {
        p.surface.eta = 1 / p.surface.eta;
        p.surface.near = from->surface.far;
        p.surface.far = from->surface.near;
    }
    p.bsdf = make(p.mask, &p.surface, v3(wi.x, wi.y, fabsf(wi.z)));
    return p;
}

bsdf_value probe_evaluate(const probe *p, vec3 wi) {
#define EVALUATE(m) bsdf_evaluate(m, &p->bsdf, wi)
    return BY_MASK(p->mask, EVALUATE);
}

bsdf_sampled probe_sample(const probe *p, float lobe, vec2 direction) {
#define SAMPLE(m) bsdf_sample(m, &p->bsdf, lobe, direction)
    return BY_MASK(p->mask, SAMPLE);
}

vec3 probe_albedo(const probe *p) {
#define ALBEDO(m) bsdf_albedo(m, &p->bsdf)
    return BY_MASK(p->mask, ALBEDO);
}

float probe_narrowest(const probe *p) {
    float coat = p->bsdf.clearcoat.alpha, narrowest = 1;
    if (p->mask && !bsdf_is_mirror(p->bsdf.alphas.x)) narrowest = p->bsdf.alphas.y;
    if (p->mask & BSDF_CLEARCOAT && p->bsdf.clearcoat.near > 0 && !bsdf_is_mirror(coat)) narrowest = fminf(narrowest, coat);
    return narrowest;
}

vec3 direction_at(double cosine, double turns) {
    double sine = sqrt(fmax(0, 1 - cosine * cosine)), phi = 2 * M_PI * turns;
    return v3((float)(sine * cos(phi)), (float)(sine * sin(phi)), (float)cosine);
}
