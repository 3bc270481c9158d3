/* base/arena.h: memory that is freed all at once, and sizes that cannot overflow. */
#ifndef KILN_BASE_ARENA_H
#define KILN_BASE_ARENA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct kiln_arena_block kiln_arena_block;

/* Zero-initialised is empty. Not thread-safe. */
typedef struct kiln_arena {
    kiln_arena_block *blocks;
    size_t bytes; /* handed out so far */
} kiln_arena;

/* count × size bytes, zeroed, aligned to 64; NULL when that overflows or memory is exhausted. 0 bytes give a valid
 * pointer. */
void *arena_array(kiln_arena *, size_t count, size_t size);
/* A copy of count × size bytes; NULL as above. */
void *arena_copy(kiln_arena *, const void *source, size_t count, size_t size);
char *arena_string(kiln_arena *, const char *string); /* NULL stands for "" */
void arena_free(kiln_arena *);

#define ARENA_ARRAY(arena, type, count) ((type *)arena_array((arena), (count), sizeof(type)))

/* True, and *product = a × b, unless it overflows. */
static inline bool size_mul(size_t a, size_t b, size_t *product) { return !__builtin_mul_overflow(a, b, product); }
static inline bool size_add(size_t a, size_t b, size_t *sum) { return !__builtin_add_overflow(a, b, sum); }

/* malloc(count × size), zeroed; NULL on overflow too. Free with free(). */
void *array_alloc(size_t count, size_t size);
/* realloc that keeps *array on failure and returns false. */
bool array_resize(void **array, size_t count, size_t size);

/* count × size bytes, zeroed, at 64-byte alignment, with huge pages asked for where they pay. Free with free(). */
void *aligned_array(size_t count, size_t size);

#ifdef __cplusplus
}
#endif
#endif
