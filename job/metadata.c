#include "job/metadata.h"

#include <math.h>
#include <stdlib.h>

#include "job/machine.h"

char *metadata_command(const job_run *r) {
    kiln_text text = {0};
    text_append(&text, "kiln render ");
    option_quote(r->source, &text);
    option_print_command(&job_option_table, r->options, r->options->given, &text);
    return text_take(&text);
}

static void add_string(job_metadata *m, const char *name, const char *value) {
    m->attributes[m->attribute_count++] = (kiln_exr_attribute){name, KILN_EXR_STRING, value, 0};
}
static void add_number(job_metadata *m, const char *name, kiln_exr_attribute_kind kind, double value) {
    m->attributes[m->attribute_count++] = (kiln_exr_attribute){name, kind, NULL, value};
}

static void append_version(void *user, const char *name, const char *version) {
    kiln_text *text = user;
    text_format(text, "%s%s %s", text->length ? ", " : "", name, version);
}

static void add_text(job_metadata *m, const char *keyword, const char *value) {
    m->text[2 * m->text_count] = keyword;
    m->text[2 * m->text_count++ + 1] = value;
}

static const char *keep(job_metadata *m, kiln_text *text) {
    const char *kept = text->data ? arena_string(&m->arena, text->data) : NULL;
    text_free(text);
    return kept;
}

bool metadata_make(job_metadata *m, const job_run *r) {
    *m = (job_metadata){0};
    kiln_text software = {0}, versions = {0}, command = {0}, seed = {0};
    text_format(&software, "kiln %s", kiln_version());
    machine_versions(append_version, &versions);
    text_format(&seed, "%llu", (unsigned long long)r->options->seed);
    char *line = metadata_command(r);
    text_append(&command, line ? line : "");
    free(line);
    const char *kept_software = keep(m, &software), *kept_versions = keep(m, &versions),
               *kept_command = keep(m, &command), *kept_seed = keep(m, &seed);
    if (!kept_software || !kept_versions || !kept_command || !kept_seed) {
        metadata_free(m);
        return false;
    }
    add_text(m, "Software", kept_software);
    add_text(m, "Color config", kiln_color_describe(r->color));
    add_text(m, "Color view", kiln_view_describe(r->display));
    add_string(m, "software", kept_software);
    add_string(m, "versions", kept_versions);
    add_string(m, "command", kept_command);
    add_string(m, "camera", r->view.name);
    add_string(m, "colorConfig", kiln_color_describe(r->color));
    add_string(m, "colorView", kiln_view_describe(r->display));
    add_number(m, "exposure", KILN_EXR_DOUBLE, r->exposure);
    add_number(m, "samplesPerPixel", KILN_EXR_INT, r->stats.spp);
    add_string(m, "seed", kept_seed); /* an attribute's integer has 32 bits */
    add_number(m, "renderTime", KILN_EXR_DOUBLE, r->stats.seconds);
    if (r->error.known) add_number(m, "estimatedError", KILN_EXR_DOUBLE, sqrt(r->error.relmse));
    return true;
}

void metadata_free(job_metadata *m) { arena_free(&m->arena); }
