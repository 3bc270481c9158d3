/* job/study_rows.c: rows.csv, the journal of a study: one line for each render, appended whole. */
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "job/study.h"

const char *study_column_name(uint32_t column) {
    static const char *const names[STUDY_VALUES] = {
#define STUDY_COLUMN_NAME(id, name) name,
        STUDY_COLUMNS(STUDY_COLUMN_NAME)
#undef STUDY_COLUMN_NAME
#define STUDY_STAGE_NAME(id, name) [STUDY_STAGES + KILN_STAGE_##id] = "stage " name,
            KILN_STAGES(STUDY_STAGE_NAME)
#undef STUDY_STAGE_NAME
    };
    return names[column];
}

char *study_path(const study *s, const char *name) {
    kiln_text path = {0};
    text_format(&path, "%s/%s", s->folder, name);
    char *taken = text_take(&path);
    if (!taken) report_no_memory(s->run.report, "naming a file");
    return taken;
}

static void append_header(kiln_text *out) {
    text_append(out, "config,spp,seed");
    for (uint32_t c = 0; c < STUDY_VALUES; c++) {
        size_t start = out->length + 1;
        text_format(out, ",%s", study_column_name(c));
        for (char *at = out->data ? out->data + start : NULL; at && *at; at++)
            if (*at == ' ') *at = '_';
    }
    text_append(out, "\n");
}

static void append_row(const study *s, const study_row *row, kiln_text *out) {
    const study_config *c = &s->plan.configs[row->config];
    text_format(out, "%s,%u,%u", c->name, c->levels[row->level], row->seed);
    for (uint32_t i = 0; i < STUDY_VALUES; i++) {
        text_append(out, ",");
        if (isfinite(row->values[i])) option_print_number(row->values[i], out);
    }
    text_append(out, "\n");
}

static bool keep_row(study *s, const study_row *row) {
    study_row *grown = realloc(s->rows, (s->row_count + 1) * sizeof *grown);
    if (!grown) return report_no_memory(s->run.report, "keeping a row");
    s->rows = grown;
    s->rows[s->row_count++] = *row;
    return true;
}

bool study_has_row(const study *s, uint32_t config, uint32_t level, uint32_t seed) {
    for (uint32_t i = 0; i < s->row_count; i++)
        if (s->rows[i].config == config && s->rows[i].level == level && s->rows[i].seed == seed) return true;
    return false;
}

/* The next field of a line that ends with 0; NULL: there is none. */
static char *next_field(char **line) {
    char *field = *line;
    if (!field) return NULL;
    char *comma = strchr(field, ',');
    if (comma) *comma = '\0';
    *line = comma ? comma + 1 : NULL;
    return field;
}

static bool find_place(const study *s, const char *name, uint64_t spp, study_row *row) {
    for (row->config = 0; row->config < s->plan.config_count; row->config++) {
        const study_config *c = &s->plan.configs[row->config];
        if (strcmp(c->name, name) != 0) continue;
        for (row->level = 0; row->level < c->level_count; row->level++)
            if (c->levels[row->level] == spp) return true;
    }
    return false;
}

/* False: not a row of this plan. */
static bool parse_row(const study *s, char *line, study_row *row) {
    const char *name = next_field(&line), *spp_text = next_field(&line), *seed_text = next_field(&line);
    uint64_t spp, seed;
    if (!seed_text || !text_to_uint64(spp_text, &spp) || !text_to_uint64(seed_text, &seed) || seed >= s->plan.seeds ||
        !find_place(s, name, spp, row))
        return false;
    row->seed = (uint32_t)seed;
    for (uint32_t i = 0; i < STUDY_VALUES; i++) {
        const char *field = next_field(&line);
        if (!field) return false;
        if (!*field) row->values[i] = NAN;
        else if (!text_to_double(field, &row->values[i])) return false;
    }
    return !line;
}

static bool write_journal(const study *s, int flags, const char *bytes, size_t size) {
    char *path = study_path(s, "rows.csv");
    if (!path) return false;
    kiln_where where = where_root(path);
    int file = open(path, O_WRONLY | O_CREAT | O_CLOEXEC | flags, 0666);
    bool done = file >= 0 && write(file, bytes, size) == (ssize_t)size && fsync(file) == 0;
    int error = errno;
    if (file >= 0) close(file);
    if (!done)
        report_error(s->run.report, KILN_CODE_OUTPUT, &where, "make room, or choose another folder",
                     "the row cannot be written: %s", strerror(error));
    free(path);
    return done;
}

bool study_append_row(study *s, const study_row *row) {
    kiln_text line = {0};
    append_row(s, row, &line);
    bool done = line.data ? write_journal(s, O_APPEND, line.data, line.length)
                          : report_no_memory(s->run.report, "writing a row");
    text_free(&line);
    return done && keep_row(s, row);
}

bool study_forget_rows(study *s) {
    kiln_text header = {0};
    append_header(&header);
    free(s->rows);
    s->rows = NULL;
    s->row_count = 0;
    bool done = header.data ? write_journal(s, O_TRUNC, header.data, header.length)
                            : report_no_memory(s->run.report, "beginning a study");
    text_free(&header);
    return done;
}

/* All whole lines behind the header. */
static bool take_lines(study *s, char *text) {
    char *line = strchr(text, '\n');
    bool done = true;
    for (line = line ? line + 1 : NULL; done && line;) {
        char *end = strchr(line, '\n');
        study_row row;
        if (!end) break;
        *end = '\0';
        if (parse_row(s, line, &row) && !study_has_row(s, row.config, row.level, row.seed)) done = keep_row(s, &row);
        line = end + 1;
    }
    return done;
}

/* The journal again, from what was understood: a line that a power failure tore must not be continued by the next. */
static bool rewrite(const study *s) {
    kiln_text text = {0};
    append_header(&text);
    for (uint32_t i = 0; i < s->row_count; i++) append_row(s, &s->rows[i], &text);
    char *path = study_path(s, "rows.csv");
    bool done = path && (text.data ? file_replace(path, text.data, text.length, s->run.report)
                                   : report_no_memory(s->run.report, "going on with a study"));
    free(path);
    text_free(&text);
    return done;
}

bool study_read_rows(study *s) {
    kiln_bytes bytes;
    kiln_text header = {0};
    char *path = study_path(s, "rows.csv");
    append_header(&header);
    bool done = path && file_read(path, (uint64_t)1 << 30, &bytes, NULL, s->run.report);
    free(path);
    if (done) {
        bool ours = header.data && text_after((char *)bytes.data, header.data);
        done = ours ? take_lines(s, (char *)bytes.data) && rewrite(s) : study_forget_rows(s);
        file_free(&bytes);
    }
    text_free(&header);
    return done;
}
