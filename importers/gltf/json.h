/* importers/gltf/json.h: JSON text that is checked before a parser with recursion and exceptions sees it, and walked
 * where that parser would not do. */
#ifndef KILN_IMPORTERS_GLTF_JSON_H
#define KILN_IMPORTERS_GLTF_JSON_H

#include "base/arena.h"
#include "base/report.h"

/* Arrays and objects inside one another. glTF itself needs about 10; extras and extensions are free. */
enum { JSON_DEPTH_MAX = 128 };

/* Is text one JSON value (RFC 8259) in valid UTF-8, nested at most JSON_DEPTH_MAX deep, without numbers beyond the
 * range of double? *value_count: how many values it holds. Errors name line and column. */
bool json_check(const char *text, size_t size, uint64_t *value_count, const kiln_where *file, kiln_report *);

/* The rest is for checked text alone: nothing is checked again. A value is known by its first character. */
typedef struct json_value {
    const char *at, *end; /* of the value */
} json_value;

typedef enum json_kind { JSON_NULL, JSON_BOOL, JSON_NUMBER, JSON_STRING, JSON_ARRAY, JSON_OBJECT } json_kind;
json_kind json_kind_of(const char *at);
const char *json_kind_name(json_kind);

/* The first character behind white space; behind a value. */
const char *json_space(const char *at);
const char *json_skip(const char *at);
json_value json_root(const char *text);

/* Walks over an array or an object; any other value is taken for an empty one. */
typedef struct json_cursor {
    const char *at;
    bool object, done;
} json_cursor;

json_cursor json_open(json_value container);
/* The next element, or member; key may be NULL, and is a string with its quotes. */
bool json_next(json_cursor *, json_value *key, json_value *value);

/* The characters of a string value are exactly name (no escapes). */
bool json_is(json_value string, const char *name);
/* The member of an object with this key, the first one. */
bool json_member(json_value object, const char *name, json_value *value);

/* A string's characters, decoded, terminated; a NUL inside ends it. NULL: memory ran out. */
char *json_text(json_value string, kiln_arena *);

/* The value of a literal that is a non-negative integer without fraction and exponent, at most 2⁵³. */
bool json_whole(json_value number, uint64_t *value);

#endif
