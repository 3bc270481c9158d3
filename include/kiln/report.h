/* kiln/report.h: what went wrong, where in the file, and what to do about it.
 *
 * Every call that can fail takes a report, which must not be NULL. It returns false exactly when it added an error to
 * it; warnings never change a return value. Equal warnings are counted, not repeated. A report may be filled from
 * several threads at once, and is read when they are done. It may serve any number of calls: it grows until it is
 * cleared. */
#ifndef KILN_REPORT_H
#define KILN_REPORT_H

#include "kiln/api.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct kiln_report kiln_report;

typedef enum kiln_severity { KILN_NOTE, KILN_WARNING, KILN_ERROR } kiln_severity;

/* One row per kind of trouble: identifier, machine-readable name, what a process should exit with when this is
 * its first error. Exit classes: 1 the work failed, 2 wrong usage, 3 invalid input, 75 try again, 130 interrupted. */
#define KILN_CODES(X)                                                                                                  \
    X(USAGE, "usage", 2)                   /* an option or argument that cannot be */                                  \
    X(FILE_MISSING, "file-missing", 3)     /* a file that does not exist */                                            \
    X(FILE_UNREADABLE, "file-unreadable", 3) /* a directory, no permission, an I/O error */                            \
    X(FILE_FORMAT, "file-format", 3)       /* not the format that its name or first bytes promise */                   \
    X(FILE_TRUNCATED, "file-truncated", 3) /* ends before its own lengths say */                                       \
    X(PATH_OUTSIDE, "path-outside", 3)     /* a URI that leaves the asset's folder */                                  \
    X(SYNTAX, "syntax", 3)                 /* JSON or text that does not parse, or nests too deep */                   \
    X(REFERENCE, "reference", 3)           /* an index, name or cycle that cannot be resolved */                       \
    X(RANGE, "range", 3)                   /* data outside its buffer, or a value outside its domain */                \
    X(EXTENSION, "extension", 3)           /* a required extension that kiln does not know */                          \
    X(IGNORED, "ignored", 3)               /* something in the file that kiln leaves out (a warning) */                \
    X(IMAGE, "image", 3)                   /* an image that cannot be decoded */                                       \
    X(GEOMETRY, "geometry", 3)             /* topology or attributes that cannot be rendered */                        \
    X(LIMIT, "limit", 3)                   /* larger than the memory budget or a library's limit allows */             \
    X(COLOR, "color", 2)                   /* a display, view, look or colour space that the config does not have */   \
    X(COLOR_CONFIG, "color-config", 3)     /* an OCIO config that cannot be read */                                    \
    X(OUTPUT, "output", 1)                 /* a file that cannot be written */                                         \
    X(MEMORY, "memory", 1)                 /* allocation failed */                                                     \
    X(DEVICE, "device", 1)                 /* Embree or a thread could not be started */                               \
    X(STRICT, "strict", 1)                 /* --strict: a warning or a discarded sample counts as a failure */         \
    X(DIFFERENT, "different", 1)           /* --threshold: pictures differ by more */                                  \
    X(CANCELLED, "cancelled", 130)         /* the cancel flag was raised */                                            \
    X(INTERNAL, "internal", 1)             /* a mistake of kiln's own */

typedef enum kiln_code {
#define KILN_CODE_ENUM(id, name, exit_class) KILN_CODE_##id,
    KILN_CODES(KILN_CODE_ENUM)
#undef KILN_CODE_ENUM
        KILN_CODE_COUNT
} kiln_code;

/* All strings are borrowed from the report and live as long as it does, or until kiln_report_clear. */
typedef struct kiln_message {
    kiln_severity severity;
    kiln_code code;
    const char *where;  /* "car.glb: materials[4].normalTexture"; the first place when count > 1; may be "" */
    const char *what;   /* "texture 12 does not exist (the file has 3)" */
    const char *remedy; /* what to do; may be "" */
    uint64_t count;     /* how many times, at any place */
} kiln_message;

/* Returns NULL only when memory is exhausted. */
KILN_API kiln_report *kiln_report_create(void);
KILN_API void kiln_report_destroy(kiln_report *report); /* NULL: nothing happens */
KILN_API void kiln_report_clear(kiln_report *report);

/* Messages are kept in the order of their first occurrence; index < size. */
KILN_API size_t kiln_report_size(const kiln_report *report);
KILN_API kiln_message kiln_report_message(const kiln_report *report, size_t index);
/* How often something of that severity was said, repetitions included. */
KILN_API uint64_t kiln_report_count(const kiln_report *report, kiln_severity severity);

/* The machine-readable name of a code ("file-missing"). */
KILN_API const char *kiln_code_name(kiln_code code);

/* 0 without errors, otherwise the exit class of the first error. */
KILN_API int kiln_report_exit_code(const kiln_report *report);

#ifdef __cplusplus
}
#endif
#endif
