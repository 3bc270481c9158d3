/* base/report.h: filling a kiln_report. The reading side is public: kiln/report.h. */
#ifndef KILN_BASE_REPORT_H
#define KILN_BASE_REPORT_H

#include "kiln/report.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Where we are in the user's file: a chain kept on the C stack, innermost first. The root names the file. */
typedef struct kiln_where {
    const struct kiln_where *parent;
    const char *name;
    size_t index; /* KILN_NO_INDEX: none */
} kiln_where;

#define KILN_NO_INDEX SIZE_MAX

static inline kiln_where where_root(const char *file) { return (kiln_where){NULL, file, KILN_NO_INDEX}; }
static inline kiln_where where_key(const kiln_where *parent, const char *name) {
    return (kiln_where){parent, name, KILN_NO_INDEX};
}
static inline kiln_where where_item(const kiln_where *parent, const char *name, size_t index) {
    return (kiln_where){parent, name, index};
}

/* "car.glb: materials[4].normalTexture"; free(). NULL: out of memory. */
char *where_text(const kiln_where *);

#define KILN_PRINTF(format_at, args_at) __attribute__((format(printf, format_at, args_at)))

/* Adds an error and returns false, so that a caller can `return report_error(…)`. where and remedy may be NULL. */
bool report_error(kiln_report *report, kiln_code code, const kiln_where *where, const char *remedy, const char *format,
                  ...) KILN_PRINTF(5, 6);

/* Adds a warning or a note. Messages of equal severity, code and text are one message with a count. */
void report_warning(kiln_report *report, kiln_code code, const kiln_where *where, const char *remedy,
                    const char *format, ...) KILN_PRINTF(5, 6);
void report_note(kiln_report *report, kiln_code code, const kiln_where *where, const char *remedy, const char *format,
                 ...) KILN_PRINTF(5, 6);

/* report_error(…, "out of memory while %s", doing). */
bool report_no_memory(kiln_report *report, const char *doing);

#ifdef __cplusplus
}
#endif
#endif
