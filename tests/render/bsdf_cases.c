#include "tests/render/bsdf_cases.h"

#include <math.h>

#include "base/fmath.h"

enum { D = 0, G = BSDF_GLOSSY, T = BSDF_GLOSSY | BSDF_TRANSMISSIVE };
#define WHITE {1, 1, 1}
#define BLACK {0, 0, 0}
#define GOLD {1.0f, 0.71f, 0.29f}
#define BROWN {0.5f, 0.3f, 0.1f}

/* name, mask, metallic, specular, ior, transmission, thin, inside, white, base, specular colour */
const bsdf_case bsdf_cases[] = {
    {"lambert", D, 0, 0, 1.5f, 0, 1, 0, 1, WHITE, WHITE},
    {"brown lambert", D, 0, 0, 1.5f, 0, 1, 0, 0, BROWN, WHITE},
    {"metal", G, 1, 1, 1.5f, 0, 1, 0, 1, WHITE, WHITE},
    {"gold", G, 1, 1, 1.5f, 0, 1, 0, 0, GOLD, WHITE},
    {"black metal", G, 1, 1, 1.5f, 0, 1, 0, 0, BLACK, WHITE},
    {"coat 1.0", G, 0, 1, 1.0f, 0, 1, 0, 1, WHITE, WHITE},
    {"coat 1.33", G, 0, 1, 1.33f, 0, 1, 0, 1, WHITE, WHITE},
    {"coat 1.5", G, 0, 1, 1.5f, 0, 1, 0, 1, WHITE, WHITE},
    {"coat 2.5", G, 0, 1, 2.5f, 0, 1, 0, 1, WHITE, WHITE},
    {"coat infinite", G, 0, 1, 0, 0, 1, 0, 1, WHITE, WHITE},
    {"brown coat 1.5", G, 0, 1, 1.5f, 0, 1, 0, 0, BROWN, WHITE},
    {"tinted half coat", G, 0, 0.5f, 1.8f, 0, 1, 0, 1, WHITE, GOLD},
    {"half metal", G, 0.5f, 1, 1.5f, 0, 1, 0, 1, WHITE, WHITE},
    {"thin wall", T, 0, 1, 1.5f, 1, 1, 0, 1, WHITE, WHITE},
    {"gold thin wall", T, 0, 1, 1.5f, 1, 1, 0, 0, GOLD, WHITE},
    {"glass 1.0", T, 0, 1, 1.0f, 1, 0, 0, 1, WHITE, WHITE},
    {"glass 1.05 in", T, 0, 1, 1.05f, 1, 0, 1, 1, WHITE, WHITE},
    {"glass 1.05", T, 0, 1, 1.05f, 1, 0, 0, 1, WHITE, WHITE},
    {"glass 1.33", T, 0, 1, 1.33f, 1, 0, 0, 1, WHITE, WHITE},
    {"glass 1.33 in", T, 0, 1, 1.33f, 1, 0, 1, 1, WHITE, WHITE},
    {"glass 1.5", T, 0, 1, 1.5f, 1, 0, 0, 1, WHITE, WHITE},
    {"glass 1.5 in", T, 0, 1, 1.5f, 1, 0, 1, 1, WHITE, WHITE},
    {"glass 2.4", T, 0, 1, 2.4f, 1, 0, 0, 1, WHITE, WHITE},
    {"glass 2.4 in", T, 0, 1, 2.4f, 1, 0, 1, 1, WHITE, WHITE},
    {"brown glass 1.5", T, 0, 1, 1.5f, 1, 0, 0, 0, BROWN, WHITE},
    {"half glass 1.5", T, 0, 1, 1.5f, 0.5f, 0, 0, 1, WHITE, WHITE},
    {"half thin wall", T, 0, 1, 1.5f, 0.5f, 1, 0, 1, WHITE, WHITE},
    {"everything", T, 0.3f, 0.8f, 1.6f, 0.6f, 0, 0, 0, GOLD, GOLD},
    {"everything in", T, 0.3f, 0.8f, 1.6f, 0.6f, 0, 1, 0, GOLD, GOLD},
};
const size_t bsdf_case_count = sizeof bsdf_cases / sizeof *bsdf_cases;

/* As render/world/materials.c and the material stage do. */
void subject_make(subject *to, const bsdf_case *c) {
    float ior = c->ior > 0 ? c->ior : 1000.0f, root = (ior - 1) / (ior + 1), eta = c->inside ? 1 / ior : ior;
    to->row = c;
    to->surface = (surface){.base = c->base, .metallic = c->metallic, .specular = c->specular,
                            .specular_color = c->specular_color, .f0 = c->ior > 0 ? root * root : 1.0f,
                            .transmission = c->transmission, .through = c->base, .eta = eta, .thin = c->thin ? 1.0f : 0.0f};
}

static bsdf make(unsigned mask, const surface *s, vec3 wo) {
    return mask == D ? bsdf_make(D, s, wo) : mask == G ? bsdf_make(G, s, wo) : bsdf_make(T, s, wo);
}

probe probe_make(const subject *from, float roughness, vec3 wo) {
    probe p = {.mask = from->row->mask, .surface = from->surface};
    p.surface.roughness = roughness;
    p.bsdf = make(p.mask, &p.surface, wo);
    return p;
}

probe probe_reverse(const probe *from, vec3 wi) {
    probe p = *from;
    if (wi.z < 0 && p.surface.thin < 0.5f) {
        p.surface.eta = 1 / p.surface.eta;
    }
    p.bsdf = make(p.mask, &p.surface, v3(wi.x, wi.y, fabsf(wi.z)));
    return p;
}

bsdf_value probe_evaluate(const probe *p, vec3 wi) {
    return p->mask == D   ? bsdf_evaluate(D, &p->bsdf, wi)
           : p->mask == G ? bsdf_evaluate(G, &p->bsdf, wi)
                          : bsdf_evaluate(T, &p->bsdf, wi);
}

bsdf_sampled probe_sample(const probe *p, float lobe, vec2 direction) {
    return p->mask == D   ? bsdf_sample(D, &p->bsdf, lobe, direction)
           : p->mask == G ? bsdf_sample(G, &p->bsdf, lobe, direction)
                          : bsdf_sample(T, &p->bsdf, lobe, direction);
}

vec3 probe_albedo(const probe *p) {
    return p->mask == D   ? bsdf_albedo(D, &p->bsdf)
           : p->mask == G ? bsdf_albedo(G, &p->bsdf)
                          : bsdf_albedo(T, &p->bsdf);
}

vec3 direction_at(double cosine, double turns) {
    double sine = sqrt(fmax(0, 1 - cosine * cosine)), phi = 2 * M_PI * turns;
    return v3((float)(sine * cos(phi)), (float)(sine * sin(phi)), (float)cosine);
}
