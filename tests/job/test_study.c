/* The arithmetic of studies, and that a study which was cut short goes on to the same rows. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "job/study_math.h"
#include "kiln/job.h"

#define assert_near(a, b, tolerance) assert_true(fabs((double)(a) - (double)(b)) <= (tolerance))

static void students_quantiles_are_those_of_tables(void **state) {
    (void)state;
    static const struct { size_t freedom; double t; } rows[] = {
        {1, 12.706}, {2, 4.303}, {3, 3.182}, {10, 2.228}, {11, 2.201}, {20, 2.086}, {30, 2.042}, {120, 1.980}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        assert_near(study_student(rows[i].freedom), rows[i].t, 6e-4);
}

static void intervals_have_a_closed_form(void **state) {
    (void)state;
    const double values[] = {1, 2, 3, 4, NAN}, powers[] = {1, 10, 100};
    study_range r = study_interval(values, 5); /* s = √(5/3), over √4 */
    assert_near(r.mean, 2.5, 1e-12);
    assert_near(r.high - r.mean, 3.1824 * sqrt(5.0 / 3) / 2, 1e-4);
    assert_near(r.mean - r.low, r.high - r.mean, 1e-12);
    r = study_interval_of_logs(powers, 3); /* logs 0, 1, 2 of ten: s = 1 */
    assert_near(r.mean, 10, 1e-9);
    assert_near(log10(r.high), 1 + 4.3027 / sqrt(3), 1e-4);
    r = study_interval(values, 1);
    assert_true(r.mean == 1 && isnan(r.low));
    assert_true(isnan(study_interval(values + 4, 1).mean));
    assert_true(isnan(study_interval_of_logs((double[]){1, 0}, 2).mean));
}

static void slopes_are_those_of_lines(void **state) {
    (void)state;
    const double x[] = {1, 4, 16, 64}, exact[] = {8, 4, 2, 1}, noisy[] = {8, 4.4, 1.8, 1};
    study_range r = study_slope_of_logs(x, exact, 4);
    assert_near(r.mean, -0.5, 1e-12);
    assert_near(r.high - r.low, 0, 1e-6);
    r = study_slope_of_logs(x, noisy, 4);
    assert_true(r.low < -0.5 && r.high > -0.5 && r.high - r.low > 0.05);
    assert_true(isnan(study_slope_of_logs(x, exact, 2).mean));
    assert_true(isnan(study_slope_of_logs((double[]){1, 1, 1}, exact, 3).mean));
    assert_true(isnan(study_slope_of_logs(x, (double[]){1, NAN, 0}, 3).mean));
}

static void the_front_is_who_nobody_beats(void **state) {
    (void)state;
    const double time[] = {1, 2, 3, 2, 4, NAN, 1}, error[] = {5, 3, 4, 3, 1, 0, 5};
    bool front[7];
    study_front(time, error, 7, front);
    assert_true(front[0] && front[1] && front[3] && front[4] && front[6]); /* equals beat each other not */
    assert_false(front[2]);
    assert_false(front[5]);
}

/* A folder for a study, and the options of a small one. */
typedef struct bench {
    char folder[64];
    kiln_report *report;
    volatile int cancel;
    int renders, cancel_after; /* 0: never */
} bench;

static int open_bench(void **state) {
    bench *b = calloc(1, sizeof *b);
    strcpy(b->folder, "study_XXXXXX");
    b->report = kiln_report_create();
    *state = b;
    return mkdtemp(b->folder) ? 0 : -1;
}

static int close_bench(void **state) {
    bench *b = *state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf %s", b->folder);
    int code = system(command);
    kiln_report_destroy(b->report);
    free(b);
    return code;
}

static void on_progress(const kiln_progress *p, void *user) {
    bench *b = user;
    (void)p;
    if (b->cancel_after && ++b->renders >= b->cancel_after) b->cancel = 1;
}

static json_t *study(bench *b, const char *const *options) {
    kiln_job *job = kiln_job_create();
    kiln_job_listen(job, &(kiln_job_events){.progress = on_progress, .cancel = &b->cancel, .user = b});
    for (; *options; options += 2) assert_true(kiln_job_set(job, options[0], options[1], b->report));
    char *text = kiln_job_study(job, NULL, b->report);
    json_t *json = json_loads(text, 0, NULL);
    assert_non_null(json);
    free(text);
    kiln_job_destroy(job);
    return json;
}
#define small(b, ...)                                                                                                  \
    study(b, (const char *const[]){"preset", "estimators", "output", (b)->folder, "size", "8x8", "spp", "4",           \
                                   ##__VA_ARGS__, NULL})

/* A file of the study; free(). */
static char *contents(const bench *b, const char *name) {
    char path[128];
    kiln_bytes bytes;
    snprintf(path, sizeof path, "%s/%s", b->folder, name);
    assert_true(file_read(path, 1 << 26, &bytes, NULL, b->report));
    return (char *)bytes.data;
}

/* Rows without what depends on the machine, by name, samples and seed: the columns up to the times, and the errors. */
static int by_text(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }
static size_t split(char *text, char *rows[], size_t most) {
    size_t count = 0;
    for (char *line = strtok(text, "\n"); line && count < most; line = strtok(NULL, "\n")) rows[count++] = line;
    for (size_t i = 0; i < count; i++) { /* cuts seconds and cpu_seconds out, and the stages off */
        char *at = rows[i], *from, *to;
        for (int k = 0; k < 3; k++) at = strchr(at, ',') + 1;
        from = at;
        for (int k = 0; k < 2; k++) at = strchr(at, ',') + 1;
        to = at;
        for (int k = 0; k < 13; k++) at = strchr(at, ',') + 1;
        at[-1] = '\0';
        memmove(from, to, strlen(to) + 1);
    }
    qsort(rows, count, sizeof *rows, by_text);
    return count;
}

static void an_interrupted_study_goes_on_to_the_same_rows(void **state) {
    bench *b = *state, whole = {.report = b->report};
    json_t *json;
    enum { ROWS = 5 * 2 * 4 }; /* configurations, levels, seeds */
    char *rows[2][ROWS + 2];
    strcpy(whole.folder, "study_XXXXXX");
    assert_non_null(mkdtemp(whole.folder));
    json_decref(small(&whole));
    b->cancel_after = 30;
    json = small(b);
    assert_false(json_is_true(json_object_get(json, "complete")));
    json_int_t done = json_integer_value(json_object_get(json, "renders"));
    assert_true(done > 0 && done < ROWS);
    assert_int_equal(json_integer_value(json_object_get(json, "exit_code")), 130);
    json_decref(json);
    /* And a line that a power failure has torn. */
    char path[128];
    snprintf(path, sizeof path, "%s/rows.csv", b->folder);
    FILE *file = fopen(path, "a");
    fputs("base,4,3,0.12", file);
    fclose(file);
    kiln_report_clear(b->report);
    b->cancel = 0, b->cancel_after = 0;
    json = small(b);
    assert_true(json_is_true(json_object_get(json, "complete")));
    assert_int_equal(json_integer_value(json_object_get(json, "renders")), ROWS);
    char *texts[2] = {contents(&whole, "rows.csv"), contents(b, "rows.csv")};
    for (int i = 0; i < 2; i++) assert_int_equal(split(texts[i], rows[i], ROWS + 2), ROWS + 1);
    for (int i = 0; i <= ROWS; i++) assert_string_equal(rows[0][i], rows[1][i]);
    free(texts[0]), free(texts[1]);
    json_decref(json);
    void *other = memcpy(malloc(sizeof whole), &whole, sizeof whole);
    ((bench *)other)->report = NULL;
    assert_int_equal(close_bench(&other), 0);
}

static const json_t *config(const json_t *study, const char *name) {
    const json_t *c;
    size_t i;
    json_array_foreach(json_object_get(study, "configs"), i, c)
        if (strcmp(json_string_value(json_object_get(c, "name")), name) == 0) return c;
    fail_msg("there is no configuration %s", name);
    return NULL;
}

static double top_mean(const json_t *study, const char *name, const char *key) {
    const json_t *levels = json_object_get(config(study, name), "levels");
    const json_t *top = json_array_get(levels, json_array_size(levels) - 1);
    return json_number_value(json_object_get(json_object_get(top, key), "mean"));
}

static void errors_and_biases_are_found(void **state) {
    bench *b = *state;
    json_t *json = study(b, (const char *const[]){"preset", "estimators", "output", b->folder, "size", "16x16", "spp",
                                                  "64", NULL});
    assert_true(json_is_true(json_object_get(json, "complete")));
    assert_int_equal(json_array_size(json_object_get(json, "configs")), 5);
    assert_string_equal(json_string_value(json_object_get(config(json, "base"), "biased")), "none seen");
    assert_string_equal(json_string_value(json_object_get(config(json, "estimator=naive"), "biased")), "by design");
    assert_string_equal(json_string_value(json_object_get(json_object_get(json, "reference"), "estimator")), "nee");
    assert_true(top_mean(json, "estimator=bsdf", "relmse") > top_mean(json, "base", "relmse"));
    assert_true(top_mean(json, "estimator=doubled", "light") > 0.2);   /* counts what is seen twice */
    assert_true(top_mean(json, "estimator=naive", "light") < -0.02);   /* loses caustics, and the lamp in the mirror */
    assert_true(fabs(top_mean(json, "base", "light")) < 0.02);
    assert_true(json_array_size(json_object_get(json, "pareto")) > 0);
    assert_true(json_array_size(json_object_get(json, "advice")) > 0);
    json_decref(json);
}

/* What stands between two texts; free(). */
static char *between(const char *text, const char *before, const char *after) {
    const char *from = strstr(text, before);
    assert_non_null(from);
    from += strlen(before);
    const char *to = strstr(from, after);
    assert_non_null(to);
    return strndup(from, (size_t)(to - from));
}

static void the_report_needs_nothing_else(void **state) {
    bench *b = *state;
    json_decref(small(b));
    char *html = contents(b, "report.html");
    assert_null(strstr(html, "http://"));
    assert_null(strstr(html, "https://"));
    assert_null(strstr(html, "{{"));
    assert_non_null(strstr(html, "</html>"));
    static const char *const ids[] = {"study-data", "picture-data"};
    for (int i = 0; i < 2; i++) {
        char opening[80];
        snprintf(opening, sizeof opening, "<script type=\"application/json\" id=\"%s\">", ids[i]);
        char *text = between(html, opening, "</script>");
        json_t *json = json_loads(text, 0, NULL);
        assert_non_null(json);
        const char *uri = json_string_value(json_object_get(json_object_get(json, "base"), "error"));
        assert_true(i == 0 || strncmp(uri, "data:image/webp;base64,UklGR", 28) == 0); /* "RIFF" */
        json_decref(json);
        free(text);
    }
    free(html);
}

static void another_study_begins_anew(void **state) {
    bench *b = *state;
    json_t *json = small(b);
    json_int_t renders = json_integer_value(json_object_get(json, "renders"));
    json_decref(json);
    json = small(b, "max-depth", "3");
    assert_int_equal(json_integer_value(json_object_get(json, "renders")), renders);
    json_decref(json);
    char *rows = contents(b, "rows.csv"), *rest = rows;
    int lines = 0;
    while ((rest = strchr(rest, '\n'))) rest++, lines++;
    assert_int_equal(lines, renders + 1);
    free(rows);
}

static void what_is_wrong_is_said(void **state) {
    bench *b = *state;
    static const struct { const char *option, *value, *says; } rows[] = {
        {"preset", "stability", "is not a preset of this version"},
        {"preset", "effects", "needs a scene"},
        {"reference", "nothing.exr", "nothing.exr"},
        {"reference", KILN_TEST_DATA "/compare/noise_linear_a.exr", ""},
        {"output", "second", "a study has one folder"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        kiln_report_clear(b->report);
        json_decref(small(b, rows[i].option, rows[i].value));
        assert_true(kiln_report_exit_code(b->report) > 1);
        kiln_message m = kiln_report_message(b->report, 0);
        if (!strstr(m.what, rows[i].says) && !strstr(m.where, rows[i].says)) fail_msg("%s: %s", m.where, m.what);
    }
}

#define STUDY_TEST(name) cmocka_unit_test_setup_teardown(name, open_bench, close_bench)

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(students_quantiles_are_those_of_tables), cmocka_unit_test(intervals_have_a_closed_form),
        cmocka_unit_test(slopes_are_those_of_lines), cmocka_unit_test(the_front_is_who_nobody_beats),
        STUDY_TEST(an_interrupted_study_goes_on_to_the_same_rows), STUDY_TEST(errors_and_biases_are_found),
        STUDY_TEST(the_report_needs_nothing_else), STUDY_TEST(another_study_begins_anew),
        STUDY_TEST(what_is_wrong_is_said)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
