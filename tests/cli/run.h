/* tests/cli/run.h: the built program from the outside: arguments go in, an exit code and two streams come out. Include
 * after cmocka.h. */
#ifndef KILN_TESTS_CLI_RUN_H
#define KILN_TESTS_CLI_RUN_H

#include <sys/types.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PAIR(name) KILN_TEST_DATA "/gltf/pairs/" name ".gltf"

/* A folder that the program runs in; its streams lie in another one. */
typedef struct place {
    char folder[64], streams[64];
} place;

int place_open(void **state);
int place_close(void **state);
#define CLI_TEST(name) cmocka_unit_test_setup_teardown(name, place_open, place_close)

typedef struct result {
    int code; /* 128 + signal when it was killed */
    char *out, *err; /* terminated */
    size_t out_size, err_size;
} result;

/* Arguments end with NULL; "NAME=value" before the first other one is environment. "<file" is standard input,
 * ">file" standard output. */
result run_list(const place *, const char *const *arguments);
void result_free(result *);
#define run(place_, ...) run_list(place_, (const char *const[]){__VA_ARGS__, NULL})

/* The same in two steps, for what happens in between. */
pid_t run_start(const place *, const char *const *arguments);
result run_wait(const place *, pid_t);
/* Waits until standard error holds the text; false after two minutes: sanitizers on a busy machine are slow. */
bool run_says(const place *, const char *text);

/* Runs, and holds exit code and one line on standard error that has the text; no line on standard output, no new file.
 */
void assert_refused_list(const place *, int code, const char *text, const char *const *arguments);
#define assert_refused(place_, code, text, ...)                                                                        \
    assert_refused_list(place_, code, text, (const char *const[]){__VA_ARGS__, NULL})
/* Runs, and holds exit code 0. */
void assert_runs_list(const place *, const char *const *arguments);
#define assert_runs(place_, ...) assert_runs_list(place_, (const char *const[]){__VA_ARGS__, NULL})

size_t files_in(const place *);
bool has_file(const place *, const char *name);
void write_file(const place *, const char *name, const void *data, size_t size);
/* free(); NULL: there is none */
unsigned char *read_file(const place *, const char *name, size_t *size);
bool same_bytes(const place *, const char *a, const char *b);

/* Pixels of a picture that the program wrote, as floats; free(). */
float *read_picture(const place *, const char *name, uint32_t *width, uint32_t *height, uint32_t *channels);

#endif
