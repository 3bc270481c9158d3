/* render/film/ballot.h: which keys the samples of a pixel met, and how often, in a place of fixed size.
 *
 * Metwally, Agrawal and El Abbadi 2005, "Efficient Computation of Frequent and Top-k Elements in Data Streams"
 * (Space-Saving): when no room is left, a new key takes over the row with the least count, and the count. Every key of
 * more than one in BALLOT_ROWS samples is there, and counts sum to the number of samples. */
#ifndef KILN_RENDER_FILM_BALLOT_H
#define KILN_RENDER_FILM_BALLOT_H

#include <stdint.h>

#include "kiln/film.h"

enum { BALLOT_ROWS = KILN_MATTE_RANKS };

typedef struct ballot_row { uint32_t key, count; } ballot_row; /* count 0: free, and so are those behind it */
typedef struct ballot { ballot_row rows[BALLOT_ROWS]; } ballot;

/* Samples of a pixel come in their order, so that ties do not depend on threads. */
static inline void ballot_add(ballot *t, uint32_t key) {
    uint32_t least = 0;
    for (uint32_t i = 0; i < BALLOT_ROWS; i++) {
        ballot_row *r = &t->rows[i];
        if (!r->count || r->key == key) {
            r->key = key;
            r->count++;
            return;
        }
        if (r->count < t->rows[least].count) least = i;
    }
    t->rows[least].key = key;
    t->rows[least].count++;
}

#endif
