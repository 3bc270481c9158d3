#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <sched.h>
#include <stdatomic.h>

#include "base/threads.h"

enum { ITEMS = 1000 };

typedef struct tally {
    atomic_int done[ITEMS];
    atomic_int by_thread[64];
    uint32_t threads;
    atomic_int strangers; /* thread numbers that should not be */
} tally;

static void count(void *context, size_t item, uint32_t thread) {
    tally *t = context;
    atomic_fetch_add(&t->done[item], 1);
    if (thread >= t->threads) atomic_fetch_add(&t->strangers, 1);
    else atomic_fetch_add(&t->by_thread[thread], 1);
    if (item % 50 == 0) sched_yield();
}

static void every_item_is_done_once(void **state) {
    (void)state;
    const uint32_t threads[] = {1, 2, 7, 64};
    const size_t items[] = {0, 1, 3, ITEMS};
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 4; k++) {
            tally t = {.threads = threads[i]};
            threads_for(threads[i], items[k], count, &t);
            for (size_t item = 0; item < ITEMS; item++) assert_int_equal(t.done[item], item < items[k]);
            assert_int_equal(t.strangers, 0);
        }
}

static void zero_threads_are_all_that_there_are(void **state) {
    (void)state;
    tally t = {.threads = threads_available()};
    assert_true(t.threads >= 1);
    threads_for(0, ITEMS, count, &t);
    for (size_t item = 0; item < ITEMS; item++) assert_int_equal(t.done[item], 1);
    assert_int_equal(t.strangers, 0);
}

static void the_affinity_mask_is_obeyed(void **state) {
    (void)state;
    cpu_set_t before, one;
    if (sched_getaffinity(0, sizeof before, &before)) skip();
    CPU_ZERO(&one);
    for (size_t cpu = 0; cpu < CPU_SETSIZE && !CPU_COUNT(&one); cpu++)
        if (CPU_ISSET(cpu, &before)) CPU_SET(cpu, &one);
    if (sched_setaffinity(0, sizeof one, &one)) skip();
    assert_int_equal(threads_available(), 1);
    sched_setaffinity(0, sizeof before, &before);
}

static void in_order(void *context, size_t item, uint32_t thread) {
    size_t *next = context;
    assert_int_equal(thread, 0);
    assert_int_equal(item, (*next)++);
}

static void one_thread_goes_in_order(void **state) {
    (void)state;
    size_t next = 0;
    threads_for(1, ITEMS, in_order, &next);
    assert_int_equal(next, ITEMS);
}

static atomic_uchar often[300000];

static void count_quickly(void *context, size_t item, uint32_t thread) {
    (void)context, (void)thread;
    atomic_fetch_add(&often[item], 1);
}

/* Items so short that the threads meet at the counter all the time. */
static void short_items_are_done_once_too(void **state) {
    (void)state;
    for (int times = 1; times <= 10; times++) {
        threads_for(4, sizeof often, count_quickly, NULL);
        for (size_t i = 0; i < sizeof often; i++) assert_true(often[i] == times);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_item_is_done_once),
        cmocka_unit_test(short_items_are_done_once_too),
        cmocka_unit_test(zero_threads_are_all_that_there_are),
        cmocka_unit_test(the_affinity_mask_is_obeyed),
        cmocka_unit_test(one_thread_goes_in_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
