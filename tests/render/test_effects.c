/* The plan of effects: who calls for what, what that costs a picture, and that nothing else does. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/context.h"
#include "tests/render/scenes.h"

enum { WIDTH = 28, HEIGHT = 20, SPP = 4 };

static kiln_effect_plan plan_of(scene_builder *b, const kiln_camera *view) {
    kiln_effect_plan plan;
    if (!b->scene->committed) must(kiln_scene_commit(b->scene, b->report), b->report, "committing");
    must(kiln_plan_effects(b->scene, view, NULL, &plan, b->report), b->report, "planning");
    return plan;
}

static picture shoot(scene_builder *b, const kiln_camera *view, kiln_effects effects, kiln_effect_plan *plan) {
    kiln_renderer *renderer;
    const kiln_renderer_options options = {.threads = 2, .texture_filter = KILN_TEXTURES_MIP, .effects = effects};
    if (!b->scene->committed) must(kiln_scene_commit(b->scene, b->report), b->report, "committing");
    must(kiln_renderer_create(b->scene, &options, &renderer, b->report), b->report, "making a renderer");
    if (plan) *plan = kiln_renderer_describe_effects(renderer, view);
    picture p = render_with(renderer, &(kiln_render_options){.camera = view, .spp = SPP, .seed = 5},
                            &(kiln_film_desc){.width = WIDTH, .height = HEIGHT}, b->report);
    kiln_renderer_destroy(renderer);
    return p;
}

static void same_bits(const picture *a, const picture *b, const char *what) {
    size_t pixels = (size_t)a->width * a->height;
    for (size_t i = 0; i < pixels; i++)
        if (memcmp(&a->film->pixels[i], &b->film->pixels[i], sizeof a->film->pixels[i]) != 0)
            fail_msg("%s: pixel %zu differs: %.9g %.9g", what, i, (double)a->rgb[3 * i], (double)b->rgb[3 * i]);
}

/* A floor under one lamp: nothing but area lights. */
static void add_plain(scene_builder *b) {
    kiln_material floor = diffuse_material(0.5f, 0.4f, 0.3f), lamp = diffuse_material(0, 0, 0);
    floor.double_sided = lamp.double_sided = true;
    lamp.emission.value[0] = lamp.emission.value[1] = lamp.emission.value[2] = 5;
    add_quad(b, add_material(b, &floor), (float[]){-2, 0, 2, 2, 0, 2, 2, 0, -2, -2, 0, -2});
    add_quad(b, add_material(b, &lamp), (float[]){-1, 2, -1, 1, 2, -1, 1, 2, 1, -1, 2, 1});
}
static kiln_camera plain_camera(void) { return camera_at((float[3]){0, 1.5f, 4}, (float[3]){0, 0.6f, 0}, 50); }

static void a_plain_scene_calls_for_little(void **state) {
    (void)state;
    scene_builder b = builder_make();
    add_plain(&b);
    kiln_camera view = plain_camera();
    kiln_effect_plan plan = plan_of(&b, &view);
    assert_int_equal(plan.called, EFFECT(AREA_LIGHTS)); /* the halves of a lamp are one light */
    assert_int_equal(plan.runs, plan.called);
    const kiln_effect_use *lights = &plan.uses[KILN_EFFECT_AREA_LIGHTS];
    assert_true(lights->caller_count == 1 && lights->callers[0].kind == KILN_CALLED_BY_MATERIAL && lights->callers[0].id == 2);
    builder_free(&b);
}

static void everything_is_called_for(void **state) {
    (void)state;
    scene_builder b = builder_make();
    add_everything(&b);
    kiln_camera view = everything_camera();
    kiln_effect_plan plan;
    picture p = shoot(&b, &view, (kiln_effects){0}, &plan);
    const uint64_t all = KILN_EFFECT_BIT(KILN_EFFECT_COUNT) - 1, missing = EFFECT(MOTION);
    for (int e = 0; e < KILN_EFFECT_COUNT; e++)
        if ((plan.called >> e & 1) != ((all & ~missing) >> e & 1))
            fail_msg("%s is %s", kiln_effect_describe((kiln_effect)e).name, plan.called >> e & 1 ? "called for" : "not");
    picture_free(&p);
    builder_free(&b);
}

static void terms_that_nobody_needs_change_no_bit(void **state) {
    (void)state;
    for (int rich = 0; rich < 2; rich++) {
        scene_builder b = builder_make();
        (rich ? add_everything : add_plain)(&b);
        kiln_camera view = rich ? everything_camera() : plain_camera();
        picture lean = shoot(&b, &view, (kiln_effects){0}, NULL);
        picture all = shoot(&b, &view, (kiln_effects){.all = true}, NULL);
        assert_true(lean.mean > 0);
        same_bits(&lean, &all, rich ? "everything" : "plain");
        picture_free(&lean);
        picture_free(&all);
        builder_free(&b);
    }
}

/* Each effect's machinery, data and structures included, in a scene that has no use for it. */
static void forced_effects_change_no_bit(void **state) {
    (void)state;
    scene_builder b = builder_make();
    add_plain(&b);
    kiln_camera view = plain_camera();
    picture lean = shoot(&b, &view, (kiln_effects){0}, NULL);
    for (int e = 0; e < KILN_EFFECT_COUNT; e++) {
        kiln_effect_plan plan;
        picture p = shoot(&b, &view, (kiln_effects){.forced = KILN_EFFECT_BIT(e)}, &plan);
        assert_true(plan.runs >> e & 1 && plan.held >> e & 1 && plan.uses[e].runs);
        if (e == KILN_EFFECT_VERTEX_COLORS) assert_float_equal(p.mean, lean.mean, 1e-6); /* white, but for rounding */
        else same_bits(&lean, &p, kiln_effect_describe((kiln_effect)e).name);
        picture_free(&p);
    }
    picture_free(&lean);
    builder_free(&b);
}

static void removed_effects_are_gone(void **state) {
    (void)state;
    scene_builder b = builder_make();
    add_everything(&b);
    kiln_camera view = everything_camera();
    picture whole = shoot(&b, &view, (kiln_effects){0}, NULL);
    for (int e = 0; e < KILN_EFFECT_COUNT; e++) {
        kiln_effect_plan plan;
        bool removable = kiln_effect_describe((kiln_effect)e).removable;
        picture p = shoot(&b, &view, (kiln_effects){.removed = KILN_EFFECT_BIT(e)}, &plan);
        if (removable && plan.called >> e & 1) fail_msg("%s stays", kiln_effect_describe((kiln_effect)e).name);
        bool same = memcmp(p.film->pixels, whole.film->pixels, sizeof *p.film->pixels * WIDTH * HEIGHT) == 0;
        /* No back is seen from where the camera stands, and no solid of the room shares a wall with another. */
        bool shows = removable && e != KILN_EFFECT_CULLING && e != KILN_EFFECT_NESTED_MEDIA;
        if (same == shows)
            fail_msg("%s: the picture is %s", kiln_effect_describe((kiln_effect)e).name, same ? "the same" : "another");
        assert_true(isfinite(p.mean));
        picture_free(&p);
    }
    picture_free(&whole);
    builder_free(&b);
}

/* Coverage without alpha is none, whatever the file calls it; and so on: what only the API can say. */
static void nothing_is_called_for_by_name(void **state) {
    (void)state;
    scene_builder b = builder_make();
    kiln_material m[4];
    for (int i = 0; i < 4; i++) m[i] = diffuse_material(0.5f, 0.5f, 0.5f), m[i].double_sided = true;
    m[0].layers = KILN_LAYER_VOLUME | KILN_LAYER_VOLUME_SCATTER | KILN_LAYER_DISPERSION | KILN_LAYER_TRANSMISSION;
    m[0].thickness.value = m[0].attenuation_distance = m[0].dispersion = m[0].multiscatter_color[0] = 1;
    m[1].layers = KILN_LAYER_SHEEN | KILN_LAYER_CLEARCOAT | KILN_LAYER_ANISOTROPY | KILN_LAYER_IRIDESCENCE;
    m[2].alpha_mode = KILN_ALPHA_BLEND;
    m[3].emission.value[0] = 1;
    m[3].emission.texture.image = add_image(&b, (float[3]){0, 0, 0}, 1, 1);
    for (int i = 0; i < 4; i++) add_quad(&b, add_material(&b, &m[i]), (float[]){-2, 0, 2, 2, 0, 2, 2, 0, -2, -2, 0, -2});
    kiln_light off = light_at(KILN_LIGHT_POINT, (float[3]){0, 3, 0}, (float[3]){0, 0, 0}, 0), on = off;
    on.intensity = 5;
    add_light(&b, &off);
    add_light(&b, &on);
    set_environment(&b, add_image(&b, (float[6]){0}, 2, 1), 1, 1, 1);
    kiln_camera view = plain_camera();
    assert_int_equal(plan_of(&b, &view).called, EFFECT(PUNCTUAL_LIGHTS));
    kiln_effect_plan plan; /* which learns of the surroundings when it loads them */
    picture p = shoot(&b, &view, (kiln_effects){0}, &plan);
    assert_int_equal(plan.called & ~EFFECT(MANY_LIGHTS), EFFECT(PUNCTUAL_LIGHTS));
    assert_true(p.mean > 0);
    view.lens_radius = 0.1;
    assert_true(HAS(plan_of(&b, &view).called, THIN_LENS));
    picture_free(&p);
    builder_free(&b);
}

static void motion_is_what_moves(void **state) {
    (void)state;
    for (int moves = 0; moves < 2; moves++) {
        scene_builder b = builder_make();
        add_plain(&b);
        double transforms[32] = {0};
        for (int t = 0; t < 2; t++)
            for (int k = 0; k < 4; k++) transforms[16 * t + 5 * k] = 1;
        transforms[16 + 12] = moves;
        const kiln_instance_desc copy = {.name = "copy", .mesh = 1, .time_count = 2, .transforms = transforms};
        must(kiln_scene_add_instance(b.scene, &copy, NULL, b.report), b.report, "adding a copy");
        kiln_effect_plan plan = plan_of(&b, NULL);
        assert_int_equal(plan.uses[KILN_EFFECT_MOTION].called, moves);
        if (moves) assert_string_equal(plan.uses[KILN_EFFECT_MOTION].callers[0].name, "copy");
        builder_free(&b);
    }
}

static void callers_are_counted_and_the_first_are_named(void **state) {
    (void)state;
    scene_builder b = builder_make();
    static const char *const names[] = {"one", "two", "three", "four", "five"};
    for (int i = 0; i < 5; i++) {
        kiln_material m = kiln_material_default();
        m.name = names[i];
        m.layers = KILN_LAYER_CLEARCOAT;
        m.clearcoat.value = i == 1 ? 0 : 1;
        add_quad(&b, add_material(&b, &m), (float[]){-2, 0, 2, 2, 0, 2, 2, 0, -2, -2, 0, -2});
    }
    kiln_effect_use use = plan_of(&b, NULL).uses[KILN_EFFECT_CLEARCOAT];
    assert_true(use.called && use.caller_count == 4);
    assert_string_equal(use.callers[0].name, "one");
    assert_string_equal(use.callers[2].name, "four");
    builder_free(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plain_scene_calls_for_little),       cmocka_unit_test(everything_is_called_for),
        cmocka_unit_test(terms_that_nobody_needs_change_no_bit), cmocka_unit_test(forced_effects_change_no_bit),
        cmocka_unit_test(removed_effects_are_gone),             cmocka_unit_test(nothing_is_called_for_by_name),
        cmocka_unit_test(motion_is_what_moves),                 cmocka_unit_test(callers_are_counted_and_the_first_are_named)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
