/* --embree-config. Embree passes over keys that it does not know, and takes an unknown isa for sse2: a slip would render
 * all the same, slower or otherwise than was meant. */
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "job/options.h"

/* What State::parse reads (kernels/common/state.cpp of Embree 3.13 and 4.4). */
static const char *const keys[] = {
    "accel", "accel_mb", "affinity", "alloc_main_block_size", "alloc_num_main_slots", "alloc_single_thread_alloc",
    "alloc_thread_block_size", "benchmark", "builder", "builder_mb", "cache_size", "enable_selockmemoryprivilege",
    "float_exceptions", "frequency_level", "grid_accel", "grid_accel_mb", "hair_accel", "hair_accel_mb",
    "hair_builder", "hair_builder_mb", "hair_traverser", "hair_traverser_mb", "hugepages", "instancing_block_size",
    "instancing_open_factor", "instancing_open_max", "instancing_open_max_depth", "instancing_open_min", "isa",
    "line_accel", "line_accel_mb", "line_builder", "line_builder_mb", "line_traverser", "line_traverser_mb",
    "max_builder_isa", "max_isa", "max_spatial_split_replications", "max_triangles_per_leaf", "object_accel",
    "object_accel_max_leaf_size", "object_accel_mb", "object_accel_mb_max_leaf_size", "object_accel_mb_min_leaf_size",
    "object_accel_min_leaf_size", "object_builder", "object_builder_mb", "presplits", "quad_accel", "quad_accel_mb",
    "quad_builder", "quad_builder_mb", "quad_traverser", "quad_traverser_mb", "quality", "scene_flags",
    "set_affinity", "start_threads", "subdiv_accel", "subdiv_accel_mb", "tessellation_cache_size", "threads",
    "traverser", "traverser_mb", "tri_accel", "tri_accel_mb", "tri_builder", "tri_builder_mb", "tri_traverser",
    "tri_traverser_mb", "user_threads", "verbose", NULL};

static const char *const isas[] = {"sse",   "sse2", "sse3", "ssse3", "sse41",  "sse4.1", "sse42",
                                   "sse4.2", "avx",  "avxi", "avx2",  "avx512", NULL};

static bool is_one_of(const char *text, size_t length, const char *const *names) {
    for (; *names; names++)
        if (strlen(*names) == length && strncasecmp(*names, text, length) == 0) return true;
    return false;
}

/* "key=value", `length` characters. */
static bool is_setting(const char *text, size_t length) {
    const char *equals = memchr(text, '=', length);
    if (!equals) return false;
    size_t key = (size_t)(equals - text), value = length - key - 1;
    bool names_isa = key >= 3 && strncmp(equals - 3, "isa", 3) == 0;
    return is_one_of(text, key, keys) && value > 0 && (!names_isa || is_one_of(equals + 1, value, isas));
}

static bool parse(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    static const char separators[] = ", ";
    for (const char *at = text; *at;) {
        size_t length = strcspn(at, separators);
        if (!length || !is_setting(at, length)) return false;
        at += length;
        at += strspn(at, separators);
    }
    return option_text.parse(row, text, field, arena) && *(const char **)field;
}

static void print(const option_row *row, const void *field, kiln_text *out) { option_text.print(row, field, out); }

const option_kind option_embree = {parse, print, false, false};
