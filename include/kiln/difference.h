/* kiln/difference.h: how far two pictures are apart. */
#ifndef KILN_DIFFERENCE_H
#define KILN_DIFFERENCE_H

#include "kiln/film.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A film against another of the same size, over pixels in which either has a surface. Noise cancels: the square is the
 * product of two replicates' differences, which are independent, so that equal scenes differ by 0 in the mean. */
typedef struct kiln_film_difference {
    bool known;   /* false: other sizes, or too few samples, or no surface */
    double root;  /* square root of the mean of (x − ref)²/(ref² + 0.01) over pixels and channels */
    double light; /* all light of the film over that of the reference, less 1 */
} kiln_film_difference;

/* scale multiplies both first, as in kiln_film_estimate_error. */
KILN_API kiln_film_difference kiln_film_compare(const kiln_film *, const kiln_film *reference, double scale);

#ifdef __cplusplus
}
#endif
#endif
