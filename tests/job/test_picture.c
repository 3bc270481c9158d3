#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/file.h"
#include "job/picture.h"
#include "render/film/film.h"
#include "tests/job/support.h"

/* Three pixels of four samples: the first is met by all, the second by one in four, the third by none. What is met
 * shines with (0.5, 0.25, 0.125). */
static const float light[3] = {0.5f, 0.25f, 0.125f};
enum { PIXELS = 3, SAMPLES = 4 };
static const int hits[PIXELS] = {4, 1, 0};

static kiln_film *film_of(fixture *f, uint32_t aovs) {
    kiln_film *film;
    assert_done(f, kiln_film_create(&(kiln_film_desc){.width = PIXELS, .height = 1, .aovs = aovs}, &film, f->report));
    for (uint32_t x = 0; x < PIXELS; x++)
        for (int s = 0; s < SAMPLES; s++) {
            film_sample sample = {.alpha = s < hits[x], .depth = 2, .normal = {0, 0, 1}};
            for (int k = 0; k < 3; k++) sample.radiance[k] = s < hits[x] ? light[k] : 0;
            film_add(film, x, 0, &sample);
        }
    return film;
}

typedef struct look { kiln_color *color; kiln_view *view; } look;

/* Raw shows the working space's numbers. */
static look look_of(fixture *f, const char *view) {
    look l;
    assert_done(f, kiln_color_create(&(kiln_color_options){.config = NULL}, &l.color, f->report));
    assert_done(f, kiln_view_create(l.color, &(kiln_view_options){.view = view}, &l.view, f->report));
    return l;
}

static void forget(look l, kiln_film *film) {
    kiln_view_destroy(l.view);
    kiln_color_destroy(l.color);
    kiln_film_destroy(film);
}

/* Straight alpha: the colour of what is there, whatever share of the pixel it fills; the view sees that colour. */
static void transparent_pixels_keep_their_colour(void **state) {
    fixture *f = *state;
    const char *const views[] = {"Raw", "Khronos PBR Neutral", "Un-tone-mapped"};
    for (int v = 0; v < 3; v++) {
        kiln_film *film = film_of(f, 1u << KILN_AOV_ALPHA);
        look l = look_of(f, views[v]);
        kiln_image image;
        float expected[3];
        memcpy(expected, light, sizeof light);
        kiln_view_apply(l.view, expected, 1, 3);
        picture p = {.film = film, .color = l.color, .view = l.view, .transparent = true};
        assert_done(f, picture_display(&p, &image, f->report));
        assert_int_equal(image.channels, 4);
        const float *rgba = image.pixels;
        for (int x = 0; x < 2; x++)
            for (int k = 0; k < 3; k++) assert_near((double)rgba[4 * x + k], (double)expected[k], 1e-6);
        assert_true(rgba[3] == 1 && rgba[7] == 0.25f && rgba[11] == 0);
        image_free(&image);
        forget(l, film);
    }
}

/* As a page shows a transparent picture on that colour: display values, mixed by alpha. */
static void a_background_is_exactly_the_colour_asked_for(void **state) {
    fixture *f = *state;
    const uint8_t white[3] = {255, 128, 0};
    kiln_film *film = film_of(f, 1u << KILN_AOV_ALPHA);
    look l = look_of(f, "Khronos PBR Neutral");
    kiln_image image;
    float shown[3];
    memcpy(shown, light, sizeof light);
    kiln_view_apply(l.view, shown, 1, 3);
    picture p = {.film = film, .color = l.color, .view = l.view, .background = white};
    assert_done(f, picture_display(&p, &image, f->report));
    assert_int_equal(image.channels, 3);
    const float *rgb = image.pixels;
    for (int x = 0; x < PIXELS; x++)
        for (int k = 0; k < 3; k++) {
            double a = hits[x] / 4.0;
            assert_near((double)rgb[3 * x + k], a * (double)shown[k] + (1 - a) * white[k] / 255.0, 1e-6);
        }
    image_free(&image);
    forget(l, film);
}

static void decode(fixture *f, const char *path, kiln_image *image) {
    kiln_bytes bytes;
    kiln_where where = where_root(path);
    assert_done(f, file_read(path, 1 << 20, &bytes, NULL, f->report));
    assert_done(f, image_decode(bytes.data, bytes.size, 0, image, &where, f->report));
    file_free(&bytes);
}

/* EXR: what the film holds, light times coverage. Reading divides by it. */
static void scene_linear_files_are_premultiplied(void **state) {
    fixture *f = *state;
    kiln_film *film = film_of(f, 1u << KILN_AOV_ALPHA | 1u << KILN_AOV_DEPTH | 1u << KILN_AOV_SAMPLES);
    look l = look_of(f, NULL);
    char path[256];
    kiln_image image;
    assert_done(f, kiln_film_write(film, l.color, l.view, path_in(f, "a.exr", path), f->report));
    decode(f, path, &image);
    assert_int_equal(image.channels, 4);
    const float *rgba = image.pixels;
    for (int x = 0; x < PIXELS; x++) {
        for (int k = 0; k < 3; k++) assert_true(rgba[4 * x + k] == (hits[x] ? light[k] : 0));
        assert_true(rgba[4 * x + 3] == (float)hits[x] / 4);
    }
    image_free(&image);
    forget(l, film);
}

static void a_background_is_in_scene_linear_files_too(void **state) {
    fixture *f = *state;
    kiln_film *film = film_of(f, 1u << KILN_AOV_ALPHA);
    look l = look_of(f, NULL);
    char path[256];
    kiln_image image;
    const uint8_t shown[3] = {255, 0, 0};
    picture p = {.film = film, .color = l.color, .view = l.view, .background = shown, .background_linear = {1, 0, 0}};
    const char *const names[] = {"a.exr", "a.hdr"};
    for (int i = 0; i < 2; i++) {
        assert_done(f, picture_write(&p, path_in(f, names[i], path), f->report));
        decode(f, path, &image);
        assert_int_equal(image.channels, 3);
        const float *rgb = image.pixels;
        assert_near((double)rgb[3], 0.25 * 0.5 + 0.75, 1e-2);
        assert_near((double)rgb[4], 0.25 * 0.25, 1e-2);
        assert_near((double)rgb[6], 1, 1e-6);
        image_free(&image);
    }
    forget(l, film);
}

static void every_format_is_written(void **state) {
    fixture *f = *state;
    kiln_film *film = film_of(f, 0);
    look l = look_of(f, NULL);
    const char *const names[] = {"a.png", "a.jpg", "a.webp", "a.tif", "a.exr", "a.hdr"};
    char path[256];
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        kiln_image image;
        assert_done(f, kiln_film_write(film, l.color, l.view, path_in(f, names[i], path), f->report));
        decode(f, path, &image);
        assert_true(image.width == PIXELS && image.height == 1 && image.channels == 3);
        image_free(&image);
    }
    assert_int_equal(files_in(f->folder), sizeof names / sizeof *names);
    assert_false(kiln_film_write(film, l.color, l.view, path_in(f, "a.bmp", path), f->report));
    forget(l, film);
}

int main(void) {
    const struct CMUnitTest tests[] = {JOB_TEST(transparent_pixels_keep_their_colour),
                                       JOB_TEST(a_background_is_exactly_the_colour_asked_for),
                                       JOB_TEST(scene_linear_files_are_premultiplied),
                                       JOB_TEST(a_background_is_in_scene_linear_files_too),
                                       JOB_TEST(every_format_is_written)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
