/* Handles, ids of names and places of what a pixel shows. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/fmath.h"
#include "render/film/film.h"
#include "tests/render/scenes.h"

enum { SIDE = 48, SPP = 16, THINGS = 4 };

static kiln_id named(scene_builder *b, const char *name) {
    kiln_material m = diffuse_material(0.5f, 0.5f, 0.5f);
    m.name = name;
    m.double_sided = true;
    return add_material(b, &m);
}

static void place(scene_builder *b, kiln_id mesh, const char *name, const char *asset, double x, double z) {
    const double m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1000 + x, 0, z, 1};
    kiln_instance_desc desc = {.name = name, .asset = asset, .mesh = mesh, .time_count = 1, .transforms = m};
    must(kiln_scene_add_instance(b->scene, &desc, NULL, b->report), b->report, "placing");
}

/* Squares that lean, a kilometre from the origin; edges cut through pixels. Instances `shown` (bits) are there. */
static scene_builder squares(unsigned shown) {
    static const struct { const char *name, *asset; double x, z; } things[THINGS] = {
        {"left", "pair", -.6, 0}, {"right", "pair", .5, 0}, {NULL, NULL, 0, -.5}, {"left", NULL, 0, -1}};
    const float p[12] = {-.5f, -.5f, 0, .45f, -.55f, 0, .5f, .5f, 0, -.45f, .53f, 0}, uv[8] = {0, 1, 1, 1, 1, 0, 0, 0};
    const uint32_t faces[6] = {0, 1, 2, 0, 2, 3};
    const kiln_primvar primvar = {.kind = KILN_PRIMVAR_UV, .values = uv, .value_count = 4};
    scene_builder b = builder_make();
    for (unsigned i = 0; i < THINGS; i++) {
        kiln_id mesh, material = named(&b, i == 1 ? "red" : i == 2 ? NULL : "blue");
        kiln_mesh_desc desc = {.name = "square", .vertex_count = 4, .positions = p, .face_count = 2,
                               .face_vertices = faces, .primvars = &primvar, .primvar_count = 1, .material = material};
        must(kiln_scene_add_mesh(b.scene, &desc, &mesh, b.report), b.report, "adding a square");
        if (shown >> i & 1) place(&b, mesh, things[i].name, things[i].asset, things[i].x, things[i].z);
    }
    return b;
}

static picture shoot(scene_builder *b) {
    kiln_renderer *renderer;
    kiln_camera view = camera_at((float[3]){1000, 0, 3}, (float[3]){1000, 0, 0}, 40);
    must(kiln_scene_commit(b->scene, b->report), b->report, "committing");
    must(kiln_renderer_create(b->scene, NULL, &renderer, b->report), b->report, "making a renderer");
    kiln_film_desc desc = {.width = SIDE, .height = SIDE, .aovs = (1u << KILN_AOV_COUNT) - 1,
                           .mattes = (1u << KILN_MATTE_COUNT) - 1};
    picture p = render_with(renderer, &(kiln_render_options){.camera = &view, .spp = SPP}, &desc, b->report);
    kiln_renderer_destroy(renderer);
    return p;
}

static float coverage(const float *ranks, uint32_t id) {
    for (int r = 0; r < KILN_MATTE_RANKS; r++)
        if (ranks[2 * r + 1] > 0 && fm_bits(ranks[2 * r]) == id) return ranks[2 * r + 1];
    return 0;
}

static float *matte_of(const picture *p, kiln_matte matte) {
    float *values = malloc(SIDE * SIDE * KILN_MATTE_RANKS * 2 * sizeof *values);
    assert_true(kiln_film_matte(p->film, matte, values));
    return values;
}

static float *aov_of(const picture *p, kiln_aov aov, int channels) {
    float *values = malloc((size_t)(SIDE * SIDE * channels) * sizeof *values);
    assert_true(kiln_film_aov(p->film, aov, values));
    return values;
}

/* Ranked, and all that is not background. */
static void shares_sum_to_alpha(void **state) {
    (void)state;
    scene_builder b = squares(15);
    picture p = shoot(&b);
    float *alpha = aov_of(&p, KILN_AOV_ALPHA, 1);
    int mixed = 0;
    for (int m = 0; m < KILN_MATTE_COUNT; m++) {
        float *ranks = matte_of(&p, (kiln_matte)m);
        for (int i = 0; i < SIDE * SIDE; i++) {
            float sum = 0;
            const float *r = ranks + (size_t)i * KILN_MATTE_RANKS * 2;
            for (int k = 0; k < KILN_MATTE_RANKS; k++) {
                sum += r[2 * k + 1];
                assert_true(!k || r[2 * k + 1] <= r[2 * k - 1]);
            }
            assert_true(sum == alpha[i]); /* sixteenths */
            mixed += r[3] > 0;
        }
        free(ranks);
    }
    assert_true(mixed > 100);
    free(alpha);
    picture_free(&p);
    builder_free(&b);
}

/* In front of all others a thing's matte is what the alpha is when it is alone. Camera samples do not depend on the
 * scene. */
static void a_matte_is_the_alpha_of_the_thing_alone(void **state) {
    (void)state;
    scene_builder all = squares(15), one = squares(2);
    picture p = shoot(&all), alone = shoot(&one);
    float *ranks = matte_of(&p, KILN_MATTE_OBJECT), *materials = matte_of(&p, KILN_MATTE_MATERIAL);
    float *alpha = aov_of(&alone, KILN_AOV_ALPHA, 1);
    for (int i = 0; i < SIDE * SIDE; i++) {
        assert_true(coverage(ranks + i * KILN_MATTE_RANKS * 2, kiln_matte_id("right")) == alpha[i]);
        assert_true(coverage(materials + i * KILN_MATTE_RANKS * 2, kiln_matte_id("red")) == alpha[i]);
    }
    free(ranks), free(materials), free(alpha);
    picture_free(&p), picture_free(&alone);
    builder_free(&all), builder_free(&one);
}

static void has_names(const picture *p, kiln_matte matte, const char *const *wanted, uint32_t count) {
    uint32_t found;
    kiln_matte_name *names = kiln_film_matte_names(p->film, matte, &found);
    assert_int_equal(found, count);
    for (uint32_t i = 0; i < count; i++) {
        bool there = false;
        for (uint32_t k = 0; k < found; k++)
            there |= strcmp(names[k].name, wanted[i]) == 0 && names[k].id == kiln_matte_id(wanted[i]);
        if (!there) fail_msg("%s is missing", wanted[i]);
    }
    free(names);
}

static void names_are_those_that_are_seen(void **state) {
    (void)state;
    scene_builder b = squares(7);
    picture p = shoot(&b);
    has_names(&p, KILN_MATTE_OBJECT, (const char *[]){"left", "right", "object 3"}, 3);
    has_names(&p, KILN_MATTE_MATERIAL, (const char *[]){"blue", "red", "material 3"}, 3);
    has_names(&p, KILN_MATTE_ASSET, (const char *[]){"pair", "object 3"}, 2);
    picture_free(&p);
    builder_free(&b);
}

static void handles_and_places(void **state) {
    (void)state;
    scene_builder b = squares(7);
    picture p = shoot(&b);
    float *object = aov_of(&p, KILN_AOV_OBJECT, 1), *material = aov_of(&p, KILN_AOV_MATERIAL, 1);
    float *position = aov_of(&p, KILN_AOV_POSITION, 3), *uv = aov_of(&p, KILN_AOV_UV, 2);
    const int middle = SIDE / 2 * SIDE + SIDE / 4; /* of the left square */
    assert_true(object[0] == 0 && material[0] == 0 && position[0] == 0 && uv[0] == 0);
    assert_true(object[middle] == 1 && material[middle] == 2);
    assert_true(object[SIDE / 2 * SIDE + SIDE * 3 / 4] == 2 && object[SIDE / 3 * SIDE + SIDE / 2] == 3);
    float across = 2 * 3 * tanf(0.349065850f) * (0.25f + 0.5f / SIDE - 0.5f); /* 20° */
    assert_true(fabsf(position[3 * middle] - 1000 - across) < 0.02f && fabsf(position[3 * middle + 2]) < 1e-3f);
    assert_true(fabsf(uv[2 * middle] - (across + .6f + .5f)) < 0.05f && fabsf(uv[2 * middle + 1] - .5f) < 0.05f);
    free(object), free(material), free(position), free(uv);
    picture_free(&p);
    builder_free(&b);
}

/* Space-Saving keeps what has more than one in eight, and every sample is counted. */
static void more_names_than_room(void **state) {
    (void)state;
    ballot t = {0};
    for (uint32_t i = 0; i < 600; i++) ballot_add(&t, i % 3 ? i : i % 2 ? 7 : 9);
    uint32_t sum = 0, often = 0;
    for (int i = 0; i < BALLOT_ROWS; i++) {
        sum += t.rows[i].count;
        if (t.rows[i].key == 7 || t.rows[i].key == 9) often += t.rows[i].count >= 100;
    }
    assert_int_equal(sum, 600);
    assert_int_equal(often, 2);
}

/* Exponents of all zeros and all ones are moved; the example of the specification is not. */
static void ids_are_finite(void **state) {
    (void)state;
    assert_int_equal(kiln_matte_id("bunny"), 0x13851a76);
    assert_int_equal(kiln_matte_id("default"), 0x42c9679f);
    int moved = 0;
    for (int i = 0; i < 4000; i++) {
        char name[24];
        snprintf(name, sizeof name, "thing %d", i);
        float f = fm_from_bits(kiln_matte_id(name));
        assert_true(isnormal(f));
        moved += (fm_bits(f) >> 23 & 0xff) == 1 || (fm_bits(f) >> 23 & 0xff) == 254;
    }
    assert_true(moved > 30); /* 4 of 256 exponents */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shares_sum_to_alpha), cmocka_unit_test(a_matte_is_the_alpha_of_the_thing_alone),
        cmocka_unit_test(names_are_those_that_are_seen), cmocka_unit_test(handles_and_places),
        cmocka_unit_test(more_names_than_room), cmocka_unit_test(ids_are_finite)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
