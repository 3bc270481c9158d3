/* Linked in front of render/path/isa.c: the instance whose stages the mutant replaces is the only one there is. */
#include "render/path/stages.h"

path_tracer *path_choose_tracer(const char *wanted, const char **name) {
    (void)wanted;
    if (name) *name = "mutant";
    return STAGE(trace_samples);
}
