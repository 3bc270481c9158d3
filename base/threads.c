#include "base/threads.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* The quota of control group v2, in whole cores; 0: none. */
static uint32_t group_quota(void) {
    FILE *file = fopen("/sys/fs/cgroup/cpu.max", "re");
    if (!file) return 0;
    long long quota = 0, period = 0;
    int fields = fscanf(file, "%lld %lld", &quota, &period); /* "max 100000" yields no field */
    fclose(file);
    if (fields != 2 || quota <= 0 || period <= 0) return 0;
    return (uint32_t)((quota + period - 1) / period);
}

uint32_t threads_available(void) {
    cpu_set_t set;
    uint32_t cores = sched_getaffinity(0, sizeof set, &set) == 0 ? (uint32_t)CPU_COUNT(&set)
                                                                  : (uint32_t)sysconf(_SC_NPROCESSORS_ONLN);
    uint32_t quota = group_quota();
    if (quota && quota < cores) cores = quota;
    return cores ? cores : 1;
}

typedef struct crew {
    atomic_size_t next;
    size_t count;
    void (*work)(void *, size_t, uint32_t);
    void *context;
} crew;

typedef struct member {
    crew *crew;
    uint32_t index;
    pthread_t thread;
} member;

static void *run(void *argument) {
    member *m = argument;
    crew *c = m->crew;
    for (size_t item; (item = atomic_fetch_add(&c->next, 1)) < c->count;) c->work(c->context, item, m->index);
    return NULL;
}

void threads_for(uint32_t threads, size_t count, void (*work)(void *, size_t, uint32_t), void *context) {
    if (!threads) threads = threads_available();
    if (threads > count) threads = (uint32_t)count;
    crew c = {0, count, work, context};
    member self = {&c, 0, pthread_self()};
    member *others = threads > 1 ? calloc(threads - 1, sizeof *others) : NULL;
    uint32_t started = 0;
    for (; others && started + 1 < threads; started++) {
        others[started] = (member){.crew = &c, .index = started + 1};
        if (pthread_create(&others[started].thread, NULL, run, &others[started])) break;
    }
    run(&self);
    for (uint32_t i = 0; i < started; i++) pthread_join(others[i].thread, NULL);
    free(others);
}
