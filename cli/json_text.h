/* cli/json_text.h: reading the JSON that a job hands out, to print it for people. */
#ifndef KILN_CLI_JSON_TEXT_H
#define KILN_CLI_JSON_TEXT_H

#include <jansson.h>

#include "base/text.h"

static inline const json_t *member(const json_t *o, const char *key) { return json_object_get(o, key); }
static inline const char *text_in(const json_t *o, const char *key) {
    const char *text = json_string_value(member(o, key));
    return text ? text : "";
}
static inline double number_in(const json_t *o, const char *key) { return json_number_value(member(o, key)); }
static inline bool is_true(const json_t *o, const char *key) { return json_is_true(member(o, key)); }
static inline bool is_null(const json_t *o, const char *key) { return !member(o, key) || json_is_null(member(o, key)); }

/* "94,722" */
void append_grouped(kiln_text *, double count);
/* "12.3 MB" */
void append_bytes(kiln_text *, double bytes);
/* "bounce rays 41%, scatter 9%": the stages of a render that take at least this share of its time, longest first. */
void append_stages(kiln_text *, const json_t *stages, double least);
/* "(1, 0.5, 0)" */
void append_vector(kiln_text *, const json_t *numbers);
/* Text from a file: control characters become '?', and blanks fill it up to a width counted in characters. */
void append_name(kiln_text *, const char *name, size_t width);
size_t name_width(const char *name);

#endif
