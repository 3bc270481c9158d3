/* job/study.c: the whole of a study. */
#include "job/study.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/clock.h"
#include "base/file.h"
#include "job/machine.h"
#include "job/metadata.h"
#include "job/stats.h"
#include "scene/scene.h"

static bool refuse_folder(const char *path, const char *why, kiln_report *report) {
    kiln_where where = where_root(path);
    return report_error(report, KILN_CODE_OUTPUT, &where, "name a folder that can be written", "%s", why);
}

/* False: reported. *there: it exists. */
static bool check_folder(const char *path, bool *there, kiln_report *report) {
    struct stat status;
    *there = stat(path, &status) == 0;
    return !*there || S_ISDIR(status.st_mode) || refuse_folder(path, "is not a folder", report);
}

static bool make_folder(const char *path, kiln_report *report) {
    bool there;
    if (!check_folder(path, &there, report)) return false;
    return there || mkdir(path, 0777) == 0 || refuse_folder(path, strerror(errno), report);
}

static bool choose_folder(study *s) {
    const option_list *outputs = &s->options.outputs;
    if (outputs->count != 1)
        return report_error(s->run.report, KILN_CODE_USAGE, NULL, "kiln study car.glb -o car.study",
                            outputs->count ? "a study has one folder" : "nothing says into which folder to write");
    bool there;
    s->folder = outputs->items[0];
    /* Before the work; it is made when the scene is known to be one. */
    return check_folder(s->folder, &there, s->run.report);
}

static bool make_folders(const study *s) {
    char *pictures = study_path(s, "pictures");
    bool done = pictures && make_folder(s->folder, s->run.report) && make_folder(pictures, s->run.report);
    free(pictures);
    return done;
}

/* The camera's size, but for a study: its longer side is what the preset says. */
static bool choose_size(study *s) {
    job_view *v = &s->run.view;
    if (!run_camera(&s->run)) return false;
    if (!s->options.size[0]) {
        uint32_t longer = v->width > v->height ? v->width : v->height;
        v->width = (v->width * s->plan.side + longer / 2) / longer;
        v->height = (v->height * s->plan.side + longer / 2) / longer;
        if (!v->width) v->width = 1;
        if (!v->height) v->height = 1;
    }
    s->options.size[0] = v->width, s->options.size[1] = v->height;
    return true;
}

static bool prepare(study *s, kiln_scene *scene) {
    job_run *r = &s->run;
    r->scene = scene;
    r->owns_scene = true;
    if (!run_phase(r, "color") || !run_color(r)) return false;
    if (!scene && (!run_phase(r, "import") || !run_import(r))) return false;
    if (!run_phase(r, "frame") || !choose_size(s) || !run_phase(r, "subdivide") || !run_subdivide(r)) return false;
    r->rules = (job_rules){.noise = 1}; /* errors are of the picture as exposed: see run_expose */
    return run_phase(r, "light") && run_light(r) && run_phase(r, "build") && run_build(r) && run_phase(r, "expose") &&
           run_expose(r);
}

/* Whether DIR holds rows of this very study. */
static bool is_same_study(const study *s, const char *key, bool *there) {
    char *path = study_path(s, "study.json");
    json_t *before = path ? json_load_file(path, 0, NULL) : NULL;
    const char *old = json_string_value(json_object_get(before, "key"));
    struct stat status;
    *there = path && stat(path, &status) == 0;
    bool same = old && strcmp(old, key) == 0;
    json_decref(before);
    free(path);
    return same;
}

static bool write_json(const study *s, json_t *json) {
    char *path = study_path(s, "study.json"), *text = json_dumps(json, JSON_INDENT(1) | JSON_REAL_PRECISION(9));
    bool done = path && (text ? file_replace(path, text, strlen(text), s->run.report)
                              : report_no_memory(s->run.report, "writing a study"));
    free(path);
    free(text);
    return done;
}

static bool open_journal(study *s) {
    char *key = study_key(s);
    bool there, done;
    if (!key) return report_no_memory(s->run.report, "beginning a study");
    s->resumed = is_same_study(s, key, &there);
    if (s->resumed) done = study_read_rows(s);
    else {
        if (there)
            run_log(&s->run, "%s: the scene, the options or the machine have changed: beginning anew", s->folder);
        json_t *begun = json_object();
        done = study_forget_rows(s);
        put_text(begun, "key", key);
        done = done && write_json(s, begun);
        json_decref(begun);
    }
    if (s->row_count)
        run_log(&s->run, "%s: going on after %u of %u renders", s->folder, s->row_count, s->row_total);
    free(key);
    return done;
}

void study_tell(const study *s, uint64_t inside, uint32_t spp) {
    const kiln_job_events *e = s->run.events;
    double now = clock_seconds() - s->started, done = (double)(s->cost_done + inside), all = (double)s->cost_total;
    if (!e->progress || !(s->started > 0)) return;
    kiln_progress p = {.spp_done = spp, .fraction = done / all, .seconds = now, .error = -1,
                       .seconds_left = done > 0 ? now * (all - done) / done : -1};
    e->progress(&p, e->user);
}

static void count_work(study *s) {
    for (uint32_t i = 0; i < s->plan.config_count; i++)
        for (uint32_t k = 0; k < s->plan.configs[i].level_count; k++)
            for (uint32_t seed = 0; seed < s->plan.seeds; seed++) {
                s->row_total++;
                if (!study_has_row(s, i, k, seed)) s->cost_total += s->plan.configs[i].levels[k];
            }
}

static bool measure_level(study *s, uint32_t config, uint32_t level, uint32_t seed) {
    study_row row;
    if (study_has_row(s, config, level, seed)) return true;
    if (!study_measure(s, config, level, seed, &row) || !study_append_row(s, &row)) return false;
    s->cost_done += s->plan.configs[config].levels[level];
    study_tell(s, 0, s->plan.configs[config].levels[level]);
    return true;
}

/* Every turn begins elsewhere, so that none is always first after a pause. */
static bool measure_all(study *s) {
    s->started = clock_seconds();
    for (uint32_t seed = 0; seed < s->plan.seeds; seed++)
        for (uint32_t n = 0; n < s->plan.config_count; n++) {
            uint32_t config = (n + seed * (s->plan.config_count / s->plan.seeds + 1)) % s->plan.config_count;
            for (uint32_t k = 0; k < s->plan.configs[config].level_count; k++)
                if (!measure_level(s, config, k, seed)) return false;
        }
    return true;
}

static void log_plan(const study *s) {
    run_log(&s->run, "%u configurations, %u renders of %u x %u pixels, %u seeds each", s->plan.config_count,
            s->row_total, s->run.view.width, s->run.view.height, s->plan.seeds);
}

static void log_reference(const study *s) {
    const study_reference *r = &s->reference;
    if (r->passes)
        run_log(&s->run, "reference: %u samples by %s, its own error %.2g%%, %.1f s", r->spp * r->passes, r->made_by,
                100 * sqrt(r->relative_variance), r->seconds);
    else run_log(&s->run, "reference: %s; its noise, which is unknown, counts as error", s->options.reference);
}

static bool measure(study *s, const study_preset *preset, kiln_scene *scene) {
    if (!prepare(s, scene) || !study_plan_fill(&s->plan, preset, &s->run, s->run.report) || !make_folders(s))
        return false;
    count_work(s);
    if (!open_journal(s)) return false;
    s->row_total = 0, s->cost_total = 0;
    count_work(s);
    log_plan(s);
    if (!run_phase(&s->run, "reference") || !study_make_reference(s)) return false;
    log_reference(s);
    return run_phase(&s->run, "measure") && measure_all(s);
}

static bool conclude(study *s, json_t **json) {
    *json = study_describe(s);
    study_advise(s, *json);
    return write_json(s, *json) && study_write_report(s, *json);
}

/* A scene of the preset's own stands in where none is given. */
static bool choose_scene(const study *s, const char *scene_file, kiln_scene **scene) {
    *scene = NULL;
    if (scene_file) return true;
    return s->plan.make_scene ? s->plan.make_scene(scene, s->run.report)
                              : report_error(s->run.report, KILN_CODE_USAGE, NULL, "kiln study car.glb -o car.study",
                                             "the preset %s needs a scene", s->plan.preset);
}

bool study_run(job_run *r, const char *scene_file, json_t **json) {
    study s = {.options = *r->options, .run = *r, .source = scene_file};
    const study_preset *preset = study_find_preset(r->options, r->report);
    kiln_scene *scene;
    bool done = preset != NULL;
    s.run.options = &s.options;
    if (done) study_plan_start(&s.plan, preset);
    done = done && choose_folder(&s) && choose_scene(&s, scene_file, &scene) && measure(&s, preset, scene);
    run_phase(&s.run, NULL);
    if (s.row_count) done = conclude(&s, json) && done; /* of what there is, where it was interrupted too */
    study_free_reference(&s.reference);
    study_plan_free(&s.plan);
    free(s.rows);
    s.run.options = r->options;
    *r = s.run; /* whoever started it frees it */
    return done;
}
