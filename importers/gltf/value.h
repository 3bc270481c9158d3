/* importers/gltf/value.h: reading extensions and extras, where a value of the wrong type is an error that names its
 * place. An absent member leaves the caller's default. */
#ifndef KILN_IMPORTERS_GLTF_VALUE_H
#define KILN_IMPORTERS_GLTF_VALUE_H

#include "base/report.h"
#include "importers/gltf/document.h"

/* NULL: the object (or NULL, or another value) does not have it. */
const gltf_value *value_member(const gltf_value *object, const char *key);

bool value_number(const gltf_value *object, const char *key, double *number, const kiln_where *, kiln_report *);
bool value_float(const gltf_value *object, const char *key, float *number, const kiln_where *, kiln_report *);
/* count: 2 to 4. */
bool value_floats(const gltf_value *object, const char *key, size_t count, float *numbers, const kiln_where *,
                  kiln_report *);
/* A non-negative integer below 2³¹. */
bool value_index(const gltf_value *object, const char *key, int *index, const kiln_where *, kiln_report *);
bool value_bool(const gltf_value *object, const char *key, bool *flag, const kiln_where *, kiln_report *);

#endif
