/* job/study_plan.c: which settings a study compares. One row of a table is one option; what it can be is read from the
 * option itself where it is a choice, so that a value that is new there is measured from then on. */
#include <stdlib.h>
#include <string.h>

#include "job/effects.h"
#include "job/study.h"

/* When an option is worth varying. */
typedef enum occasion { ALWAYS, REFINED, TEXTURED, MANY_LIGHTS } occasion;

typedef struct axis {
    const char *option;
    const char *values; /* between blanks; NULL: every choice of the option */
    occasion when;
    const char *with;   /* another setting that goes with all of them, "roulette=off"; NULL: none */
} axis;

struct study_preset {
    const char *name;
    uint32_t side, spp, seeds;
    bool (*make_scene)(kiln_scene **, kiln_report *);
    const axis *axes; /* ends with a NULL option */
    const char *longer; /* a configuration that is measured at three times the samples too; NULL: none */
};

static const axis all_axes[] = {
    {"estimator", NULL, ALWAYS, NULL},
    {"roulette", "off fixed:0.6 fixed:0.95 throughput:1 throughput:3 auto", ALWAYS, NULL},
    {"max-depth", "2 4 8 16", ALWAYS, NULL},
    {"sampler", NULL, ALWAYS, NULL},
    {"light-sampling", NULL, MANY_LIGHTS, NULL},
    {"caustics", NULL, ALWAYS, NULL},
    {"adaptive", NULL, ALWAYS, NULL},
    {"subdivide", "off 1 2", REFINED, NULL},
    {"texture-filter", NULL, TEXTURED, NULL},
    {"effects", "", ALWAYS, NULL}, /* each that can be dropped */
    {NULL, NULL, ALWAYS, NULL}};
static const axis roulette_axes[] = {
    {"roulette", "fixed:0.95 fixed:0.6 throughput:1 throughput:3 off", ALWAYS, NULL},
    {"max-depth", "4 8 16 32", ALWAYS, "roulette=off"},
    {NULL, NULL, ALWAYS, NULL}};
static const axis estimator_axes[] = {{"estimator", NULL, ALWAYS, NULL}, {NULL, NULL, ALWAYS, NULL}};
static const axis effect_axes[] = {{"effects", "", ALWAYS, NULL}, {NULL, NULL, ALWAYS, NULL}};

static const study_preset presets[] = {
    {"default", 224, 64, 4, NULL, all_axes, NULL},
    {"roulette", 48, 500, 3, study_make_interior, roulette_axes, "roulette=fixed:0.6"},
    {"estimators", 128, 128, 4, study_make_mirrors, estimator_axes, NULL},
    {"effects", 160, 64, 4, NULL, effect_axes, NULL},
};
enum { PRESETS = sizeof presets / sizeof *presets };

const study_preset *study_find_preset(const job_options *o, kiln_report *report) {
    const char *names[PRESETS];
    kiln_text remedy = {0};
    kiln_where where = where_root("--preset");
    for (size_t i = 0; i < PRESETS; i++)
        if (strcmp(o->preset, presets[i].name) == 0) return &presets[i];
    for (size_t i = 0; i < PRESETS; i++) {
        names[i] = presets[i].name;
        text_format(&remedy, "%s%s", i ? ", " : "give one of ", names[i]);
    }
    const char *nearest = text_nearest(o->preset, names, PRESETS);
    if (nearest) text_format(&remedy, "; did you mean %s?", nearest);
    report_error(report, KILN_CODE_USAGE, &where, remedy.data, "'%s' is not a preset of this version", o->preset);
    text_free(&remedy);
    return NULL;
}

void study_plan_start(study_plan *plan, const study_preset *p) {
    *plan = (study_plan){.preset = p->name, .seeds = p->seeds, .side = p->side, .make_scene = p->make_scene};
}

/* The base with settings such as "roulette=off+max-depth=8". False: one of them does not exist, or not that value;
 * nothing is reported, for a table may name what is still to come. */
static bool apply(job_options *o, const char *settings) {
    kiln_report *silent = kiln_report_create();
    bool known = silent != NULL;
    for (const char *at = settings; known && *at;) {
        size_t length = strcspn(at, "+"), equals = strcspn(at, "=");
        kiln_text name = {0}, value = {0};
        text_append_bytes(&name, at, equals);
        text_append_bytes(&value, at + equals + 1, length - equals - 1);
        known = name.data && value.data && option_find(&job_option_table, name.data) &&
                 job_options_set(o, name.data, value.data, NULL, silent);
        text_free(&name);
        text_free(&value);
        at += length + (at[length] == '+');
    }
    kiln_report_destroy(silent);
    return known;
}

static void free_config(study_config *c) {
    free(c->name);
    arena_free(&c->options.arena);
    *c = (study_config){0};
}

void study_plan_free(study_plan *plan) {
    for (uint32_t i = 0; i < plan->config_count; i++) free_config(&plan->configs[i]);
    free(plan->configs);
    *plan = (study_plan){0};
}

static bool is_wrong(const job_options *o) {
    return o->estimator == KILN_ESTIMATOR_NAIVE || o->estimator == KILN_ESTIMATOR_DOUBLED;
}

static void choose_levels(study_config *c, uint32_t top, const char *longer) {
    for (uint32_t divisor = 16; divisor; divisor /= 4)
        if (top / divisor && (!c->level_count || c->levels[c->level_count - 1] < top / divisor))
            c->levels[c->level_count++] = top / divisor;
    if (longer && strcmp(longer, c->name) == 0) c->levels[c->level_count++] = 3 * top;
}

typedef struct filler {
    study_plan *plan;
    const study_preset *preset;
    const job_run *base;
    kiln_report *report;
} filler;

static uint32_t top_level(const filler *f) {
    return f->base->options->spp ? f->base->options->spp : f->preset->spp;
}

/* settings "": the base itself. */
static bool add(const filler *f, const char *option, const char *settings) {
    study_plan *plan = f->plan;
    study_config *grown = realloc(plan->configs, (plan->config_count + 1) * sizeof *grown);
    if (!grown) return report_no_memory(f->report, "planning a study");
    plan->configs = grown;
    study_config c = {.name = strdup(*settings ? settings : "base"), .option = option, .options = *f->base->options};
    c.options.arena = (kiln_arena){0};
    if (!c.name) return report_no_memory(f->report, "planning a study");
    if (!apply(&c.options, settings)) {
        free_config(&c);
        return true;
    }
    c.other_picture = strcmp(option, "effects") == 0;
    c.wrong = is_wrong(&c.options);
    choose_levels(&c, top_level(f), f->preset->longer);
    plan->configs[plan->config_count++] = c;
    return true;
}

/* Whether a value is what the base has already. */
static bool is_base(const filler *f, const option_row *row, const char *value) {
    kiln_text now = {0};
    option_print(row, f->base->options, 0, &now);
    bool same = now.data && strcmp(now.data, value) == 0;
    text_free(&now);
    return same;
}

static bool add_value(const filler *f, const axis *a, const option_row *row, const char *value) {
    if (!a->with && is_base(f, row, value)) return true;
    kiln_text settings = {0};
    text_format(&settings, "%s%s%s=%s", a->with ? a->with : "", a->with ? "+" : "", a->option, value);
    bool done = settings.data ? add(f, row->name, settings.data) : report_no_memory(f->report, "planning a study");
    text_free(&settings);
    return done;
}

static bool add_effects(const filler *f, const axis *a, const option_row *row) {
    bool done = true;
    for (int e = 0; done && e < KILN_EFFECT_COUNT; e++) {
        kiln_effect_facts facts = kiln_effect_describe((kiln_effect)e);
        if (!facts.removable || !(f->base->plan.called >> e & 1)) continue;
        kiln_text value = {0};
        text_format(&value, "-%s", facts.name);
        done = value.data ? add_value(f, a, row, value.data) : report_no_memory(f->report, "planning a study");
        text_free(&value);
    }
    return done;
}

static bool add_listed(const filler *f, const axis *a, const option_row *row) {
    bool done = true;
    for (const char *at = a->values; done && *at;) {
        size_t length = strcspn(at, " ");
        kiln_text value = {0};
        text_append_bytes(&value, at, length);
        done = value.data ? add_value(f, a, row, value.data) : report_no_memory(f->report, "planning a study");
        text_free(&value);
        at += length + (at[length] == ' ');
    }
    return done;
}

static bool is_worth_it(const filler *f, occasion when) {
    const job_run *r = f->base;
    bool refined = false;
    for (uint32_t i = 0; i < r->subdivision_count; i++) refined = refined || r->subdivisions[i].refined;
    switch (when) {
    case ALWAYS: return true;
    case REFINED: return refined;
    case TEXTURED: return r->plan.called >> KILN_EFFECT_TEXTURES & 1;
    case MANY_LIGHTS: return r->plan.called >> KILN_EFFECT_MANY_LIGHTS & 1;
    }
    return false;
}

bool study_plan_fill(study_plan *plan, const study_preset *preset, const job_run *base, kiln_report *report) {
    filler f = {plan, preset, base, report};
    bool done = add(&f, "", "");
    for (const axis *a = preset->axes; done && a->option; a++) {
        const option_row *row = option_find(&job_option_table, a->option);
        if (!row || !is_worth_it(&f, a->when)) continue;
        if (strcmp(a->option, "effects") == 0) done = add_effects(&f, a, row);
        else if (a->values) done = add_listed(&f, a, row);
        else
            for (const option_choice *c = row->choices; done && c && c->name; c++)
                done = add_value(&f, a, row, c->name);
    }
    return done;
}
