/* Effects of which nothing can be seen, in files: scenes that name one (make_twins.py) are those that do not, and terms
 * that a scene does not call for change no bit of any of the shipped scenes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/text.h"
#include "kiln/import.h"
#include "kiln/render.h"
#include "tests/golden/pairs.h"

enum { SIDE = 12, SPP = 4 };

static void must(bool ok, const kiln_report *report, const char *path) {
    if (!ok) fail_msg("%s: %s", path, kiln_report_size(report) ? kiln_report_message(report, 0).what : "failed");
}

/* The picture's floats. */
static float *shoot(const char *path, kiln_effects effects, bool sky, kiln_effect_plan *plan) {
    kiln_report *report = kiln_report_create();
    kiln_scene *scene;
    kiln_renderer *renderer;
    kiln_film *film;
    must(kiln_import(path, NULL, &scene, report), report, path);
    const kiln_environment dim = {.color = {0.3f, 0.35f, 0.4f}};
    if (sky) must(kiln_scene_set_environment(scene, &dim, report), report, path);
    must(kiln_scene_commit(scene, report), report, path);
    const kiln_renderer_options options = {.threads = 1, .effects = effects};
    must(kiln_renderer_create(scene, &options, &renderer, report), report, path);
    if (plan) *plan = kiln_renderer_describe_effects(renderer, NULL);
    must(kiln_film_create(&(kiln_film_desc){.width = SIDE, .height = SIDE}, &film, report), report, path);
    must(kiln_render(renderer, &(kiln_render_options){.spp = SPP}, film, NULL, report), report, path);
    float *rgb = malloc(sizeof(float[3]) * SIDE * SIDE);
    kiln_film_beauty(film, rgb);
    kiln_film_destroy(film);
    kiln_renderer_destroy(renderer);
    kiln_scene_destroy(scene);
    kiln_report_destroy(report);
    return rgb;
}

static void must_be_equal(const float *a, const float *b, const char *what) {
    bool seen = false;
    for (int i = 0; i < 3 * SIDE * SIDE; i++) {
        seen |= a[i] > 0;
        if (memcmp(&a[i], &b[i], sizeof *a) != 0)
            fail_msg("%s: value %d is %.9g and %.9g", what, i, (double)a[i], (double)b[i]);
    }
    if (!seen) fail_msg("%s is black", what);
}

static const char twins[] = KILN_TEST_DATA "/gltf/twins";

static void check_twin(const char *file) {
    char name[64];
    kiln_text path = {0}, plain = {0};
    snprintf(name, sizeof name, "%.*s", (int)strcspn(file, "."), file);
    kiln_effect effect;
    if (!kiln_effect_find(name, &effect)) fail_msg("%s names no effect", file);
    text_format(&path, "%s/%s", twins, file);
    text_format(&plain, "%s/%.*s.plain.gltf", twins, (int)(strlen(file) - strlen(".gltf")), file);
    FILE *own = fopen(plain.data, "rb");
    if (own) fclose(own);
    else {
        text_free(&plain);
        text_format(&plain, "%s/plain.gltf", twins);
    }
    kiln_effect_plan with, without;
    float *a = shoot(path.data, (kiln_effects){0}, false, &with);
    float *b = shoot(plain.data, (kiln_effects){0}, false, &without);
    if (with.called >> effect & 1) fail_msg("%s calls for %s", file, name);
    if (with.called != without.called || with.held != without.held || with.runs != without.runs)
        fail_msg("%s is planned otherwise than its twin: %llx, %llx", file, (unsigned long long)with.called,
                 (unsigned long long)without.called);
    must_be_equal(a, b, file);
    free(a);
    free(b);
    text_free(&path);
    text_free(&plain);
}

static void effects_without_effect_are_none(void **state) {
    (void)state;
    DIR *folder = opendir(twins);
    int count = 0;
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder));) {
        const char *file = entry->d_name;
        if (*file == '.' || strcmp(file, "plain.gltf") == 0 || strstr(file, ".plain.")) continue;
        check_twin(file);
        count++;
    }
    closedir(folder);
    assert_true(count > 20);
}

static void terms_that_nobody_needs_change_no_bit(void **state) {
    (void)state;
    size_t count;
    char **names = pair_names(&count);
    for (size_t i = 0; i < count; i++) {
        kiln_text path = {0};
        text_format(&path, "%s/gltf/pairs/%s_b.gltf", KILN_TEST_DATA, names[i]);
        float *lean = shoot(path.data, (kiln_effects){0}, true, NULL);
        float *all = shoot(path.data, (kiln_effects){.all = true}, true, NULL);
        must_be_equal(lean, all, names[i]);
        free(lean);
        free(all);
        text_free(&path);
    }
    pair_names_free(names, count);
    assert_true(count > 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(effects_without_effect_are_none),
                                       cmocka_unit_test(terms_that_nobody_needs_change_no_bit)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
