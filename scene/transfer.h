/* scene/transfer.h: how the numbers of pictures become linear values. */
#ifndef KILN_SCENE_TRANSFER_H
#define KILN_SCENE_TRANSFER_H

#include "kiln/render.h"

/* The curve of a transfer from a code in [0,1] (larger values go on along it, negative ones by symmetry). */
float transfer_decode(kiln_transfer, float code);

/* The tables for a working space of linear Rec.709. */
void transfer_rec709(kiln_decoding *);

#endif
