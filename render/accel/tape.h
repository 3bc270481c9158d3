/* render/accel/tape.h: the rays of a render, kept in the packets in which they were traced, and traced again by Embree
 * and nothing else: what a renderer could do at most whose other work took no time.
 *
 * Whole batches are kept, one in `every`, so that camera, bounce and shadow rays are there in the proportion of the
 * render; 64 bytes a ray. A render that is not recorded pays a branch for each packet. */
#ifndef KILN_RENDER_ACCEL_TAPE_H
#define KILN_RENDER_ACCEL_TAPE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct ray_coverage;
struct world;

/* What was asked of Embree. */
typedef enum tape_query {
    TAPE_BEAM, /* the closest hits of coherent rays */
    TAPE_CLOSEST, TAPE_VISIBLE, TAPE_VISIT
} tape_query;

typedef struct tape_packet tape_packet;

/* Of one thread. */
typedef struct ray_tape {
    tape_packet *packets;
    size_t capacity, count;
    size_t whole;    /* packets of batches that are there to their end */
    uint64_t samples; /* of those */
    uint64_t batches; /* that there were */
    uint64_t every;
    bool full;
} ray_tape;

/* `count` empty tapes for `packets` packets together. NULL: out of memory. every is made odd: it shall have no factor in
 * common with the number of batches of a tile. */
ray_tape *tapes_create(uint32_t count, size_t packets, uint64_t every);
void tapes_destroy(ray_tape *, uint32_t count); /* NULL: nothing happens */
size_t tape_packet_bytes(void);

/* A batch begins: NULL when it is not recorded. It ends with so many samples. */
ray_tape *tape_begin(ray_tape *);
void tape_end(ray_tape *, uint64_t samples);

/* A packet (struct RTCRay16) before it is traced; NULL: the tape is full, and forgets the batch. Then the same rays,
 * as Embree left them. */
tape_packet *tape_add(ray_tape *, tape_query, const void *ray16, const int valid[16], const struct ray_coverage *);
void tape_met(tape_packet *, const void *ray16);

typedef struct tape_totals {
    uint64_t packets, closest_rays, occlusion_rays, samples;
} tape_totals;
tape_totals tapes_count(const ray_tape *, uint32_t count);

/* Traces all of it on so many threads; seconds. */
double tapes_replay(const struct world *, const ray_tape *, uint32_t count, uint32_t threads);
/* The same, and counts the rays that met something else than in the render. */
uint64_t tapes_compare(const struct world *, const ray_tape *, uint32_t count, uint32_t threads);

#endif
