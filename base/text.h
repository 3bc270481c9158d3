/* base/text.h: growing text, and numbers that look the same in every locale. */
#ifndef KILN_BASE_TEXT_H
#define KILN_BASE_TEXT_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Zero-initialised is empty. data is NULL until something was appended, and again when memory ran out; it is
 * always terminated. */
typedef struct kiln_text {
    char *data;
    size_t length, capacity;
    bool failed;
} kiln_text;

void text_append(kiln_text *, const char *string);
void text_append_bytes(kiln_text *, const char *bytes, size_t count);
/* printf in the C locale: a decimal point is a point. No argument may point into the text itself. */
void text_format(kiln_text *, const char *format, ...) __attribute__((format(printf, 2, 3)));
void text_format_list(kiln_text *, const char *format, va_list args);
/* Hands the characters over (free()); "" rather than NULL for empty text; NULL when memory ran out. */
char *text_take(kiln_text *);
void text_free(kiln_text *);

/* The whole of string as a number, in the C locale; false for anything else, infinities and NaN included. */
bool text_to_double(const char *string, double *value);
bool text_to_uint64(const char *string, uint64_t *value);

/* What follows the prefix; NULL: the string does not begin with it. */
const char *text_after(const char *string, const char *prefix);

/* The candidate nearest to word in edit distance, for "did you mean". NULL when none is within a third of the word's
 * length (of two letters, one may be wrong). */
const char *text_nearest(const char *word, const char *const *candidates, size_t count);

#endif
