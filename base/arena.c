#include "base/arena.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

/* Blocks grow from BLOCK_MIN with the arena, so that ten thousand small arenas (one per mesh) stay small. */
enum { ALIGNMENT = 64, BLOCK_MIN = 1024, BLOCK_MAX = 64 * 1024, HUGE_PAGE = 2 * 1024 * 1024 };

struct kiln_arena_block {
    kiln_arena_block *next;
    size_t used, size; /* of data */
    char *data;
};

static kiln_arena_block *add_block(kiln_arena *arena, size_t bytes) {
    kiln_arena_block *block = malloc(sizeof *block);
    size_t usual = arena->bytes < BLOCK_MIN ? BLOCK_MIN : arena->bytes > BLOCK_MAX ? BLOCK_MAX : arena->bytes;
    /* A block made for one large array goes behind the current one, whose rest stays in use. */
    bool behind = bytes > usual / 2 && arena->blocks;
    size_t size = behind || bytes > usual ? bytes : usual;
    char *data = block ? aligned_array(size, 1) : NULL;
    if (!data) {
        free(block);
        return NULL;
    }
    *block = (kiln_arena_block){behind ? arena->blocks->next : arena->blocks, 0, size, data};
    if (behind) arena->blocks->next = block;
    else arena->blocks = block;
    return block;
}

void *arena_array(kiln_arena *arena, size_t count, size_t size) {
    size_t bytes;
    if (!size_mul(count, size, &bytes) || !size_add(bytes, ALIGNMENT - 1, &bytes)) return NULL;
    bytes = bytes / ALIGNMENT * ALIGNMENT;
    if (bytes == 0) bytes = ALIGNMENT;
    kiln_arena_block *block = arena->blocks;
    if (!block || block->size - block->used < bytes) block = add_block(arena, bytes);
    if (!block) return NULL;
    void *result = block->data + block->used;
    block->used += bytes;
    arena->bytes += bytes;
    return result;
}

void *arena_copy(kiln_arena *arena, const void *source, size_t count, size_t size) {
    void *copy = arena_array(arena, count, size);
    if (copy && count && size) memcpy(copy, source, count * size);
    return copy;
}

char *arena_string(kiln_arena *arena, const char *string) {
    return string ? arena_copy(arena, string, strlen(string) + 1, 1) : arena_copy(arena, "", 1, 1);
}

void arena_free(kiln_arena *arena) {
    for (kiln_arena_block *block = arena->blocks, *next; block; block = next) {
        next = block->next;
        free(block->data);
        free(block);
    }
    *arena = (kiln_arena){0};
}

void *array_alloc(size_t count, size_t size) { return calloc(count ? count : 1, size ? size : 1); }

bool array_resize(void **array, size_t count, size_t size) {
    size_t bytes;
    if (!size_mul(count, size, &bytes)) return false;
    void *resized = realloc(*array, bytes ? bytes : 1);
    if (!resized) return false;
    *array = resized;
    return true;
}

void *aligned_array(size_t count, size_t size) {
    size_t bytes;
    if (!size_mul(count, size, &bytes) || !size_add(bytes, HUGE_PAGE, &bytes)) return NULL;
    bytes -= HUGE_PAGE;
    bool huge = bytes >= 2 * (size_t)HUGE_PAGE;
    size_t alignment = huge ? HUGE_PAGE : ALIGNMENT;
    void *data = NULL;
    if (posix_memalign(&data, alignment, bytes ? bytes : 1)) return NULL;
    if (huge) (void)madvise(data, bytes, MADV_HUGEPAGE); /* a hint: refusal changes nothing but speed */
    memset(data, 0, bytes);
    return data;
}
