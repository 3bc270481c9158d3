/* Linked in front of render/path/isa.c: the mutant's stages are the only ones there are. */
#include "render/path/path.h"

path_tracer path_trace_samples_mutant;

path_tracer *path_choose_tracer(const char *wanted, const char **name) {
    (void)wanted;
    if (name) *name = "mutant";
    return path_trace_samples_mutant;
}
