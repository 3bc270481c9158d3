/* render/path/isa.c: which of the compiled instances of the stages runs. */
#include <string.h>

#include "render/path/path.h"

#if defined(__x86_64__) && !defined(KILN_ISA_BASE)
path_tracer path_trace_samples_v2, path_trace_samples_v3, path_trace_samples_v4;

typedef struct instance { const char *name; path_tracer *tracer; } instance;

/* Best first; NULL where this machine has not the instructions. */
static void list(instance out[3]) {
    out[0] = (instance){"v4", __builtin_cpu_supports("x86-64-v4") ? path_trace_samples_v4 : NULL};
    out[1] = (instance){"v3", __builtin_cpu_supports("x86-64-v3") ? path_trace_samples_v3 : NULL};
    out[2] = (instance){"v2", path_trace_samples_v2};
}

path_tracer *path_choose_tracer(const char *wanted, const char **name) {
    instance all[3];
    list(all);
    for (int i = 0; i < 3; i++) {
        if (!all[i].tracer || (wanted && strcmp(wanted, all[i].name) != 0)) continue;
        if (name) *name = all[i].name;
        return all[i].tracer;
    }
    return NULL;
}
#else
path_tracer path_trace_samples_base;

path_tracer *path_choose_tracer(const char *wanted, const char **name) {
    if (wanted && strcmp(wanted, "base") != 0) return NULL;
    if (name) *name = "base";
    return path_trace_samples_base;
}
#endif
