/* scene/transfer.h: how the numbers of pictures become linear values. */
#ifndef KILN_SCENE_TRANSFER_H
#define KILN_SCENE_TRANSFER_H

#include "base/vec.h"
#include "kiln/render.h"

/* The curve of a transfer from a code in [0,1] (larger values go on along it, negative ones by symmetry). */
float transfer_decode(kiln_transfer, float code);

/* Linear values of a transfer, as factors are (KILN_TRANSFER_LINEAR), in the working space. */
static inline vec3 decoding_apply(const kiln_decoding *d, kiln_transfer transfer, const float rgb[3]) {
    return v3_transform(d->matrix[transfer], v3_load(rgb));
}

/* The tables for a working space of linear Rec.709. */
void transfer_rec709(kiln_decoding *);

#endif
