/* job/study_advice.c: which settings to take, in words. Error falls as the root of time, so one number carries a
 * setting from the time that was measured to any other: error² · seconds. */
#include <math.h>
#include <string.h>

#include "job/study.h"

static const double default_target = 0.02, default_budget = 10; /* where the user names none */

static double mean_in(const json_t *o, const char *key) {
    const json_t *mean = json_object_get(json_object_get(o, key), "mean");
    return json_is_real(mean) ? json_real_value(mean) : NAN;
}

static const char *text_in(const json_t *o, const char *key) {
    const char *text = json_string_value(json_object_get(o, key));
    return text ? text : "";
}

typedef struct candidate {
    const char *name;
    double price;   /* error² · seconds at the highest level */
    double seconds_per_sample;
    double gain, gain_low, gain_high; /* efficiency over the base's */
} candidate;

static bool is_sound(const json_t *config) {
    const char *biased = text_in(config, "biased");
    return !json_is_true(json_object_get(config, "other_picture")) && strcmp(biased, "yes") != 0 &&
           strcmp(biased, "by design") != 0;
}

static candidate read_candidate(const json_t *config) {
    const json_t *levels = json_object_get(config, "levels");
    const json_t *top = json_array_get(levels, json_array_size(levels) - 1);
    const json_t *over = json_object_get(json_object_get(config, "efficiency"), "over_base");
    const json_t *low = json_object_get(over, "low"), *high = json_object_get(over, "high");
    double error = mean_in(top, "relmse"), seconds = mean_in(top, "seconds");
    return (candidate){.name = text_in(config, "name"), .price = error * seconds,
                       .seconds_per_sample = seconds / json_number_value(json_object_get(top, "spp")),
                       .gain = mean_in(json_object_get(config, "efficiency"), "over_base"),
                       .gain_low = json_is_real(low) ? json_real_value(low) : NAN,
                       .gain_high = json_is_real(high) ? json_real_value(high) : NAN};
}

/* The cheapest whose gain over the base is beyond doubt; else the base, whose gain is 1. */
static bool choose(const json_t *configs, candidate *best) {
    const json_t *config;
    size_t i;
    bool any = false;
    json_array_foreach(configs, i, config) {
        candidate c = read_candidate(config);
        if (!is_sound(config) || !(c.price > 0) || !isfinite(c.price)) continue;
        if (any && !(c.gain_low > 1 && c.price < best->price)) continue;
        *best = c;
        any = true;
    }
    return any;
}

/* "--roulette off --max-depth 8"; "the default settings". */
static void append_settings(const candidate *c, kiln_text *out) {
    if (strcmp(c->name, "base") == 0) {
        text_append(out, "the settings as they are");
        return;
    }
    for (const char *at = c->name; *at;) {
        size_t equals = strcspn(at, "="), length = strcspn(at, "+");
        text_append(out, at == c->name ? "--" : " --");
        text_append_bytes(out, at, equals);
        text_append(out, " ");
        text_append_bytes(out, at + equals + 1, length - equals - 1);
        at += length + (at[length] == '+');
    }
}

static void append_gain(const candidate *c, kiln_text *out) {
    if (isfinite(c->gain_low) && c->gain_low > 1)
        text_format(out, ", %.2g times as efficient as the settings as they are (%.2g to %.2g)", c->gain, c->gain_low,
                    c->gain_high);
}

static void add_line(json_t *lines, kiln_text *line) {
    (void)json_array_append_new(lines, json_text_of(line->data));
    text_free(line);
}

static double samples_for(double seconds, const candidate *c) { return fmax(ceil(seconds / c->seconds_per_sample), 1); }

void study_advise(const study *s, json_t *description) {
    const job_options *o = &s->options;
    double target = o->noise_percent > 0 ? o->noise_percent / 100 : default_target;
    double budget = o->budget_seconds > 0 ? o->budget_seconds : default_budget;
    json_t *lines = json_array();
    kiln_text line = {0};
    candidate best;
    if (!choose(json_object_get(description, "configs"), &best)) {
        text_append(&line, "No recommendation: not enough was measured, or the reference is as noisy as what it "
                           "judges.");
        add_line(lines, &line);
    } else {
        double time = best.price / (target * target);
        text_format(&line, "For an error of %.3g %% take ", 100 * target);
        append_settings(&best, &line);
        text_format(&line, " with --spp %.0f: about %.2g s of rendering at %u x %u pixels", samples_for(time, &best),
                    time, s->run.view.width, s->run.view.height);
        append_gain(&best, &line);
        text_append(&line, ".");
        add_line(lines, &line);
        text_format(&line, "In %.3g s of rendering, ", budget);
        append_settings(&best, &line);
        text_format(&line, " with --spp %.0f reach%s an error of about %.2g %%.", samples_for(budget, &best),
                    strcmp(best.name, "base") == 0 ? "" : "es", 100 * sqrt(best.price / budget));
        add_line(lines, &line);
        text_append(&line, "Time grows with the number of pixels; error in per cent does not change with it, and "
                           "halves with four times the samples.");
        add_line(lines, &line);
    }
    put(description, "advice", lines);
}
