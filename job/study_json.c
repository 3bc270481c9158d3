/* job/study_json.c: what follows from the rows of a study. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/threads.h"
#include "job/effects.h"
#include "job/machine.h"
#include "job/stats.h"
#include "job/study.h"
#include "scene/scene.h"

enum { SEEDS_MAX = 64 };

/* The values of one column over the seeds of a level; NAN where a seed is not there yet. */
static uint32_t collect(const study *s, uint32_t config, uint32_t level, uint32_t column, double *values) {
    uint32_t count = s->plan.seeds < SEEDS_MAX ? s->plan.seeds : SEEDS_MAX;
    for (uint32_t i = 0; i < count; i++) values[i] = NAN;
    for (uint32_t i = 0; i < s->row_count; i++) {
        const study_row *row = &s->rows[i];
        if (row->config == config && row->level == level && row->seed < count) values[row->seed] = row->values[column];
    }
    return count;
}

static uint32_t threads_of(const study *s) { return s->options.threads ? s->options.threads : threads_available(); }

/* On a machine that does other work, too, time on the wall says little; processor time over threads is what it would be
 * on a quiet one, but for waiting at the end of a render. */
static bool is_busy(const study *s) {
    const double tolerated = 1.15;
    double wall = 0, cpu = 0;
    for (uint32_t i = 0; i < s->row_count; i++) {
        wall += s->rows[i].values[STUDY_SECONDS];
        cpu += s->rows[i].values[STUDY_CPU];
    }
    return wall * threads_of(s) > tolerated * cpu;
}

/* Seconds by the clock that the study goes by. */
static uint32_t collect_seconds(const study *s, uint32_t config, uint32_t level, double *values) {
    bool busy = is_busy(s);
    uint32_t count = collect(s, config, level, busy ? STUDY_CPU : STUDY_SECONDS, values);
    for (uint32_t i = 0; busy && i < count; i++) values[i] /= threads_of(s);
    return count;
}

static json_t *range_of(study_range r) {
    json_t *o = json_object();
    put_number(o, "mean", r.mean);
    put_number(o, "low", r.low);
    put_number(o, "high", r.high);
    return o;
}

static study_range interval_of(const study *s, uint32_t config, uint32_t level, uint32_t column) {
    double values[SEEDS_MAX];
    return study_interval(values, collect(s, config, level, column, values));
}

static json_t *describe_level(const study *s, uint32_t config, uint32_t level) {
    static const uint32_t columns[] = {STUDY_RELMSE, STUDY_TRIMMED, STUDY_MSE, STUDY_MAE, STUDY_FLIP, STUDY_FIREFLIES,
                                       STUDY_PREDICTED, STUDY_LIGHT, STUDY_BIAS, STUDY_LOST, STUDY_CPU};
    double seconds[SEEDS_MAX];
    json_t *o = json_object();
    uint32_t rows = 0, count = collect_seconds(s, config, level, seconds);
    for (uint32_t i = 0; i < count; i++) rows += isfinite(seconds[i]);
    put_count(o, "spp", s->plan.configs[config].levels[level]);
    put_count(o, "seeds", rows);
    put(o, "seconds", range_of(study_interval(seconds, count)));
    for (size_t i = 0; i < sizeof columns / sizeof *columns; i++)
        put(o, study_column_name(columns[i]), range_of(interval_of(s, config, level, columns[i])));
    return o;
}

static uint32_t top_of(const study *s, uint32_t config) { return s->plan.configs[config].level_count - 1; }

/* 1/(error · seconds) of each seed at the highest level; column: which error. */
static uint32_t efficiencies(const study *s, uint32_t config, uint32_t column, double *values) {
    double errors[SEEDS_MAX], seconds[SEEDS_MAX];
    uint32_t count = collect(s, config, top_of(s, config), column, errors);
    collect_seconds(s, config, top_of(s, config), seconds);
    for (uint32_t i = 0; i < count; i++) values[i] = 1 / (errors[i] * seconds[i]);
    return count;
}

/* Seeds that are not there yet are left out; an error that is not above 0 makes all unknown. */
static study_range efficiency(const double *values, const double *over, uint32_t count) {
    double kept[SEEDS_MAX];
    uint32_t n = 0;
    for (uint32_t i = 0; i < count; i++)
        if (!isnan(values[i]) && (!over || !isnan(over[i]))) kept[n++] = over ? values[i] / over[i] : values[i];
    return n ? study_interval_of_logs(kept, n) : (study_range){NAN, NAN, NAN};
}

static void put_efficiency(const study *s, uint32_t config, uint32_t column, const char *name, json_t *o) {
    double own[SEEDS_MAX], base[SEEDS_MAX];
    json_t *e = json_object();
    uint32_t count = efficiencies(s, config, column, own);
    efficiencies(s, 0, column, base);
    put(e, "value", range_of(efficiency(own, NULL, count)));
    put(e, "over_base", range_of(efficiency(own, base, count)));
    put(o, name, e);
}

static json_t *describe_slope(const study *s, uint32_t config) {
    double time[STUDY_LEVELS * SEEDS_MAX], error[STUDY_LEVELS * SEEDS_MAX];
    size_t n = 0;
    for (uint32_t level = 0; level < s->plan.configs[config].level_count; level++) {
        uint32_t count = collect_seconds(s, config, level, time + n);
        collect(s, config, level, STUDY_RELMSE, error + n);
        for (uint32_t i = 0; i < count; i++) error[n + i] = sqrt(error[n + i]);
        n += count;
    }
    return range_of(study_slope_of_logs(time, error, n));
}

static json_t *describe_stages(const study *s, uint32_t config) {
    json_t *o = json_object();
    for (uint32_t c = STUDY_STAGES; c < STUDY_VALUES; c++) {
        double seconds = interval_of(s, config, top_of(s, config), c).mean;
        if (seconds > 0) put_number(o, study_column_name(c) + strlen("stage "), seconds);
    }
    return o;
}

/* A bias shows when its interval leaves 0 out; it matters from a tenth of the error on. */
static const char *judge_bias(const study *s, uint32_t config) {
    study_range bias = interval_of(s, config, top_of(s, config), STUDY_BIAS),
                error = interval_of(s, config, top_of(s, config), STUDY_RELMSE);
    if (s->plan.configs[config].wrong) return "by design";
    if (isnan(bias.low)) return "unknown";
    if (bias.low <= 0) return "none seen";
    return bias.mean < 0.01 * error.mean ? "below a tenth of the error" : "yes";
}

static json_t *describe_config(const study *s, uint32_t config) {
    const study_config *c = &s->plan.configs[config];
    json_t *o = json_object(), *levels = json_array();
    put_text(o, "name", c->name);
    put_text(o, "option", c->option);
    put_bool(o, "wrong", c->wrong);
    put_bool(o, "other_picture", c->other_picture);
    put_text(o, "biased", judge_bias(s, config));
    for (uint32_t k = 0; k < c->level_count; k++) (void)json_array_append_new(levels, describe_level(s, config, k));
    put(o, "levels", levels);
    put(o, "slope", describe_slope(s, config));
    put_efficiency(s, config, STUDY_RELMSE, "efficiency", o);
    put_efficiency(s, config, STUDY_TRIMMED, "efficiency_trimmed", o);
    put(o, "stages", describe_stages(s, config));
    return o;
}

static json_t *describe_front(const study *s, const json_t *configs) {
    size_t count = (size_t)s->plan.config_count * STUDY_LEVELS, n = 0, i, k;
    double *time = calloc(count, 2 * sizeof *time), *error = time ? time + count : NULL;
    bool *front = calloc(count, sizeof *front);
    json_t *array = json_array();
    const json_t *config, *level;
    for (int turn = 0; time && front && turn < 2; turn++) {
        if (turn) study_front(time, error, n, front);
        n = 0;
        json_array_foreach(configs, i, config) {
            const char *biased = json_string_value(json_object_get(config, "biased"));
            bool out = json_is_true(json_object_get(config, "other_picture")) || strcmp(biased, "yes") == 0 ||
                       strcmp(biased, "by design") == 0;
            json_array_foreach(json_object_get(config, "levels"), k, level) {
                const json_t *t = json_object_get(json_object_get(level, "seconds"), "mean"),
                             *e = json_object_get(json_object_get(level, "relmse"), "mean");
                time[n] = json_is_real(t) && !out ? json_real_value(t) : NAN;
                error[n] = json_is_real(e) ? json_real_value(e) : NAN;
                if (turn && front[n]) {
                    json_t *point = json_object();
                    put_text(point, "config", json_string_value(json_object_get(config, "name")));
                    put(point, "spp", json_incref(json_object_get(level, "spp")));
                    (void)json_array_append_new(array, point);
                }
                n++;
            }
        }
    }
    free(time);
    free(front);
    return array;
}

static json_t *describe_reference(const study *s) {
    const study_reference *r = &s->reference;
    json_t *o = json_object();
    put(o, "file", s->options.reference ? json_text_of(s->options.reference) : json_null());
    put(o, "estimator", *r->made_by ? json_string(r->made_by) : json_null());
    put_count(o, "samples_per_pixel", (uint64_t)r->spp * r->passes);
    put_count(o, "independent_renders", r->passes);
    put_number(o, "relmse", r->passes ? r->relative_variance : NAN);
    put_number(o, "seconds", r->seconds);
    return o;
}

static json_t *describe_picture(const study *s) {
    json_t *o = json_object();
    put_count(o, "width", s->run.view.width);
    put_count(o, "height", s->run.view.height);
    put_text(o, "view", kiln_view_describe(s->run.display));
    put_number(o, "exposure", s->run.exposure);
    put_text(o, "camera", s->run.view.name);
    put_number(o, "map_end", s->map_end);
    return o;
}

json_t *study_describe(const study *s) {
    json_t *o = json_object(), *configs = json_array();
    char *key = study_key(s);
    put_text(o, "key", key);
    free(key);
    put_text(o, "scene", s->source ? s->source : "a scene of kiln's own");
    put_text(o, "preset", s->plan.preset);
    put(o, "options", stats_options(&s->options));
    put_bool(o, "complete", s->row_count == s->row_total);
    put_count(o, "renders", s->row_count);
    put_count(o, "renders_planned", s->row_total);
    put_count(o, "seeds", s->plan.seeds);
    put_text(o, "clock", is_busy(s) ? "processor time over threads: the machine did other work, too" : "wall");
    put(o, "picture", describe_picture(s));
    put(o, "reference", describe_reference(s));
    for (uint32_t i = 0; i < s->plan.config_count; i++) (void)json_array_append_new(configs, describe_config(s, i));
    put(o, "pareto", describe_front(s, configs));
    put(o, "configs", configs);
    put(o, "effects", effects_facts(&s->run.plan));
    put(o, "machine", stats_machine(s->options.threads));
    put(o, "versions", stats_versions());
    return o;
}

/* Where the study is written, and how it talks, do not matter. */
static void append_options(const study *s, kiln_text *key) {
    for (size_t i = 0; i < job_option_table.count; i++) {
        const option_row *row = &job_option_table.rows[i];
        bool target = row->offset == offsetof(job_options, noise_percent) ||
                      row->offset == offsetof(job_options, budget_seconds);
        if (!(s->options.given >> i & 1) || row->kind->repeats || target) continue;
        text_format(key, "--%s ", row->name);
        option_print(row, &s->options, 0, key);
        text_append(key, " ");
    }
}

static void append_file(file_identity f, kiln_text *key) {
    text_format(key, "%llu@%llu ", (unsigned long long)f.size, (unsigned long long)f.changed);
}

char *study_key(const study *s) {
    kiln_text key = {0};
    const scene_source *source = &s->run.scene->source;
    text_format(&key, "kiln %s %s; ", kiln_version(), kiln_render_backend().isa);
    machine_cpu_model(&key);
    text_format(&key, " x %u; %s %s %u x %u; ", threads_of(s), s->source ? s->source : "built in", s->plan.preset,
                s->run.view.width, s->run.view.height);
    append_options(s, &key);
    for (size_t i = 0; i < source->file_count; i++) append_file(source->files[i], &key);
    if (s->options.env) append_file(file_identify(s->options.env), &key);
    if (s->options.reference) append_file(file_identify(s->options.reference), &key);
    for (uint32_t i = 0; i < s->plan.config_count; i++) {
        const study_config *c = &s->plan.configs[i];
        text_format(&key, "; %s", c->name);
        for (uint32_t k = 0; k < c->level_count; k++) text_format(&key, " %u", c->levels[k]);
    }
    text_format(&key, " x %u", s->plan.seeds);
    return text_take(&key);
}
