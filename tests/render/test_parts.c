/* Parts of the beauty: they sum to it, and each is what its name says. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/film/film.h"
#include "tests/render/scenes.h"

enum { WIDTH = 40, HEIGHT = 30, SPP = 8, NAMES = 64 };

typedef struct names { const char *items[NAMES]; uint32_t count; char texts[NAMES][64]; } names;

static void name(names *n, const char *prefix, const char *text) {
    snprintf(n->texts[n->count], sizeof n->texts[0], "%s%s", prefix, text);
    n->items[n->count] = n->texts[n->count];
    n->count++;
}

static void name_all(names *n, const scene_builder *b) {
    const char *const *groups;
    uint32_t count;
    *n = (names){0};
#define NAME_LOBE(id, text, what) name(n, "lobe:", text);
    KILN_LOBES(NAME_LOBE)
#undef NAME_LOBE
    name(n, "", "indirect"), name(n, "", "direct"), name(n, "", "emission");
    must(kiln_scene_light_groups(b->scene, &groups, &count, b->report), b->report, "listing lights");
    for (uint32_t i = 0; i < count; i++) name(n, "lightgroup:", groups[i]);
    free((void *)groups);
}

/* In the order in which the film lists them, or backwards. */
static void sums_are_exact(const kiln_film *f, const float *beauty, bool backwards) {
    size_t pixels = (size_t)f->width * f->height;
    float *sum = malloc(3 * pixels * sizeof *sum), *part = malloc(3 * pixels * sizeof *part);
    uint32_t count = kiln_film_part_count(f);
    for (int d = 0; d < KILN_DIVISION_COUNT; d++) {
        bool there = false;
        memset(sum, 0, 3 * pixels * sizeof *sum);
        for (uint32_t i = 0; i < count; i++) {
            uint32_t which = backwards ? count - 1 - i : i;
            if (!(kiln_film_describe_part(f, which).divisions >> d & 1)) continue;
            there = true;
            kiln_film_part(f, which, part);
            for (size_t k = 0; k < 3 * pixels; k++) sum[k] += part[k];
        }
        for (size_t k = 0; there && k < 3 * pixels; k++)
            if (memcmp(&sum[k], &beauty[k], sizeof *sum) != 0)
                fail_msg("division %d, value %zu: the parts sum to %a, the beauty is %a", d, k, (double)sum[k],
                         (double)beauty[k]);
    }
    free(sum);
    free(part);
}

static fixed beauty_of(const kiln_film *f, size_t pixel, int k) {
    fixed sum = 0;
    for (int r = 0; r < KILN_REPLICATES; r++) sum += f->pixels[pixel].sum[r][k];
    return sum;
}

/* As integers, without any rest. */
static void divisions_are_complete(const kiln_film *f) {
    assert_int_equal(kiln_film_part_count(f), f->parts.count);
    for (size_t i = 0; i < (size_t)f->width * f->height; i++)
        for (int k = 0; k < 3; k++)
            for (int d = 0; d < KILN_DIVISION_COUNT; d++) {
                fixed sum = 0;
                for (uint32_t p = 0; p < f->parts.count; p++)
                    if (f->parts.items[p].divisions >> d & 1) sum += f->parts.items[p].sums[i][k];
                if (sum != beauty_of(f, i, k))
                    fail_msg("division %d, pixel %zu, channel %d: %g is missing", d, i, k,
                             fixed_to_double(beauty_of(f, i, k) - sum));
            }
}

/* Every kind of light and of surface; with parts the beauty has the bits that it has without. */
static void parts_sum_to_the_beauty(void **state) {
    (void)state;
    const kiln_render_options kinds[] = {
        {.seed = 1}, {.estimator = KILN_ESTIMATOR_NEE}, {.estimator = KILN_ESTIMATOR_BSDF}, {.max_depth = 2},
        {.background = KILN_BACKGROUND_COLOR, .background_color = {1, 2, 3}}};
    scene_builder b = builder_make();
    add_everything(&b);
    must(kiln_scene_commit(b.scene, b.report), b.report, "committing");
    kiln_renderer *renderer;
    must(kiln_renderer_create(b.scene, NULL, &renderer, b.report), b.report, "making a renderer");
    names all;
    name_all(&all, &b);
    kiln_camera view = everything_camera();
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        kiln_render_options o = kinds[i];
        o.camera = &view, o.spp = SPP;
        kiln_film_desc desc = {.width = WIDTH, .height = HEIGHT};
        picture plain = render_with(renderer, &o, &desc, b.report);
        desc.parts = all.items, desc.part_count = all.count;
        picture split = render_with(renderer, &o, &desc, b.report);
        assert_memory_equal(plain.film->pixels, split.film->pixels, WIDTH * HEIGHT * sizeof(film_pixel));
        divisions_are_complete(split.film);
        sums_are_exact(split.film, split.rgb, false);
        sums_are_exact(split.film, split.rgb, true);
        picture_free(&plain);
        picture_free(&split);
    }
    const char *some[] = {"lobe:diffuse", "direct", "lightgroup:environment"};
    kiln_film_desc desc = {.width = WIDTH, .height = HEIGHT, .parts = some, .part_count = 3};
    kiln_render_options o = {.camera = &view, .spp = SPP};
    picture split = render_with(renderer, &o, &desc, b.report);
    assert_int_equal(kiln_film_part_count(split.film), 6);
    assert_true(kiln_film_describe_part(split.film, 5).rest);
    assert_string_equal(kiln_film_describe_part(split.film, 5).name, "lightgroup:*");
    sums_are_exact(split.film, split.rgb, false);
    picture_free(&split);
    kiln_renderer_destroy(renderer);
    builder_free(&b);
}

/* A floor under a lamp, a point light and a sun. */
typedef struct room { scene_builder b; kiln_camera view; } room;
enum { LAMP = 1, POINT = 2, SUN = 4 };

static room room_of(const kiln_material *floor, int lights) {
    room r = {builder_make(), camera_at((float[3]){0, 2, 3}, (float[3]){0, .5f, 0}, 50)};
    kiln_material lamp = diffuse_material(0.2f, 0.2f, 0.2f);
    lamp.name = "lamp.1";
    for (int k = 0; k < 3; k++) lamp.emission.value[k] = lights & LAMP ? 5 : 0;
    lamp.double_sided = true;
    add_quad(&r.b, add_material(&r.b, floor), (float[12]){-2, 0, 2, 2, 0, 2, 2, 0, -2, -2, 0, -2});
    add_quad(&r.b, add_material(&r.b, &lamp),
             (float[12]){-.5f, 1.2f, -1, .5f, 1.2f, -1, .5f, 1.7f, -1, -.5f, 1.7f, -1});
    kiln_light point = light_at(KILN_LIGHT_POINT, (float[3]){1, 1, 0}, (float[3]){0, 0, 0}, 1);
    kiln_light sun = light_at(KILN_LIGHT_DISTANT, (float[3]){-1, 3, 1}, (float[3]){0, 0, 0}, 0.5f);
    point.name = "key", sun.name = "key2", sun.angle_rad = 0.2f;
    if (lights & POINT) add_light(&r.b, &point);
    if (lights & SUN) add_light(&r.b, &sun);
    return r;
}

static picture shoot(room *r, const names *n, kiln_estimator estimator, uint32_t spp) {
    kiln_renderer *renderer;
    must(kiln_renderer_create(r->b.scene, NULL, &renderer, r->b.report), r->b.report, "making a renderer");
    kiln_film_desc desc = {.width = WIDTH, .height = HEIGHT};
    if (n) desc.parts = n->items, desc.part_count = n->count;
    kiln_render_options o = {.camera = &r->view, .spp = spp, .estimator = estimator};
    picture p = render_with(renderer, &o, &desc, r->b.report);
    kiln_renderer_destroy(renderer);
    return p;
}

static double mean_of_part(const kiln_film *f, const char *name) {
    float *rgb = malloc(3 * WIDTH * HEIGHT * sizeof *rgb);
    double sum = -1;
    for (uint32_t i = 0; i < kiln_film_part_count(f); i++) {
        if (strcmp(kiln_film_describe_part(f, i).name, name) != 0) continue;
        kiln_film_part(f, i, rgb);
        sum = 0;
        for (int k = 0; k < 3 * WIDTH * HEIGHT; k++) sum += (double)rgb[k];
    }
    free(rgb);
    if (sum < 0) fail_msg("there is no part %s", name);
    return sum / (3 * WIDTH * HEIGHT);
}

static void close_to(double value, double expected, double tolerance, const char *what) {
    if (!(fabs(value - expected) <= tolerance * expected)) fail_msg("%s: %g, not %g", what, value, expected);
}

/* A group of light is what the picture is with that light alone. 2 %: five standard errors at 64 samples. */
static void groups_are_pictures_of_one_light(void **state) {
    (void)state;
    static const struct { int lights; const char *name; } rows[] = {
        {LAMP, "lightgroup:lamp_1"}, {POINT, "lightgroup:key"}, {SUN, "lightgroup:key2"}};
    kiln_material floor = kiln_material_default();
    floor.metallic.value = 0, floor.roughness.value = 0.3f;
    room all = room_of(&floor, LAMP | POINT | SUN);
    must(kiln_scene_commit(all.b.scene, all.b.report), all.b.report, "committing");
    names n;
    name_all(&n, &all.b);
    picture p = shoot(&all, &n, KILN_ESTIMATOR_MIS, 64);
    for (int i = 0; i < 3; i++) {
        room one = room_of(&floor, rows[i].lights);
        must(kiln_scene_commit(one.b.scene, one.b.report), one.b.report, "committing");
        picture alone = shoot(&one, NULL, KILN_ESTIMATOR_MIS, 64);
        close_to(mean_of_part(p.film, rows[i].name), alone.mean, 0.02, rows[i].name);
        picture_free(&alone);
        builder_free(&one.b);
    }
    picture_free(&p);
    builder_free(&all.b);
}

/* What a lobe sends on does not depend on whether light was sampled or found, which are shared out by different code. */
static void lobes_do_not_depend_on_the_estimator(void **state) {
    (void)state;
    static const char *const lobes[] = {"emission", "lobe:diffuse", "lobe:specular", "direct"};
    kiln_material floor = kiln_material_default();
    floor.metallic.value = 0.3f, floor.roughness.value = 0.5f, floor.base_color.value[0] = 0.5f;
    room r = room_of(&floor, LAMP);
    must(kiln_scene_commit(r.b.scene, r.b.report), r.b.report, "committing");
    names n;
    name_all(&n, &r.b);
    picture nee = shoot(&r, &n, KILN_ESTIMATOR_NEE, 256), bsdf = shoot(&r, &n, KILN_ESTIMATOR_BSDF, 256);
    for (int i = 0; i < 4; i++)
        close_to(mean_of_part(bsdf.film, lobes[i]), mean_of_part(nee.film, lobes[i]), 0.03, lobes[i]);
    assert_true(mean_of_part(nee.film, "lobe:diffuse") > 0 && mean_of_part(nee.film, "lobe:specular") > 0);
    assert_true(mean_of_part(nee.film, "lobe:transmission") == 0 && mean_of_part(nee.film, "emission") > 0);
    close_to(mean_of_part(bsdf.film, "indirect"), mean_of_part(nee.film, "indirect"), 0.1, "indirect"); /* rare */
    picture_free(&nee);
    picture_free(&bsdf);
    builder_free(&r.b);
}

/* A lobe alone has all the light that is scattered. */
static void a_lobe_alone_has_all(void **state) {
    (void)state;
    static const struct { float metallic, specular, transmission, roughness; const char *names[2]; } rows[] = {
        {0, 0, 0, 1, {"lobe:diffuse", NULL}},      {1, 1, 0, 0.4f, {"lobe:specular", NULL}},
        {1, 1, 0, 0, {"lobe:specular", NULL}},     {0, 1, 1, 0.3f, {"lobe:specular", "lobe:transmission"}},
        {0, 1, 1, 0, {"lobe:specular", "lobe:transmission"}}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        kiln_material floor = kiln_material_default();
        floor.metallic.value = rows[i].metallic, floor.specular.value = rows[i].specular;
        floor.roughness.value = rows[i].roughness, floor.transmission.value = rows[i].transmission;
        if (rows[i].transmission > 0) floor.layers |= KILN_LAYER_TRANSMISSION;
        room r = room_of(&floor, LAMP | POINT | SUN);
        set_environment(&r.b, 0, 0.1f, 0.1f, 0.1f);
        must(kiln_scene_commit(r.b.scene, r.b.report), r.b.report, "committing");
        names n;
        name_all(&n, &r.b);
        /* The lamp is diffuse, and dark but for what it sends out: on its own pixels nothing else is asked. */
        r.view = camera_at((float[3]){0, 1, 2.5f}, (float[3]){0, 0, 0.8f}, 25);
        picture p = shoot(&r, &n, KILN_ESTIMATOR_MIS, 8);
        double sum = mean_of_part(p.film, "emission");
        for (int k = 0; k < 2 && rows[i].names[k]; k++) {
            assert_true(mean_of_part(p.film, rows[i].names[k]) > 0);
            sum += mean_of_part(p.film, rows[i].names[k]);
        }
        close_to(sum, p.mean, 1e-6, "lobes");
        picture_free(&p);
        builder_free(&r.b);
    }
}

/* What a clear coat reflects does not depend on what lies under it, though that loses what the coat keeps. */
static void a_coat_is_the_same_on_any_base(void **state) {
    (void)state;
    double coats[2];
    for (int white = 0; white < 2; white++) {
        kiln_material floor = diffuse_material((float)white, (float)white, (float)white);
        floor.layers = KILN_LAYER_CLEARCOAT, floor.clearcoat.value = 1, floor.clearcoat_roughness.value = 0.3f;
        room r = room_of(&floor, LAMP);
        must(kiln_scene_commit(r.b.scene, r.b.report), r.b.report, "committing");
        names n;
        name_all(&n, &r.b);
        picture p = shoot(&r, &n, KILN_ESTIMATOR_MIS, 128);
        coats[white] = mean_of_part(p.film, "lobe:clearcoat");
        if (white) assert_true(mean_of_part(p.film, "lobe:diffuse") > coats[white]);
        picture_free(&p);
        builder_free(&r.b);
    }
    close_to(coats[1], coats[0], 0.05, "the coat's reflection"); /* the lamp is a little grey, and seen in it */
}

static void wrong_names_are_refused(void **state) {
    (void)state;
    static const char *const wrong[] = {"", "lobe:", "lobe:diffus", "lightgroup:", "lobes", "Direct"};
    kiln_material floor = kiln_material_default();
    room r = room_of(&floor, POINT);
    kiln_film *film;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_false(kiln_film_create(&(kiln_film_desc){.width = 1, .height = 1, .parts = &wrong[i], .part_count = 1},
                                      &film, r.b.report));
    builder_free(&r.b);
    r = room_of(&floor, POINT);
    must(kiln_scene_commit(r.b.scene, r.b.report), r.b.report, "committing");
    const char *missing = "lightgroup:kye";
    const kiln_film_desc desc = {.width = 1, .height = 1, .parts = &missing, .part_count = 1};
    must(kiln_film_create(&desc, &film, r.b.report), r.b.report, "making a film");
    kiln_renderer *renderer;
    must(kiln_renderer_create(r.b.scene, NULL, &renderer, r.b.report), r.b.report, "making a renderer");
    assert_false(kiln_render(renderer, &(kiln_render_options){.camera = &r.view, .spp = 1}, film, NULL, r.b.report));
    assert_non_null(strstr(kiln_report_message(r.b.report, 0).what, "no light 'kye'; it has key, environment"));
    kiln_film_destroy(film);
    kiln_renderer_destroy(renderer);
    builder_free(&r.b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_sum_to_the_beauty), cmocka_unit_test(groups_are_pictures_of_one_light),
        cmocka_unit_test(lobes_do_not_depend_on_the_estimator), cmocka_unit_test(a_lobe_alone_has_all),
        cmocka_unit_test(a_coat_is_the_same_on_any_base),
        cmocka_unit_test(wrong_names_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
