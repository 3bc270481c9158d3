/* job/json.h: building JSON with jansson. Every function takes over what it is given, also when memory runs out: an
 * incomplete tree is the worst that comes of that, and dumping it fails or not. */
#ifndef KILN_JOB_JSON_H
#define KILN_JOB_JSON_H

#include <jansson.h>
#include <math.h>
#include <stdint.h>

/* null stands for numbers that JSON does not have. */
static inline json_t *json_number_of(double value) { return isfinite(value) ? json_real(value) : json_null(); }

/* Names in files need not be UTF-8: what is not, becomes '?'. */
json_t *json_text_of(const char *text);

static inline void put(json_t *object, const char *key, json_t *value) {
    (void)json_object_set_new(object, key, value);
}
static inline void put_number(json_t *o, const char *key, double value) { put(o, key, json_number_of(value)); }
static inline void put_count(json_t *o, const char *key, uint64_t value) {
    put(o, key, json_integer((json_int_t)value));
}
static inline void put_text(json_t *o, const char *key, const char *value) { put(o, key, json_text_of(value)); }
static inline void put_bool(json_t *o, const char *key, int value) { put(o, key, json_boolean(value)); }
json_t *json_numbers_of(const double *values, size_t count);
json_t *json_floats_of(const float *values, size_t count);

#endif
