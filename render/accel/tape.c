#include "render/accel/tape.h"

#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/clock.h"
#include "base/denormals.h"
#include "base/threads.h"
#include "render/accel/coverage.h"
#include "render/accel/structure.h"

enum { WIDTH = 16, ITEM = 256 /* packets that a thread takes at a time: some tenths of a millisecond */ };

struct tape_packet {
    struct RTCRay16 ray;
    uint32_t seed[WIDTH], index[WIDTH]; /* of the coverage, by lane */
    float ends[WIDTH]; /* tfar behind the query: where the ray met something; −∞: it does, if that was the query */
    uint32_t key;
    uint16_t valid; /* bits of lanes */
    uint8_t query, independent;
};

size_t tape_packet_bytes(void) { return sizeof(tape_packet); }

ray_tape *tapes_create(uint32_t count, size_t packets, uint64_t every) {
    ray_tape *tapes = array_alloc(count, sizeof *tapes);
    for (uint32_t t = 0; tapes && t < count; t++) {
        tapes[t] = (ray_tape){.packets = aligned_array(packets / count, sizeof(tape_packet)),
                              .capacity = packets / count, .every = every | 1};
        if (tapes[t].packets) continue;
        tapes_destroy(tapes, t);
        return NULL;
    }
    return tapes;
}

void tapes_destroy(ray_tape *tapes, uint32_t count) {
    for (uint32_t t = 0; tapes && t < count; t++) free(tapes[t].packets);
    free(tapes);
}

ray_tape *tape_begin(ray_tape *tape) {
    bool chosen = !tape->full && tape->batches % tape->every == 0;
    tape->batches++;
    tape->count = tape->whole;
    return chosen ? tape : NULL;
}

void tape_end(ray_tape *tape, uint64_t samples) {
    if (tape->full) return;
    tape->whole = tape->count;
    tape->samples += samples;
}

tape_packet *tape_add(ray_tape *tape, tape_query query, const void *ray16, const int valid[WIDTH],
                      const ray_coverage *coverage) {
    if (tape->count == tape->capacity) tape->full = true;
    if (tape->full) return NULL;
    tape_packet *p = &tape->packets[tape->count++];
    *p = (tape_packet){.ray = *(const struct RTCRay16 *)ray16, .key = coverage->key, .query = (uint8_t)query,
                       .independent = (uint8_t)coverage->independent};
    for (uint32_t k = 0; k < WIDTH; k++) {
        uint32_t i = p->ray.id[k];
        p->seed[k] = coverage->seed ? coverage->seed[i] : 0;
        p->index[k] = coverage->index ? coverage->index[i] : 0;
        p->ray.id[k] = k;
        if (valid[k]) p->valid |= (uint16_t)(1u << k);
    }
    return p;
}

void tape_met(tape_packet *p, const void *ray16) {
    memcpy(p->ends, ((const struct RTCRay16 *)ray16)->tfar, sizeof p->ends);
}

tape_totals tapes_count(const ray_tape *tapes, uint32_t count) {
    tape_totals sum = {0};
    for (uint32_t t = 0; t < count; t++) {
        sum.packets += tapes[t].whole;
        sum.samples += tapes[t].samples;
        for (size_t i = 0; i < tapes[t].whole; i++) {
            const tape_packet *p = &tapes[t].packets[i];
            *(p->query <= TAPE_CLOSEST ? &sum.closest_rays : &sum.occlusion_rays) +=
                (uint64_t)__builtin_popcount(p->valid);
        }
    }
    return sum;
}

/* A visit looks at everything and accepts nothing. */
static void look_on(const struct RTCFilterFunctionNArguments *args) {
    for (uint32_t k = 0; k < args->N; k++) args->valid[k] = 0;
}

static void trace(const world *w, const tape_packet *p, coverage_context *context, struct RTCRayHit16 *packet) {
    ray_coverage coverage = {p->seed, p->index, p->key, p->independent};
    _Alignas(64) int valid[WIDTH];
    RTCScene scene = w->accel->scene;
    packet->ray = p->ray;
    for (int k = 0; k < WIDTH; k++) valid[k] = p->valid >> k & 1 ? -1 : 0;
    context->coverage = &coverage;
    if (p->query <= TAPE_CLOSEST) {
        for (int k = 0; k < WIDTH; k++) packet->hit.geomID[k] = packet->hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
        embree_intersect16(valid, scene, &context->embree, p->query == TAPE_BEAM, packet);
    } else if (p->query == TAPE_VISIT) {
        embree_visit16(valid, scene, &context->embree, look_on, &packet->ray);
        embree_init_context(&context->embree); /* where Embree 3 leaves the filter */
    } else embree_occluded16(valid, scene, &context->embree, &packet->ray);
}

static uint64_t count_differing(const tape_packet *p, const struct RTCRay16 *ray) {
    uint64_t differing = 0;
    for (int k = 0; p->query != TAPE_VISIT && k < WIDTH; k++)
        differing += (p->valid >> k & 1) && memcmp(&p->ends[k], &ray->tfar[k], sizeof(float));
    return differing;
}

typedef struct replay {
    const world *world;
    const ray_tape *tapes;
    bool compares;
    _Atomic uint64_t differing;
} replay;

static size_t items_of(const ray_tape *t) { return (t->whole + ITEM - 1) / ITEM; }

static void replay_item(void *user, size_t item, uint32_t thread) {
    (void)thread;
    replay *r = user;
    const ray_tape *tape = r->tapes;
    coverage_context context = {.world = r->world};
    uint64_t differing = 0;
    (void)denormals_flush();
    embree_init_context(&context.embree);
    for (; item >= items_of(tape); tape++) item -= items_of(tape);
    size_t first = item * ITEM, end = first + ITEM < tape->whole ? first + ITEM : tape->whole;
    for (size_t i = first; i < end; i++) {
        struct RTCRayHit16 packet;
        trace(r->world, &tape->packets[i], &context, &packet);
        if (r->compares) differing += count_differing(&tape->packets[i], &packet.ray);
    }
    r->differing += differing;
}

static double run(replay *r, uint32_t count, uint32_t threads) {
    size_t items = 0;
    for (uint32_t t = 0; t < count; t++) items += items_of(&r->tapes[t]);
    unsigned before = denormals_flush();
    double began = clock_seconds();
    threads_for(threads, items, replay_item, r);
    double seconds = clock_seconds() - began;
    denormals_restore(before); /* the calling thread's */
    return seconds;
}

double tapes_replay(const world *w, const ray_tape *tapes, uint32_t count, uint32_t threads) {
    replay r = {.world = w, .tapes = tapes};
    return run(&r, count, threads);
}

uint64_t tapes_compare(const world *w, const ray_tape *tapes, uint32_t count, uint32_t threads) {
    replay r = {.world = w, .tapes = tapes, .compares = true};
    (void)run(&r, count, threads);
    return r.differing;
}
