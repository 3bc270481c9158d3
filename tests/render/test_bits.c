/* What 'the same bits' means: a fixed number of samples gives the same film sums for any number of threads, any crop,
 * any batch size, any order of tiles, in one go or in several, and for every instance of the stages. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/hash.h"
#include "render/film/film.h"
#include "render/path/path.h"
#include "tests/render/scenes.h"

enum { WIDTH = 70, HEIGHT = 45, SPP = 6 };
static const uint32_t all_aovs = (1u << KILN_AOV_COUNT) - 1, all_mattes = (1u << KILN_MATTE_COUNT) - 1;
static const char *const parts[] = {"direct", "lobe:diffuse", "lobe:specular", "lightgroup:environment", "lightgroup:light_1"};
enum { PARTS = sizeof parts / sizeof *parts };

typedef struct stage { scene_builder scene; kiln_camera view; } stage;

static int set_up(void **state) {
    stage *s = calloc(1, sizeof *s);
    s->scene = builder_make();
    add_everything(&s->scene);
    must(kiln_scene_commit(s->scene.scene, s->scene.report), s->scene.report, "committing");
    s->view = everything_camera();
    *state = s;
    return 0;
}
static int tear_down(void **state) {
    stage *s = *state;
    builder_free(&s->scene);
    free(s);
    return 0;
}

static picture shoot(stage *s, uint32_t threads, const kiln_render_options *options, const uint32_t crop[4]) {
    kiln_renderer *renderer;
    must(kiln_renderer_create(s->scene.scene, &(kiln_renderer_options){.threads = threads}, &renderer, s->scene.report),
         s->scene.report, "making a renderer");
    kiln_render_options o = *options;
    o.camera = &s->view;
    if (!o.spp) o.spp = SPP;
    kiln_film_desc desc = {.width = WIDTH, .height = HEIGHT, .aovs = all_aovs, .mattes = all_mattes, .parts = parts,
                           .part_count = PARTS};
    if (crop) memcpy(desc.crop, crop, sizeof desc.crop);
    picture p = render_with(renderer, &o, &desc, s->scene.report);
    kiln_renderer_destroy(renderer);
    return p;
}

static void same_film(const kiln_film *a, const kiln_film *b) {
    size_t pixels = (size_t)a->width * a->height;
    assert_memory_equal(a->pixels, b->pixels, pixels * sizeof *a->pixels);
    assert_memory_equal(a->counts, b->counts, pixels * sizeof *a->counts);
    assert_memory_equal(a->hits, b->hits, pixels * sizeof *a->hits);
    assert_memory_equal(a->aovs[KILN_AOV_ALBEDO], b->aovs[KILN_AOV_ALBEDO], pixels * 3 * sizeof(fixed));
    assert_memory_equal(a->aovs[KILN_AOV_NORMAL], b->aovs[KILN_AOV_NORMAL], pixels * 3 * sizeof(fixed));
    assert_memory_equal(a->aovs[KILN_AOV_DEPTH], b->aovs[KILN_AOV_DEPTH], pixels * sizeof(fixed));
    assert_memory_equal(a->aovs[KILN_AOV_POSITION], b->aovs[KILN_AOV_POSITION], pixels * 3 * sizeof(fixed));
    assert_memory_equal(a->aovs[KILN_AOV_UV], b->aovs[KILN_AOV_UV], pixels * 2 * sizeof(fixed));
    for (int i = 0; i < FILM_BALLOTS; i++) assert_memory_equal(a->ballots[i], b->ballots[i], pixels * sizeof(ballot));
    for (int i = 0; i < PARTS; i++)
        assert_memory_equal(a->parts.items[i].sums, b->parts.items[i].sums, pixels * sizeof *a->parts.items[i].sums);
    assert_memory_equal(a->beyond, b->beyond, sizeof a->beyond);
}

static void compare(stage *s, uint32_t threads, kiln_render_options options) {
    picture a = shoot(s, 1, &(kiln_render_options){.max_depth = 4}, NULL);
    options.max_depth = 4;
    picture b = shoot(s, threads, &options, NULL);
    same_film(a.film, b.film);
    picture_free(&a);
    picture_free(&b);
}

static void by_threads(void **state) {
    compare(*state, 2, (kiln_render_options){0});
    compare(*state, 7, (kiln_render_options){0});
}
static void by_batch(void **state) {
    const uint32_t sizes[] = {1, 17, 64, 1000};
    for (int i = 0; i < 4; i++) compare(*state, 2, (kiln_render_options){.batch_size = sizes[i]});
}
static void by_order_of_tiles(void **state) {
    for (uint64_t seed = 1; seed < 5; seed++)
        compare(*state, 2, (kiln_render_options){.tile_shuffle = seed << 32 | hash_pair(3, (uint32_t)seed)});
}
static void by_instance(void **state) {
    const char *isas[] = {"v2", "v3", "v4"};
    for (int i = 0; i < 3; i++)
        if (path_choose_tracer(isas[i], NULL)) compare(*state, 2, (kiln_render_options){.isa = isas[i]});
}

static void by_crop(void **state) {
    stage *s = *state;
    const uint32_t crops[3][4] = {{0, 0, 1, 1}, {13, 7, 51, 40}, {40, 0, 70, 45}};
    picture whole = shoot(s, 2, &(kiln_render_options){0}, NULL);
    for (int i = 0; i < 3; i++) {
        const uint32_t *c = crops[i];
        picture part = shoot(s, 2, &(kiln_render_options){0}, c);
        for (uint32_t y = 0; y < part.height; y++)
            for (uint32_t x = 0; x < part.width; x++) {
                size_t a = (size_t)(y + c[1]) * WIDTH + x + c[0], b = (size_t)y * part.width + x;
                assert_memory_equal(&whole.film->pixels[a], &part.film->pixels[b], sizeof(film_pixel));
            }
        picture_free(&part);
    }
    picture_free(&whole);
}

/* 16 samples at once, and 5 + 11 into the same film. */
static void in_several_goes(void **state) {
    stage *s = *state;
    kiln_renderer *renderer;
    must(kiln_renderer_create(s->scene.scene, NULL, &renderer, s->scene.report), s->scene.report, "making a renderer");
    kiln_render_options o = {.camera = &s->view, .spp = 16};
    kiln_film_desc desc = {.width = WIDTH, .height = HEIGHT, .aovs = all_aovs, .mattes = all_mattes, .parts = parts,
                           .part_count = PARTS};
    picture once = render_with(renderer, &o, &desc, s->scene.report);
    o.spp = 5; /* within a packet of four samples */
    picture twice = render_with(renderer, &o, &desc, s->scene.report);
    o.spp = 16;
    must(kiln_render(renderer, &o, twice.film, NULL, s->scene.report), s->scene.report, "rendering on");
    same_film(once.film, twice.film);
    assert_int_equal(kiln_film_spp(twice.film), 16);
    picture_free(&once);
    picture_free(&twice);
    kiln_renderer_destroy(renderer);
}

/* Sheets of light in one plane, at coordinates so round that the distance to all of them is the same to the bit: which
 * is seen is settled by the order in which Embree comes to them, and that by the rays beside. */
static scene_builder sheets(void) {
    enum { SHEETS = 40 };
    scene_builder b = builder_make();
    for (uint32_t i = 0; i < SHEETS; i++) {
        uint32_t h = hash_pair(7, i);
        float x = (float)(h % 64) / 32 - 1, y = (float)(h / 64 % 64) / 32 - 1, w = (h >> 12 & 1) ? 1 : 0.5f;
        kiln_material m = diffuse_material(0, 0, 0);
        for (int k = 0; k < 3; k++) m.emission.value[k] = (float)(h >> (14 + 5 * k) & 31);
        add_quad(&b, add_material(&b, &m), (float[]){x, y, 0, x + w, y, 0, x + w, y + w, 0, x, y + w, 0});
    }
    kiln_light lamp = light_at(KILN_LIGHT_POINT, (float[]){0, 0, 8}, (float[]){0, 0, 0}, 1); /* parts name it */
    add_light(&b, &lamp);
    must(kiln_scene_commit(b.scene, b.report), b.report, "committing");
    return b;
}

static void ties_are_settled_alike(void **state) {
    (void)state;
    stage s = {sheets(), camera_at((float[]){0.25f, 0.25f, 4}, (float[]){0.25f, 0.25f, 0}, 40)};
    void *there = &s;
    by_batch(&there);
    by_crop(&there);
    in_several_goes(&there);
    builder_free(&s.scene);
}

/* Another seed is another picture: the comparisons above compare something. */
static void another_seed_differs(void **state) {
    picture a = shoot(*state, 2, &(kiln_render_options){0}, NULL), b = shoot(*state, 2, &(kiln_render_options){.seed = 1}, NULL);
    assert_memory_not_equal(a.film->pixels, b.film->pixels, (size_t)WIDTH * HEIGHT * sizeof(film_pixel));
    picture_free(&a);
    picture_free(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(by_threads), cmocka_unit_test(by_batch),        cmocka_unit_test(by_order_of_tiles),
        cmocka_unit_test(by_instance), cmocka_unit_test(by_crop),        cmocka_unit_test(in_several_goes),
        cmocka_unit_test(ties_are_settled_alike), cmocka_unit_test(another_seed_differs)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
