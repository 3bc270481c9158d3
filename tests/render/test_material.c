/* What a material of a scene becomes: its record, and the lobes that are made of it at a point. Seeds are fixed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "render/path/shading.h"
#include "render/world/world.h"
#include "tests/render/scenes.h"
#include "tests/render/statistics.h"

enum { D = 1, B = 2, R = 4, T = 8 }; /* DIFFUSE, BELOW, REFLECTION, TRANSMISSION */

/* A material by what differs from: white, no metal, IOR 1.5. */
typedef struct row {
    const char *name;
    float base, metallic, specular, roughness, transmission, thickness;
    uint32_t layers;
    material_kind kind;
    unsigned lobes;  /* that can be chosen */
    bool mirror, straight; /* REFLECTION and TRANSMISSION are deltas */
} row;

#define TRANSMITS KILN_LAYER_TRANSMISSION
#define SOLID (KILN_LAYER_TRANSMISSION | KILN_LAYER_VOLUME)

static const row rows[] = {
    {"matt", 0.5f, 0, 0, 0.5f, 0, 0, 0, KIND_DIFFUSE, D, 0, 0},
    {"black", 0, 0, 0, 0.5f, 0, 0, 0, KIND_DIFFUSE, 0, 0, 0},
    {"polished plastic", 0.5f, 0, 1, 0, 0, 0, 0, KIND_GLOSSY, D | R, 1, 0},
    {"plastic", 0.5f, 0, 1, 0.4f, 0, 0, 0, KIND_GLOSSY, D | R, 0, 0},
    {"black plastic", 0, 0, 1, 0.4f, 0, 0, 0, KIND_GLOSSY, R, 0, 0},
    {"mirror", 0.9f, 1, 1, 0, 0, 0, 0, KIND_GLOSSY, R, 1, 0},
    {"rough metal", 0.9f, 1, 1, 0.8f, 0, 0, 0, KIND_GLOSSY, D | R, 0, 0}, /* D: reflected more than once */
    {"half metal", 0.9f, 0.5f, 1, 0, 0, 0, 0, KIND_GLOSSY, D | R, 1, 0},
    {"metal without a coat", 0.9f, 1, 0, 0, 0, 0, 0, KIND_GLOSSY, R, 1, 0},
    {"window", 1, 0, 1, 0, 1, 0, TRANSMITS, KIND_TRANSMISSIVE, R | T, 1, 1},
    {"window, thickness 0", 1, 0, 1, 0, 1, 0, SOLID, KIND_TRANSMISSIVE, R | T, 1, 1},
    {"half a window", 1, 0, 1, 0, 0.5f, 0, TRANSMITS, KIND_TRANSMISSIVE, D | R | T, 1, 1},
    {"frosted window", 1, 0, 1, 0.5f, 1, 0, TRANSMITS, KIND_TRANSMISSIVE, D | B | R | T, 0, 0},
    {"black window", 0, 0, 1, 0, 1, 0, TRANSMITS, KIND_TRANSMISSIVE, R, 1, 1},
    {"glass", 1, 0, 1, 0, 1, 1, SOLID, KIND_TRANSMISSIVE, R | T, 1, 1},
    {"frosted glass", 1, 0, 1, 0.5f, 1, 1, SOLID, KIND_TRANSMISSIVE, D | B | R | T, 0, 0},
    {"metal does not transmit", 0.9f, 1, 1, 0, 1, 1, SOLID, KIND_GLOSSY, R, 1, 0},
    {"a layer that is not there", 0.5f, 0, 1, 0.4f, 1, 1, 0, KIND_GLOSSY, D | R, 0, 0},
    {"a volume that lets nothing in", 0.5f, 0, 1, 0.4f, 0, 1, SOLID, KIND_GLOSSY, D | R, 0, 0},
    {"unlit", 0.5f, 1, 1, 0.4f, 1, 1, SOLID | KILN_LAYER_UNLIT, KIND_DIFFUSE, 0, 0, 0},
};
enum { ROWS = sizeof rows / sizeof *rows };

static kiln_material material_of(const row *r) {
    kiln_material m = kiln_material_default();
    for (int k = 0; k < 3; k++) m.base_color.value[k] = r->base;
    m.metallic.value = r->metallic, m.specular.value = r->specular, m.roughness.value = r->roughness;
    m.transmission.value = r->transmission, m.thickness.value = r->thickness;
    m.layers = r->layers;
    return m;
}

/* A world of one triangle each for some materials, whose ids are 1, 2, …; the scene must outlive it. */
static world *world_with(scene_builder *b, const kiln_material *materials, uint32_t count) {
    *b = builder_make();
    for (uint32_t i = 0; i < count; i++) {
        float x = (float)i;
        add_quad(b, add_material(b, &materials[i]), (float[]){x, 0, 0, x + 1, 0, 0, x + 1, 1, 0, x, 1, 0});
    }
    return build_world(b);
}

/* As the stages load it, without textures. */
static surface surface_of(const world_material *m, bool outside) {
    outside = outside || m->thin > 0.5f;
    return (surface){.base = v3_load(m->base), .through = v3_load(m->base), .metallic = m->metallic, .roughness = m->roughness,
                     .specular = m->specular, .specular_color = v3_load(m->specular_color), .f0 = m->f0,
                     .transmission = m->transmission,
                     .eta = outside ? m->eta : 1.0f / m->eta, .thin = m->thin};
}

static void check_row(const row *r, const world_material *m) {
    surface s = surface_of(m, true);
    const vec3 wo = v3(0.48f, 0.36f, 0.8f);
    bsdf b = bsdf_make(kernel_mask(m->kind), &s, wo);
    float passes = b.p_glossy * bsdf_facet_at(kernel_mask(m->kind), &b, wo.z).p_passes, wide = b.p_diffuse + b.p_below;
    unsigned lobes = (b.p_diffuse > 0 ? D : 0) | (b.p_below > 0 ? B : 0) | (b.p_glossy > passes ? R : 0) |
                     (passes > 0 ? T : 0);
    if (m->kind != r->kind || lobes != r->lobes) fail_msg("%s: kind %d, lobes %u", r->name, m->kind, lobes);
    float sum = wide + b.p_glossy;
    if (fabsf(sum - (lobes ? 1.0f : 0.0f)) > 1e-6f) fail_msg("%s: probabilities sum to %g", r->name, (double)sum);
    stream random = {81, 0};
    for (int i = 0; i < 1000; i++) {
        float lobe = stream_next(&random);
        bsdf_sampled n = bsdf_sample(kernel_mask(m->kind), &b, lobe, stream_pair(&random));
        bool glossy = lobe >= wide, reflects = glossy && n.wi.z > 0;
        bool delta = lobes && glossy && (reflects ? r->mirror : r->straight);
        if (n.delta != delta || (delta && n.pdf != 0)) fail_msg("%s: lobe at %g", r->name, (double)lobe);
        if (!delta) continue;
        vec3 mirrored = v3(-wo.x, -wo.y, wo.z);
        if (reflects) assert_true(v3_length(v3_sub(n.wi, mirrored)) < 1e-6f);
        else assert_true(n.wi.z < 0 && fabsf(wo.x * n.wi.y - wo.y * n.wi.x) < 1e-6f);
        if (!(lobes & (D | B))) assert_true(bsdf_evaluate(kernel_mask(m->kind), &b, n.wi).pdf == 0);
    }
}

static void materials_become_lobes(void **state) {
    (void)state;
    kiln_material materials[ROWS];
    for (int i = 0; i < ROWS; i++) materials[i] = material_of(&rows[i]);
    scene_builder b;
    world *w = world_with(&b, materials, ROWS);
    for (int i = 0; i < ROWS; i++) check_row(&rows[i], &w->materials[i + 1]);
    assert_int_equal(w->kinds, 1u << KIND_DIFFUSE | 1u << KIND_GLOSSY | 1u << KIND_TRANSMISSIVE);
    world_destroy(w);
    builder_free(&b);
}

static kiln_material layered(uint32_t layers) {
    kiln_material m = kiln_material_default();
    m.layers = layers;
    m.clearcoat.value = m.anisotropy.value = m.iridescence.value = m.diffuse_transmission.value = m.transmission.value = 1;
    m.sheen_color.value[1] = 1;
    m.metallic.value = 0; /* metal would hide what crosses */
    return m;
}

/* A material goes to the kernel that has its layers, and least besides. */
static void layers_choose_a_kind(void **state) {
    (void)state;
    static const struct { uint32_t layers; material_kind kind; } cases[] = {
        {0, KIND_GLOSSY},
        {KILN_LAYER_CLEARCOAT, KIND_COATED},
        {KILN_LAYER_ANISOTROPY, KIND_COATED},
        {KILN_LAYER_CLEARCOAT | KILN_LAYER_ANISOTROPY, KIND_COATED},
        {KILN_LAYER_TRANSMISSION, KIND_TRANSMISSIVE},
        {KILN_LAYER_CLEARCOAT | KILN_LAYER_TRANSMISSION, KIND_LAYERED},
        {KILN_LAYER_ANISOTROPY | KILN_LAYER_TRANSMISSION, KIND_LAYERED},
        {KILN_LAYER_SHEEN, KIND_LAYERED},
        {KILN_LAYER_DIFFUSE_TRANSMISSION, KIND_LAYERED},
        {KILN_LAYER_IRIDESCENCE, KIND_FILMED},
        {KILN_LAYER_IRIDESCENCE | KILN_LAYER_CLEARCOAT | KILN_LAYER_SHEEN | KILN_LAYER_TRANSMISSION, KIND_FILMED},
        {KILN_LAYER_IRIDESCENCE | KILN_LAYER_UNLIT, KIND_DIFFUSE},
    };
    enum { CASES = sizeof cases / sizeof *cases };
    kiln_material materials[CASES];
    for (int i = 0; i < CASES; i++) materials[i] = layered(cases[i].layers);
    scene_builder b;
    world *w = world_with(&b, materials, CASES);
    for (int i = 0; i < CASES; i++)
        if (w->materials[i + 1].kind != cases[i].kind) fail_msg("case %d: kind %d", i, w->materials[i + 1].kind);
    world_destroy(w);
    builder_free(&b);
}

/* A reflection is a mirror where alpha = roughness² is less than 10⁻⁴, and a spread above. */
static void mirrors_have_a_threshold(void **state) {
    (void)state;
    static const struct { float roughness; bool mirror; } cases[] = {{0, true}, {0.005f, true}, {0.00999f, true},
                                                                     {0.01001f, false}, {0.05f, false}, {1, false}};
    for (int i = 0; i < 6; i++) {
        row r = {"metal", 1, 1, 1, cases[i].roughness, 0, 0, 0, KIND_GLOSSY, 0, 0, 0};
        kiln_material m = material_of(&r);
        scene_builder b;
        world *w = world_with(&b, &m, 1);
        surface s = surface_of(&w->materials[1], true);
        bsdf f = bsdf_make(BSDF_GLOSSY, &s, v3(0, 0, 1));
        bsdf_sampled n = bsdf_sample(BSDF_GLOSSY, &f, 0x1.fffffep-1f, (vec2){0.3f, 0.6f});
        assert_true(n.delta == cases[i].mirror && (n.pdf == 0) == cases[i].mirror);
        assert_true((bsdf_evaluate(BSDF_GLOSSY, &f, v3(0, 0, 1)).pdf > 1) != cases[i].mirror || i == 5);
        if (n.delta) assert_true(fabsf(n.multiplier.x * f.p_glossy - 1) < 1e-3f); /* white */
        world_destroy(w);
        builder_free(&b);
    }
}

/* Whatever a material says, no lobe has a probability, and no surface an albedo, outside [0, 1]; from either side. */
static void weights_stay_within_bounds(void **state) {
    (void)state;
    enum { COUNT = 300 };
    static kiln_material materials[COUNT];
    stream s = {82, 0};
    for (int i = 0; i < COUNT; i++) {
        float extreme[8]; /* often at an end of the range */
        for (int k = 0; k < 8; k++) extreme[k] = fminf(fmaxf(stream_between(&s, -0.5f, 1.5f), 0), 1);
        row r = {.base = extreme[0], .metallic = extreme[1], .specular = extreme[2], .roughness = extreme[3],
                 .transmission = extreme[4], .thickness = extreme[5], .layers = SOLID};
        materials[i] = material_of(&r);
        materials[i].ior = i % 10 == 0 ? 0 : 1 + 3 * extreme[6];
        materials[i].specular_color.value[1] = 2 * extreme[7];
    }
    scene_builder b;
    world *w = world_with(&b, materials, COUNT);
    for (uint32_t i = 1; i <= COUNT; i++)
        for (int k = 0; k < 16; k++) {
            const world_material *m = &w->materials[i];
            surface p = surface_of(m, k & 1);
            vec3 wo = stream_direction(&s);
            wo.z = fmaxf(fabsf(wo.z), 0.01f);
            bsdf f = bsdf_make(kernel_mask(m->kind), &p, v3_normalize(wo));
            vec3 a = bsdf_albedo(kernel_mask(m->kind), &f);
            float passes = bsdf_facet_at(kernel_mask(m->kind), &f, stream_next(&s)).p_passes;
            const float each[7] = {f.p_diffuse, f.p_below, f.p_glossy, passes, a.x, a.y, a.z};
            for (int j = 0; j < 7; j++)
                if (!(each[j] >= 0 && each[j] <= 1.0001f)) fail_msg("material %u: [%d] is %g", i, j, (double)each[j]);
            float sum = each[0] + each[1] + each[2];
            assert_true(sum == 0 || fabsf(sum - 1) < 1e-5f);
        }
    world_destroy(w);
    builder_free(&b);
}

/* F0 = ((n − 1)/(n + 1))²; IOR 0 is infinity, F0 = 1; KHR_materials_volume: absorption −ln(colour)/distance. */
static void records_hold_physics(void **state) {
    (void)state;
    static const float iors[] = {1, 1.33f, 1.5f, 2.4f, 0};
    kiln_material m[5];
    for (int i = 0; i < 5; i++) {
        m[i] = material_of(&(row){"glass", 1, 0, 1, 0, 1, 1, SOLID, KIND_TRANSMISSIVE, 0, 0, 0});
        m[i].ior = iors[i];
        m[i].attenuation_distance = i == 1 ? 0 : 0.5f * (float)(i + 1);
        m[i].attenuation_color[0] = 0.25f, m[i].attenuation_color[1] = 0;
        m[i].double_sided = i & 1;
    }
    m[3].ior = 1.5f;
    scene_builder b;
    world *w = world_with(&b, m, 5);
    for (uint32_t i = 0; i < 5; i++) {
        const world_material *r = &w->materials[i + 1];
        double n = (double)m[i].ior, f0 = n > 0 ? (n - 1) * (n - 1) / ((n + 1) * (n + 1)) : 1;
        assert_true(fabs((double)r->f0 - f0) < 1e-6 && (n == 0 || r->eta == m[i].ior) && r->thin == 0);
        assert_true(isfinite(r->eta));
        const float *sigma = w->extinction + 3 * r->medium;
        double distance = (double)m[i].attenuation_distance * w->scale;
        double absorbs = distance > 0 ? -log(0.25) / distance : 0;
        assert_true(r->medium > 0 && fabs((double)sigma[0] - absorbs) < 1e-5 * absorbs + 1e-9);
        assert_true(distance > 0 ? sigma[1] > 10 * sigma[0] && isfinite(sigma[1]) : sigma[1] == 0);
        assert_true(sigma[2] == 0);
        assert_true(!(r->flags & MATERIAL_DOUBLE_SIDED) == !(i & 1) && r->kind == KIND_TRANSMISSIVE);
    }
    assert_true(RUNS(w, ABSORPTION) && w->media_count == 6);
    world_destroy(w);
    builder_free(&b);
}

/* Unlit base colour is emission; a texture that its factor makes irrelevant, or of one value, is not there; alpha has a
 * mode. */
static void records_leave_out_what_is_not_asked_for(void **state) {
    (void)state;
    scene_builder b = builder_make();
    const float greys[6] = {0.5f, 0.5f, 0.5f, 0.25f, 0.25f, 0.25f};
    kiln_texture t = {.image = add_image(&b, greys, 2, 1)}, even = {.image = add_image(&b, greys, 1, 1)};
    kiln_material m = kiln_material_default(), lit = m, masked = diffuse_material(1, 1, 1);
    m.layers = KILN_LAYER_UNLIT;
    m.base_color.value[0] = 3, m.base_color.value[1] = 0.5f;
    m.base_color.texture = m.emission.texture = m.roughness.texture = t;
    lit.metallic.value = lit.roughness.value = 0;
    lit.metallic.texture = lit.roughness.texture = lit.emission.texture = lit.opacity.texture = t;
    lit.specular.texture = t, lit.base_color.texture = even;
    masked.alpha_mode = KILN_ALPHA_MASK, masked.alpha_cutoff = 0.3f, masked.opacity.texture = t;
    const kiln_material *all[] = {&m, &lit, &masked};
    for (int i = 0; i < 3; i++)
        add_quad(&b, add_material(&b, all[i]), (float[]){0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    world *w = build_world(&b);
    const world_material *r = &w->materials[1];
    assert_true(r->base[0] == 0 && r->emission[0] == 3 && r->emission[1] == 0.5f && r->flags == MATERIAL_UNLIT);
    assert_true(r->texture[SLOT_EMISSION] && !r->texture[SLOT_BASE] && !r->texture[SLOT_ROUGHNESS]);
    r = &w->materials[2];
    for (int k = 0; k < SLOT_COUNT; k++) assert_true(!r->texture[k] == (k != SLOT_SPECULAR));
    assert_true(r->base[0] == 0.5f); /* one value everywhere is a factor */
    r = &w->materials[3];
    assert_true(r->flags == MATERIAL_MASK && r->alpha_cutoff == 0.3f && r->texture[SLOT_OPACITY]);
    assert_int_equal(w->texture_count, 3);
    world_destroy(w);
    builder_free(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(materials_become_lobes),     cmocka_unit_test(layers_choose_a_kind),
        cmocka_unit_test(mirrors_have_a_threshold),   cmocka_unit_test(weights_stay_within_bounds),
        cmocka_unit_test(records_hold_physics),
        cmocka_unit_test(records_leave_out_what_is_not_asked_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
