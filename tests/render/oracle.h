/* tests/render/oracle.h: the estimator as a plain recursion over the same kernels, one path at a time. */
#ifndef KILN_TESTS_RENDER_ORACLE_H
#define KILN_TESTS_RENDER_ORACLE_H

#include "render/path/path.h"

typedef struct oracle_result {
    vec3 radiance, beyond; /* beyond: what a probe found past the depth limit */
    float alpha;
} oracle_result;

oracle_result oracle_trace(const path_context *, path_sample);

#endif
