#include "base/text.h"

#include <errno.h>
#include <locale.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static pthread_once_t locale_once = PTHREAD_ONCE_INIT;
static locale_t c_locale;
static void make_locale(void) { c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0); }
static locale_t get_c_locale(void) {
    pthread_once(&locale_once, make_locale);
    return c_locale;
}

static bool reserve(kiln_text *text, size_t more) {
    if (text->failed) return false;
    size_t need = text->length + more + 1;
    if (need <= text->capacity) return true;
    size_t capacity = need < 64 ? 64 : need + need / 2;
    char *data = realloc(text->data, capacity);
    if (!data) {
        text_free(text);
        text->failed = true;
        return false;
    }
    text->data = data;
    text->capacity = capacity;
    return true;
}

void text_append_bytes(kiln_text *text, const char *bytes, size_t count) {
    if (!reserve(text, count)) return;
    memcpy(text->data + text->length, bytes, count);
    text->length += count;
    text->data[text->length] = '\0';
}

void text_append(kiln_text *text, const char *string) { text_append_bytes(text, string, strlen(string)); }

void text_format_list(kiln_text *text, const char *format, va_list args) {
    locale_t before = uselocale(get_c_locale());
    va_list copy;
    va_copy(copy, args);
    int length = vsnprintf(NULL, 0, format, copy);
    va_end(copy);
    if (length >= 0 && reserve(text, (size_t)length)) {
        vsnprintf(text->data + text->length, (size_t)length + 1, format, args);
        text->length += (size_t)length;
    }
    uselocale(before);
}

void text_format(kiln_text *text, const char *format, ...) {
    va_list args;
    va_start(args, format);
    text_format_list(text, format, args);
    va_end(args);
}

char *text_take(kiln_text *text) {
    if (!text->data && !text->failed) reserve(text, 0);
    char *data = text->data;
    if (data) data[text->length] = '\0';
    *text = (kiln_text){0};
    return data;
}

void text_free(kiln_text *text) {
    free(text->data);
    *text = (kiln_text){0};
}

bool text_to_double(const char *string, double *value) {
    if (*string == '\0' || strchr(" \t\n\v\f\r", *string)) return false;
    char *end;
    double parsed = strtod_l(string, &end, get_c_locale());
    if (*end != '\0' || !isfinite(parsed)) return false;
    *value = parsed;
    return true;
}

bool text_to_uint64(const char *string, uint64_t *value) {
    if (*string < '0' || *string > '9') return false;
    char *end;
    errno = 0;
    unsigned long long parsed = strtoull(string, &end, 10);
    if (*end != '\0' || errno == ERANGE) return false;
    *value = parsed;
    return true;
}

/* Levenshtein distance, words shorter than 64 characters. */
static size_t edit_distance(const char *a, const char *b) {
    enum { LONGEST = 63 };
    size_t la = strlen(a), lb = strlen(b), row[LONGEST + 1];
    if (la > LONGEST || lb > LONGEST) return SIZE_MAX;
    for (size_t j = 0; j <= lb; j++) row[j] = j;
    for (size_t i = 1; i <= la; i++) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= lb; j++) {
            size_t above = row[j];
            size_t best = diagonal + (a[i - 1] != b[j - 1]);
            if (above + 1 < best) best = above + 1;
            if (row[j - 1] + 1 < best) best = row[j - 1] + 1;
            row[j] = best;
            diagonal = above;
        }
    }
    return row[lb];
}

const char *text_after(const char *string, const char *prefix) {
    size_t length = strlen(prefix);
    return strncmp(string, prefix, length) == 0 ? string + length : NULL;
}

const char *text_nearest(const char *word, const char *const *candidates, size_t count) {
    const char *best = NULL;
    size_t length = strlen(word), best_distance = (length == 2 ? 1 : length / 3) + 1;
    for (size_t i = 0; i < count; i++) {
        size_t distance = edit_distance(word, candidates[i]);
        if (distance < best_distance) {
            best_distance = distance;
            best = candidates[i];
        }
    }
    return best;
}
