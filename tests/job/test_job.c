#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <jansson.h>

#include "kiln/kiln.h"
#include "tests/job/support.h"

#define PAIR(name) KILN_TEST_DATA "/gltf/pairs/" name ".gltf"

typedef struct told {
    char phases[256];
    kiln_text log;
    uint32_t progress;
    int cancel, cancel_after; /* calls of progress */
} told;

static void on_phase(const char *name, void *user) {
    told *t = user;
    strncat(t->phases, name, sizeof t->phases - strlen(t->phases) - 2);
    strcat(t->phases, " ");
}
static void on_log(const char *line, void *user) { text_append(&((told *)user)->log, line); }
static void on_progress(const kiln_progress *p, void *user) {
    told *t = user;
    assert_true(p->fraction >= 0 && p->fraction <= 1);
    if (++t->progress >= (uint32_t)t->cancel_after && t->cancel_after) t->cancel = 1;
}

/* name, value, …, NULL */
static kiln_job *job_of(fixture *f, const char *const *options) {
    kiln_job *job = kiln_job_create();
    assert_non_null(job);
    for (; *options; options += 2) assert_done(f, kiln_job_set(job, options[0], options[1], f->report));
    return job;
}

static json_t *stats_of(const kiln_job *job) {
    char *text = kiln_job_stats(job);
    assert_non_null(text);
    json_t *json = json_loads(text, 0, NULL);
    assert_non_null(json);
    free(text);
    return json;
}

/* "render.rays.camera" */
static const json_t *find(const json_t *json, const char *path) {
    char part[64];
    while (json && *path) {
        size_t length = strcspn(path, ".");
        memcpy(part, path, length);
        part[length] = '\0';
        json = json_object_get(json, part);
        path += length + (path[length] == '.');
    }
    return json;
}

static void a_file_becomes_pictures_and_statistics(void **state) {
    fixture *f = *state;
    char png[256], exr[256], stats[256];
    told t = {.log = {0}};
    kiln_job *job =
        job_of(f, (const char *const[]){"size", "24x16", "spp", "4", "output", path_in(f, "{name}_{camera}.png", png),
                                        "output", path_in(f, "####.exr", exr), "stats", path_in(f, "s.json", stats),
                                        "aov", "albedo,samples", "threads", "2", NULL});
    kiln_job_listen(job, &(kiln_job_events){.phase = on_phase, .log = on_log, .progress = on_progress, .user = &t});
    assert_done(f, kiln_job_render(job, PAIR("metallic_factor_a"), f->report));
    assert_string_equal(t.phases, "color import frame subdivide light build expose render write ");
    assert_non_null(strstr(t.log.data, "metallic_factor_a.gltf: "));
    assert_non_null(strstr(t.log.data, "colours: embedded kiln config, working space lin_rec709"));
    assert_true(t.progress > 0);
    assert_int_equal(access(path_in(f, "metallic_factor_a_eye.png", png), F_OK), 0);
    assert_int_equal(access(path_in(f, "0000.exr", exr), F_OK), 0);
    assert_int_equal(files_in(f->folder), 3);
    kiln_job_result r = kiln_job_last(job);
    assert_true(r.outputs_written == 2 && r.stats.spp == 4 && !r.noise_missed && r.film);
    json_t *written = json_load_file(stats, 0, NULL);
    assert_non_null(written);
    static const char *const paths[] = {"command",
                                        "options.size",
                                        "phases",
                                        "seconds",
                                        "scene.triangles",
                                        "scene.bounds.size",
                                        "scene.light",
                                        "scene.camera.position",
                                        "picture.color_view",
                                        "picture.layers",
                                        "render.ended_by",
                                        "render.rays.camera",
                                        "render.rays.shadow",
                                        "render.samples",
                                        "render.error",
                                        "render.discarded.invalid-ray.samples",
                                        "render.lost_energy",
                                        "outputs",
                                        "memory.peak",
                                        "memory.film",
                                        "memory.acceleration",
                                        "machine.cpu",
                                        "machine.isa",
                                        "versions.kiln",
                                        "versions.Embree",
                                        "versions.OpenColorIO",
                                        "warnings"};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++)
        if (!find(written, paths[i])) fail_msg("%s is missing", paths[i]);
    assert_int_equal(json_integer_value(find(written, "render.samples")), 24 * 16 * 4);
    assert_string_equal(json_string_value(find(written, "render.ended_by")), "spp");
    json_decref(written);
    text_free(&t.log);
    kiln_job_destroy(job);
}

/* A disk that is full: what cannot be written is an error, what can be is written. */
static void one_failing_output_does_not_take_the_others_along(void **state) {
    fixture *f = *state;
    char png[256], full[256];
    if (access("/dev/full", W_OK) != 0) skip();
    path_in(f, "full.png", full);
    assert_int_equal(symlink("/dev/full", full), 0);
    kiln_job *job = job_of(
        f, (const char *const[]){"size", "8x8", "spp", "1", "output", full, "output", path_in(f, "b.png", png), NULL});
    assert_false(kiln_job_render(job, PAIR("unlit_a"), f->report));
    assert_int_equal(kiln_report_exit_code(f->report), 1);
    assert_int_equal(kiln_job_last(job).outputs_written, 1);
    assert_int_equal(access(png, F_OK), 0);
    kiln_job_destroy(job);
}

static void nothing_is_rendered_when_an_output_cannot_be_written(void **state) {
    fixture *f = *state;
    char png[256];
    told t = {.log = {0}};
    kiln_job *job = job_of(f, (const char *const[]){"output", path_in(f, "nowhere/b.png", png), NULL});
    kiln_job_listen(job, &(kiln_job_events){.phase = on_phase, .user = &t});
    assert_false(kiln_job_render(job, PAIR("unlit_a"), f->report));
    assert_null(strstr(t.phases, "build"));
    assert_null(kiln_job_last(job).film);
    json_decref(stats_of(job));
    kiln_job_destroy(job);
}

static void cancelled_renders_are_written(void **state) {
    fixture *f = *state;
    char png[256];
    told t = {.cancel_after = 2};
    kiln_job *job =
        job_of(f, (const char *const[]){"size", "64x64", "spp", "16777216", "output", path_in(f, "c.png", png), NULL});
    kiln_job_listen(job, &(kiln_job_events){.progress = on_progress, .cancel = &t.cancel, .user = &t});
    assert_false(kiln_job_render(job, PAIR("unlit_a"), f->report));
    assert_int_equal(kiln_report_exit_code(f->report), 130);
    assert_int_equal(access(png, F_OK), 0);
    json_t *stats = stats_of(job);
    assert_string_equal(json_string_value(find(stats, "render.ended_by")), "interrupted");
    json_decref(stats);
    kiln_job_destroy(job);
}

static void cancelled_before_it_began_nothing_is_left(void **state) {
    fixture *f = *state;
    char png[256];
    told t = {.cancel = 1};
    kiln_job *job = job_of(f, (const char *const[]){"output", path_in(f, "c.png", png), NULL});
    kiln_job_listen(job, &(kiln_job_events){.cancel = &t.cancel, .user = &t});
    assert_false(kiln_job_render(job, PAIR("unlit_a"), f->report));
    assert_int_equal(kiln_report_exit_code(f->report), 130);
    assert_int_equal(files_in(f->folder), 0);
    kiln_job_destroy(job);
}

static void strict_refuses_warnings_before_it_renders(void **state) {
    fixture *f = *state;
    char png[256];
    const char *lines = PAIR("mode_lines_b"); /* lines are left out, with a warning */
    kiln_job *job =
        job_of(f, (const char *const[]){"size", "8x8", "spp", "1", "output", path_in(f, "c.png", png), NULL});
    assert_done(f, kiln_job_render(job, lines, f->report));
    assert_true(kiln_report_count(f->report, KILN_WARNING) > 0);
    kiln_report_clear(f->report);
    unlink(png);
    assert_done(f, kiln_job_set(job, "strict", "true", f->report));
    assert_false(kiln_job_render(job, lines, f->report));
    assert_int_equal(kiln_report_exit_code(f->report), 1);
    assert_int_equal(files_in(f->folder), 0);
    kiln_job_destroy(job);
}

static void missed_goals_are_told(void **state) {
    fixture *f = *state;
    char png[256];
    kiln_job *job = job_of(f, (const char *const[]){"size", "16x16", "noise", "0.001%", "spp", "8", "output",
                                                    path_in(f, "c.png", png), NULL});
    assert_done(f, kiln_job_render(job, PAIR("roughness_factor_a"), f->report));
    assert_true(kiln_job_last(job).noise_missed);
    kiln_job_destroy(job);
    job = job_of(f, (const char *const[]){"size", "16x16", "output", png, "spp", "8", NULL});
    assert_done(f, kiln_job_render(job, PAIR("roughness_factor_a"), f->report));
    assert_false(kiln_job_last(job).noise_missed);
    kiln_job_destroy(job);
}

/* A millisecond is not enough for a sample in every pixel: the picture is written, and the holes are counted. */
static void budgets_that_leave_holes_are_told(void **state) {
    fixture *f = *state;
    char png[256];
    kiln_job *job = job_of(f, (const char *const[]){"size", "512x512", "budget", "1ms", "output",
                                                    path_in(f, "holes.png", png), NULL});
    assert_done(f, kiln_job_render(job, PAIR("roughness_factor_a"), f->report));
    assert_true(kiln_job_last(job).stats.unsampled > 0 && kiln_job_last(job).outputs_written == 1);
    bool warned = false;
    for (size_t i = 0; i < kiln_report_size(f->report); i++) {
        kiln_message m = kiln_report_message(f->report, i);
        warned |= m.severity == KILN_WARNING && strstr(m.what, "pixels are black") && !strcmp(m.where, "--budget");
    }
    assert_true(warned);
    kiln_job_destroy(job);
}

/* Lights in candela and lux have no natural exposure; what is not shown, and not judged by its noise, needs none. */
static void exposures_are_chosen_where_lights_have_units(void **state) {
    fixture *f = *state;
    char path[256];
    const struct {
        const char *scene, *output, *exposure;
        bool chosen;
    } rows[] = {{PAIR("light_spot_a"), "a.png", NULL, true},
                {PAIR("light_spot_a"), "a.exr", NULL, false},
                {PAIR("light_spot_a"), "a.png", "0", false},
                {PAIR("unlit_b"), "a.png", "1", false}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        kiln_job *job = job_of(f, (const char *const[]){"size", "16x16", "spp", "4", "output",
                                                        path_in(f, rows[i].output, path), NULL});
        if (rows[i].exposure) assert_done(f, kiln_job_set(job, "exposure", rows[i].exposure, f->report));
        assert_done(f, kiln_job_render(job, rows[i].scene, f->report));
        json_t *stats = stats_of(job);
        assert_true(json_is_true(find(stats, "picture.exposure_chosen")) == rows[i].chosen);
        json_decref(stats);
        kiln_job_destroy(job);
    }
}

/* A white furnace of the scene's own: a diffuse box under even light shows its albedo; the job borrows the scene. */
static void scenes_of_a_program_are_rendered(void **state) {
    fixture *f = *state;
    char exr[256];
    add_box(f, (float[]){-1, -1, -1}, (float[]){1, 1, 1}, add_material(f, 0.5f, 0));
    assert_done(f, kiln_scene_set_environment(f->scene, &(kiln_environment){.color = {1, 1, 1}}, f->report));
    kiln_job *job = job_of(f, (const char *const[]){"size", "16x16", "spp", "64", "subdivide", "off", "output",
                                                    path_in(f, "b.exr", exr), NULL});
    assert_done(f, kiln_job_render_scene(job, f->scene, "by hand", f->report));
    const kiln_film *film = kiln_job_last(job).film;
    float rgb[16 * 16 * 3];
    kiln_film_beauty(film, rgb);
    for (int k = 0; k < 3; k++) {
        assert_near((double)rgb[3 * (8 * 16 + 8) + k], 0.5, 0.03); /* the middle */
        assert_near((double)rgb[k], 1, 1e-3);                      /* the corner */
    }
    kiln_job_destroy(job);
    assert_int_equal(kiln_scene_count(f->scene).instances, 1);
}

/* Tail lights do not light a car; a lamp above a table lights it. */
static void emitters_replace_the_studio_where_they_light_what_is_seen(void **state) {
    fixture *f = *state;
    char exr[256];
    const struct {
        float low[3], high[3];
        const char *light;
    } rows[] = {{{0.9f, 0.4f, 1}, {1, 0.5f, 1.1f}, "studio (the scene's emitters alone would leave it dark)"},
                {{-4, 4, -4}, {4, 4.1f, 8}, "the scene's own"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        kiln_scene_destroy(f->scene);
        f->scene = kiln_scene_create();
        add_box(f, (float[]){-1, -1, -1}, (float[]){1, 1, 1}, add_material(f, 0.5f, 0));
        add_box(f, rows[i].low, rows[i].high, add_material(f, 0.5f, 1.5f));
        kiln_job *job = job_of(f, (const char *const[]){"size", "64x64", "spp", "16", "orbit", "20,-20", "subdivide", "off",
                                                        "output", path_in(f, "b.exr", exr), NULL});
        assert_done(f, kiln_job_render_scene(job, f->scene, "by hand", f->report));
        json_t *stats = stats_of(job);
        assert_string_equal(json_string_value(find(stats, "scene.light")), rows[i].light);
        json_decref(stats);
        kiln_job_destroy(job);
    }
}

static void assets_are_inspected(void **state) {
    fixture *f = *state;
    kiln_job *job = kiln_job_create();
    char *text = kiln_job_inspect(job, PAIR("light_spot_b"), f->report);
    assert_non_null(text);
    json_t *json = json_loads(text, 0, NULL);
    static const char *const paths[] = {"source.format",    "source.extensions",
                                        "counts.triangles", "bounds.size",
                                        "instances",        "meshes",
                                        "materials",        "images",
                                        "lights",           "cameras",
                                        "rendering.light",  "memory_estimate.total",
                                        "warnings",         "errors",
                                        "exit_code"};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++)
        if (!find(json, paths[i])) fail_msg("%s is missing", paths[i]);
    const json_t *lights = find(json, "lights"), *extensions = find(json, "source.extensions");
    bool spot = false, known = false;
    size_t i;
    const json_t *row;
    json_array_foreach(lights, i, row) spot =
        spot || strcmp(json_string_value(json_object_get(row, "kind")), "spot") == 0;
    json_array_foreach(extensions, i, row)
        known = known || (strcmp(json_string_value(json_object_get(row, "name")), "KHR_lights_punctual") == 0 &&
                          strcmp(json_string_value(json_object_get(row, "support")), "read") == 0);
    assert_true(spot && known);
    json_decref(json);
    free(text);
    text = kiln_job_inspect(job, PAIR("no_such_file"), f->report);
    assert_int_equal(kiln_report_exit_code(f->report), 3);
    json = json_loads(text, 0, NULL);
    assert_int_equal(json_integer_value(find(json, "exit_code")), 3);
    assert_int_equal(json_array_size(find(json, "errors")), 1);
    assert_non_null(find(json, "source.file"));
    assert_null(find(json, "meshes"));
    json_decref(json);
    free(text);
    kiln_job_destroy(job);
}

/* Without its glass a pane shows what is under it; without a coat that is not there nothing changes. */
static void dropped_effects_are_measured(void **state) {
    fixture *f = *state;
    char png[256];
    told t = {.log = {0}};
    kiln_job *job = job_of(f, (const char *const[]){"size", "24x16", "spp", "8", "output", path_in(f, "a.png", png),
                                                    "effects", "-transmission,-clearcoat", NULL});
    kiln_job_listen(job, &(kiln_job_events){.log = on_log, .user = &t});
    assert_done(f, kiln_job_render(job, PAIR("transmission_rough_a"), f->report));
    json_t *stats = stats_of(job);
    assert_string_equal(json_string_value(find(stats, "ablation.removed")), "transmission");
    assert_true(json_number_value(find(stats, "ablation.difference")) > 0.05);
    assert_true(json_number_value(find(stats, "ablation.time")) > 0);
    assert_int_equal(json_array_size(find(stats, "effects")), KILN_EFFECT_COUNT);
    assert_non_null(strstr(t.log.data, "does not call for clearcoat"));
    assert_non_null(strstr(t.log.data, "without transmission the picture differs by"));
    json_decref(stats);
    text_free(&t.log);
    kiln_job_destroy(job);
}

static void the_machine_and_its_libraries_are_told(void **state) {
    fixture *f = *state;
    kiln_job *job = kiln_job_create();
    char *text = kiln_job_info(job, f->report);
    assert_non_null(text);
    json_t *json = json_loads(text, 0, NULL);
    const char *key;
    json_t *version;
    size_t count = 0;
    json_object_foreach((json_t *)find(json, "versions"), key, version) {
        if (strspn(json_string_value(version), "0123456789.") < 3)
            fail_msg("version of %s: %s", key, json_string_value(version));
        count++;
    }
    assert_int_equal(count, 11);
    assert_true(json_array_size(find(json, "color.displays")) >= 3);
    json_decref(json);
    free(text);
    kiln_job_destroy(job);
}

int main(void) {
    const struct CMUnitTest tests[] = {JOB_TEST(a_file_becomes_pictures_and_statistics),
                                       JOB_TEST(one_failing_output_does_not_take_the_others_along),
                                       JOB_TEST(nothing_is_rendered_when_an_output_cannot_be_written),
                                       JOB_TEST(budgets_that_leave_holes_are_told),
                                       JOB_TEST(cancelled_renders_are_written),
                                       JOB_TEST(cancelled_before_it_began_nothing_is_left),
                                       JOB_TEST(strict_refuses_warnings_before_it_renders),
                                       JOB_TEST(missed_goals_are_told),
                                       JOB_TEST(exposures_are_chosen_where_lights_have_units),
                                       JOB_TEST(scenes_of_a_program_are_rendered),
                                       JOB_TEST(emitters_replace_the_studio_where_they_light_what_is_seen),
                                       JOB_TEST(assets_are_inspected),
                                       JOB_TEST(dropped_effects_are_measured),
                                       JOB_TEST(the_machine_and_its_libraries_are_told)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
