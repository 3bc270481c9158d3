#include "job/options.h"

#include <stdlib.h>

bool job_options_init(job_options *o, kiln_report *report) {
    *o = (job_options){0};
    return option_defaults(&job_option_table, o, &o->arena) || report_no_memory(report, "reading options");
}

void job_options_free(job_options *o) { arena_free(&o->arena); }

static bool unknown(const char *name, kiln_report *report) {
    const char *names[64];
    for (size_t i = 0; i < job_option_table.count; i++) names[i] = job_option_table.rows[i].name;
    const char *nearest = text_nearest(name, names, job_option_table.count);
    kiln_text remedy = {0};
    if (nearest) text_format(&remedy, "did you mean %s?", nearest);
    report_error(report, KILN_CODE_USAGE, NULL, remedy.data, "there is no option '%s'", name);
    text_free(&remedy);
    return false;
}

bool job_options_set(job_options *o, const char *name, const char *text, const kiln_where *where, kiln_report *report) {
    const option_row *row = option_find(&job_option_table, name);
    if (!row) return unknown(name, report);
    kiln_text flag = {0};
    text_format(&flag, "--%s", name);
    kiln_where here = where ? *where : where_root(flag.data ? flag.data : name);
    bool set = option_set(&job_option_table, row, text, o, &o->given, &o->arena, &here, report);
    text_free(&flag);
    return set;
}

bool job_rules_choose(const job_options *o, job_rules *rules, kiln_report *report) {
    *rules = (job_rules){o->spp, o->noise_percent / 100, o->budget_seconds};
    bool any = job_given(o, spp) || job_given(o, noise_percent) || job_given(o, budget_seconds);
    if (!any) *rules = (job_rules){.spp = 1024, .noise = 0.03};
    return rules->spp || rules->noise > 0 || rules->budget_seconds > 0 ||
           report_error(report, KILN_CODE_USAGE, NULL, "give --spp N or --budget DURATION too",
                        "--noise 0 leaves no rule that ends the render");
}
