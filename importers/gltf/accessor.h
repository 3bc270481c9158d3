/* importers/gltf/accessor.h: the numbers behind accessors. */
#ifndef KILN_IMPORTERS_GLTF_ACCESSOR_H
#define KILN_IMPORTERS_GLTF_ACCESSOR_H

#include "importers/gltf/reader.h"

/* Every accessor of the file: its types are known, its elements and those of its sparse part lie in their buffer
 * views. Buffer views have been checked. min and max are not read: they are often wrong. */
bool accessors_check(gltf_reader *);

/* Components of an element. */
static inline uint32_t accessor_width(const gltf_accessor *a) { return a->rows * a->columns; }

/* The elements from 0 on, `width` floats each, where the accessor has as many components or more, or fewer: then the
 * rest is left as it is. Normalised integers become [0,1] or [−1,1] (section 3.11), others their value. where: the
 * place that refers to the accessor. */
bool accessor_floats(gltf_reader *, int accessor, uint32_t width, float *out, const kiln_where *where);

/* Scalars of unsigned integers. */
bool accessor_integers(gltf_reader *, int accessor, uint32_t *out, const kiln_where *where);

#endif
