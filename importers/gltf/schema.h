/* importers/gltf/schema.h: are the properties of the glTF core of the types that its schema asks for, and are the
 * required ones there? tinygltf takes a property of the wrong type for an absent one, and cuts integers to 32 bits:
 * an index as text, or beyond 32 bits, would silently become another picture. Extensions and extras are not looked
 * into; unknown properties are passed over. */
#ifndef KILN_IMPORTERS_GLTF_SCHEMA_H
#define KILN_IMPORTERS_GLTF_SCHEMA_H

#include "importers/gltf/json.h"

/* root: of checked JSON. What makes tinygltf give up without saying where is found here too. */
bool schema_check(json_value root, const kiln_where *file, kiln_report *);

typedef enum schema_type {
    SCHEMA_INDEX = 1 << 0,  /* a non-negative integer below 2³¹ */
    SCHEMA_SIZE = 1 << 1,   /* a non-negative integer of bytes or elements */
    SCHEMA_NUMBER = 1 << 2,
    SCHEMA_STRING = 1 << 3,
    SCHEMA_BOOL = 1 << 4,
    SCHEMA_OBJECT = 1 << 5, /* its members have rows */
    SCHEMA_MAP = 1 << 6,    /* an object: whatever its members are called, they are indices */
    SCHEMA_EXTENSIONS = 1 << 7, /* an object: whatever its members are called, they are objects */
    SCHEMA_ARRAY = 1 << 8
} schema_type;

typedef struct schema_row {
    const char *key;
    unsigned types;    /* of schema_type: where a key has several meanings, any of them */
    unsigned elements; /* of an array */
    const char *required[3]; /* members of the object, or of each object in the array */
    size_t length;           /* of an array; 0: any */
} schema_row;

extern const schema_row schema_rows[]; /* sorted by key */
extern const size_t schema_row_count;

#endif
