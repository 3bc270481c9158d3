/* What a pixel's samples met: handles, and ids of names. */
#include <stdlib.h>
#include <string.h>

#include "base/murmur.h"
#include "base/report.h"
#include "render/film/film.h"

static bool holds(const kiln_film_desc *d, int t) {
    if (t == FILM_OBJECT) return d->aovs >> KILN_AOV_OBJECT & 1;
    if (t == FILM_MATERIAL) return d->aovs >> KILN_AOV_MATERIAL & 1;
    return d->mattes >> (t - FILM_MATTES) & 1;
}

bool film_allocate_ballots(kiln_film *f) {
    bool done = true;
    for (int t = 0; done && t < FILM_BALLOTS; t++)
        if (holds(&f->desc, t)) done = (f->ballots[t] = aligned_array((size_t)f->width * f->height, sizeof(ballot))) != NULL;
    return done;
}

void film_free_ballots(kiln_film *f) {
    for (int t = 0; t < FILM_BALLOTS; t++) free(f->ballots[t]);
    for (int m = 0; m < KILN_MATTE_COUNT; m++) arena_free(&f->names[m].arena);
}

uint64_t film_ballot_bytes(const kiln_film_desc *d) {
    uint64_t sum = 0;
    for (int t = 0; t < FILM_BALLOTS; t++) sum += holds(d, t) ? sizeof(ballot) : 0;
    return sum;
}

/* Cryptomatte specification, 'ID generation': an exponent of all zeros or ones would be a denormal, an infinity or NaN,
 * which programs do not hand on as they are. */
uint32_t kiln_matte_id(const char *name) {
    uint32_t hash = murmur3_32(name, strlen(name), 0), exponent = hash >> 23 & 0xff;
    exponent = exponent < 1 ? 1 : exponent > 254 ? 254 : exponent;
    return (hash & 0x807fffffu) | exponent << 23;
}

bool film_set_names(kiln_film *f, kiln_matte matte, const char *const *names, uint32_t count, kiln_report *report) {
    film_names *n = &f->names[matte];
    arena_free(&n->arena);
    *n = (film_names){0};
    n->items = ARENA_ARRAY(&n->arena, kiln_matte_name, count);
    for (uint32_t i = 0; n->items && i < count; i++) {
        n->items[i] = (kiln_matte_name){arena_string(&n->arena, names[i]), kiln_matte_id(names[i])};
        if (!n->items[i].name) return report_no_memory(report, "naming mattes");
    }
    n->count = count;
    return n->items || report_no_memory(report, "naming mattes");
}

void film_count(kiln_film *f, size_t pixel, const film_sample *s) {
    const uint32_t handles[KILN_MATTE_COUNT] = {
        [KILN_MATTE_OBJECT] = s->object, [KILN_MATTE_MATERIAL] = s->material, [KILN_MATTE_ASSET] = s->object};
    if (f->ballots[FILM_OBJECT]) ballot_add(&f->ballots[FILM_OBJECT][pixel], s->object);
    if (f->ballots[FILM_MATERIAL]) ballot_add(&f->ballots[FILM_MATERIAL][pixel], s->material);
    for (int m = 0; m < KILN_MATTE_COUNT; m++) {
        ballot *all = f->ballots[FILM_MATTES + m];
        if (all) ballot_add(&all[pixel], f->names[m].items[handles[m]].id);
    }
}

/* By falling count, then by key. */
static int compare_rows(const void *a, const void *b) {
    const ballot_row *x = a, *y = b;
    return x->count != y->count ? (x->count < y->count ? 1 : -1) : (x->key > y->key) - (x->key < y->key);
}

static ballot ranked(const ballot *t) {
    ballot copy = *t;
    qsort(copy.rows, BALLOT_ROWS, sizeof *copy.rows, compare_rows);
    return copy;
}

uint32_t film_most(const kiln_film *f, film_ballot which, size_t pixel) {
    return ranked(&f->ballots[which][pixel]).rows[0].key;
}

bool kiln_film_matte(const kiln_film *f, kiln_matte matte, float *values) {
    const ballot *ballots = f->ballots[FILM_MATTES + matte];
    for (size_t i = 0; ballots && i < (size_t)f->width * f->height; i++) {
        ballot t = ranked(&ballots[i]);
        for (size_t r = 0; r < BALLOT_ROWS; r++, values += 2) {
            bool met = t.rows[r].count > 0;
            values[0] = met ? fm_from_bits(t.rows[r].key) : 0.0f;
            values[1] = met ? (float)((double)t.rows[r].count / f->counts[i]) : 0.0f;
        }
    }
    return ballots != NULL;
}

static int compare_names(const void *a, const void *b) {
    const kiln_matte_name *x = a, *y = b;
    return (x->id > y->id) - (x->id < y->id);
}

/* Sorted; of equal ids the first is kept. */
static uint32_t sort_names(kiln_matte_name *names, uint32_t count) {
    uint32_t kept = 0;
    qsort(names, count, sizeof *names, compare_names);
    for (uint32_t i = 0; i < count; i++)
        if (!kept || names[kept - 1].id != names[i].id) names[kept++] = names[i];
    return kept;
}

kiln_matte_name *kiln_film_matte_names(const kiln_film *f, kiln_matte matte, uint32_t *count) {
    const ballot *ballots = f->ballots[FILM_MATTES + matte];
    const film_names *from = &f->names[matte];
    kiln_matte_name *names = ballots ? array_alloc((size_t)from->count + 1, sizeof *names) : NULL;
    bool *seen = names ? array_alloc((size_t)from->count + 1, sizeof *seen) : NULL;
    *count = 0;
    if (!seen) {
        free(names);
        return NULL;
    }
    if (from->count) memcpy(names, from->items, from->count * sizeof *names);
    uint32_t all = sort_names(names, from->count);
    for (size_t i = 0; i < (size_t)f->width * f->height; i++)
        for (size_t r = 0; r < BALLOT_ROWS && ballots[i].rows[r].count; r++) {
            const kiln_matte_name key = {.id = ballots[i].rows[r].key};
            const kiln_matte_name *found = bsearch(&key, names, all, sizeof *names, compare_names);
            if (found) seen[found - names] = true;
        }
    for (uint32_t i = 0; i < all; i++)
        if (seen[i]) names[(*count)++] = names[i];
    free(seen);
    return names;
}
