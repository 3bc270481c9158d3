#include "base/report.h"

#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

/* More distinct messages than this say nothing new; the rest are only counted. Errors have as many places again, so
 * that warnings cannot crowd them out. */
enum { MESSAGES_MAX = 1000 };

typedef struct entry {
    kiln_message message; /* its strings are owned */
} entry;

struct kiln_report {
    pthread_mutex_t mutex;
    entry *entries;
    size_t count, capacity;
    uint64_t totals[KILN_ERROR + 1];
    int first_error_exit; /* 0: no error yet */
};

static const struct {
    const char *name;
    int exit_class;
} code_rows[KILN_CODE_COUNT] = {
#define KILN_CODE_ROW(id, name, exit_class) [KILN_CODE_##id] = {name, exit_class},
    KILN_CODES(KILN_CODE_ROW)
#undef KILN_CODE_ROW
};

kiln_report *kiln_report_create(void) {
    kiln_report *report = calloc(1, sizeof *report);
    if (!report) return NULL;
    pthread_mutex_init(&report->mutex, NULL);
    return report;
}

static void free_entries(kiln_report *report) {
    for (size_t i = 0; i < report->count; i++) {
        free((char *)report->entries[i].message.where);
        free((char *)report->entries[i].message.what);
        free((char *)report->entries[i].message.remedy);
    }
    report->count = 0;
}

void kiln_report_clear(kiln_report *report) {
    free_entries(report);
    memset(report->totals, 0, sizeof report->totals);
    report->first_error_exit = 0;
}

void kiln_report_destroy(kiln_report *report) {
    if (!report) return;
    free_entries(report);
    free(report->entries);
    pthread_mutex_destroy(&report->mutex);
    free(report);
}

size_t kiln_report_size(const kiln_report *report) { return report->count; }
kiln_message kiln_report_message(const kiln_report *report, size_t index) { return report->entries[index].message; }
uint64_t kiln_report_count(const kiln_report *report, kiln_severity severity) { return report->totals[severity]; }
const char *kiln_code_name(kiln_code code) { return code_rows[code].name; }
int kiln_report_exit_code(const kiln_report *report) { return report->first_error_exit; }

static void append_where(kiln_text *text, const kiln_where *where) {
    if (!where) return;
    append_where(text, where->parent);
    if (where->parent) text_append(text, where->parent->parent ? "." : ": ");
    text_append(text, where->name);
    if (where->index != KILN_NO_INDEX) text_format(text, "[%zu]", where->index);
}

char *where_text(const kiln_where *where) {
    kiln_text text = {0};
    append_where(&text, where);
    return text_take(&text);
}

static entry *find(kiln_report *report, kiln_severity severity, kiln_code code, const char *what) {
    for (size_t i = 0; i < report->count; i++) {
        kiln_message *m = &report->entries[i].message;
        if (m->severity == severity && m->code == code && strcmp(m->what, what) == 0) return &report->entries[i];
    }
    return NULL;
}

static bool reserve(kiln_report *report) {
    if (report->count < report->capacity) return true;
    size_t capacity = report->capacity ? 2 * report->capacity : 16;
    entry *entries = realloc(report->entries, capacity * sizeof *entries);
    if (!entries) return false;
    report->entries = entries;
    report->capacity = capacity;
    return true;
}

static void store(kiln_report *report, kiln_severity severity, kiln_code code, const kiln_where *where,
                  const char *remedy, const char *what) {
    entry *known = find(report, severity, code, what);
    if (known) {
        known->message.count++;
        return;
    }
    if (report->count >= (severity == KILN_ERROR ? 2 * MESSAGES_MAX : MESSAGES_MAX)) return;
    kiln_message m = {severity, code, where_text(where), strdup(what), strdup(remedy ? remedy : ""), 1};
    if (!m.where || !m.what || !m.remedy || !reserve(report)) {
        free((char *)m.where);
        free((char *)m.what);
        free((char *)m.remedy);
        return;
    }
    report->entries[report->count++].message = m;
}

static void add(kiln_report *report, kiln_severity severity, kiln_code code, const kiln_where *where,
                const char *remedy, const char *format, va_list args) {
    kiln_text what = {0};
    text_format_list(&what, format, args);
    pthread_mutex_lock(&report->mutex);
    report->totals[severity]++;
    if (severity == KILN_ERROR && !report->first_error_exit) report->first_error_exit = code_rows[code].exit_class;
    store(report, severity, code, where, remedy, what.data ? what.data : "(out of memory)");
    pthread_mutex_unlock(&report->mutex);
    text_free(&what);
}

bool report_error(kiln_report *report, kiln_code code, const kiln_where *where, const char *remedy, const char *format,
                  ...) {
    va_list args;
    va_start(args, format);
    add(report, KILN_ERROR, code, where, remedy, format, args);
    va_end(args);
    return false;
}

void report_warning(kiln_report *report, kiln_code code, const kiln_where *where, const char *remedy,
                    const char *format, ...) {
    va_list args;
    va_start(args, format);
    add(report, KILN_WARNING, code, where, remedy, format, args);
    va_end(args);
}

void report_note(kiln_report *report, kiln_code code, const kiln_where *where, const char *remedy, const char *format,
                 ...) {
    va_list args;
    va_start(args, format);
    add(report, KILN_NOTE, code, where, remedy, format, args);
    va_end(args);
}

bool report_no_memory(kiln_report *report, const char *doing) {
    return report_error(report, KILN_CODE_MEMORY, NULL, "close other programs or use a smaller scene or picture",
                        "out of memory while %s", doing);
}
